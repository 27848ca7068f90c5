"""Widgets side by side and one below the other: a tree of splitters in which any of them can be split."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QSplitter, QWidget

Side = Literal["right", "below"]
Tree = dict[str, Any]
"""`{"split": "right", "sizes": [w, ...], "parts": [name or tree, ...]}`"""

CLOSED = "is_closed"
"""Property of a leaf that is not to be seen until it is asked for."""
ORIENTATIONS = {"right": Qt.Orientation.Horizontal, "below": Qt.Orientation.Vertical}


class PaneGrid:
    """The splitters below `root`; their leaves are known by their object names."""

    def __init__(self, first: QWidget, *others: QWidget) -> None:
        """The leaves to begin with, side by side; the first one stays as long as the grid does."""
        self.root = _splitter("right")
        for leaf in (first, *others):
            self.root.addWidget(leaf)
        self.root.setSizes([500] * self.root.count())

    def leaves(self) -> list[QWidget]:
        """From left to right and from above."""
        return _leaves(self.root)

    def __contains__(self, widget: object) -> bool:
        return widget in self.leaves()

    def split(self, leaf: QWidget, side: Side, new: QWidget) -> None:
        """Put a new leaf to the right of one, or below it; each has half of the room."""
        parent, wanted = _parent(leaf), ORIENTATIONS[side]
        if parent.count() == 1:
            parent.setOrientation(wanted)
        sizes, row = parent.sizes(), parent.indexOf(leaf)
        if parent.orientation() is not wanted:
            nested = _splitter(side)
            parent.insertWidget(row, nested)
            nested.addWidget(leaf)
            parent.setSizes(sizes)
            parent, row, sizes = nested, 0, [leaf.height() if side == "below" else leaf.width()]
        parent.insertWidget(row + 1, new)
        half = sizes[row] // 2
        parent.setSizes([*sizes[:row], half, sizes[row] - half, *sizes[row + 1 :]])
        new.show()

    def fits(self, room: QSize) -> bool:
        """Whether every leaf has what it needs at least, in so much room."""
        least = _least(self.root)
        return least.width() <= room.width() and least.height() <= room.height()

    def replace(self, leaf: QWidget, new: QWidget) -> None:
        """Put another leaf in the place of one, which has no parent then."""
        parent = _parent(leaf)
        sizes = parent.sizes()
        parent.replaceWidget(parent.indexOf(leaf), new)
        leaf.setParent(None)
        new.show()
        parent.setSizes(sizes)

    def take(self, leaf: QWidget) -> None:
        """Remove a leaf, which has no parent then; its neighbour, from which it was split, takes its room."""
        parent = _parent(leaf)
        sizes, row = parent.sizes(), parent.indexOf(leaf)
        seen = [place for place, size in enumerate(sizes) if size and place != row]
        if seen:
            heir = max((place for place in seen if place < row), default=seen[0])
            sizes[heir] += sizes[row] + parent.handleWidth()
        leaf.hide()
        leaf.setParent(None)
        parent.setSizes(sizes[:row] + sizes[row + 1 :])
        if parent.count() == 1 and parent is not self.root:
            above = _parent(parent)
            sizes, row = above.sizes(), above.indexOf(parent)
            above.insertWidget(row, *_children(parent))
            parent.setParent(None)
            parent.deleteLater()
            above.setSizes(sizes)

    # ------------------------------------------------------------------------------------------ memory

    def state(self) -> Tree:
        """The tree with the sizes as they are now."""
        return _state(self.root)

    def reset(self) -> None:
        """The leaves to begin with side by side again; there are no others."""
        names = [leaf.objectName() for leaf in self.leaves()]
        self.arrange({"split": "right", "sizes": [500] * len(names), "parts": sorted(names)}, _by_name(self.leaves()))

    def arrange(self, tree: Tree, leaves: Mapping[str, QWidget]) -> None:
        """Arrange these leaves, those that are there already among them, as a tree that `state` gave says.

        Every name in the tree is one of `leaves`, once; the leaves that are here now are all in it.
        """
        for leaf in self.leaves():
            leaf.setParent(None)
        for nested in _children(self.root):
            nested.setParent(None)
            nested.deleteLater()
        self.root.setOrientation(ORIENTATIONS[tree["split"]])
        _fill(self.root, tree, leaves)


def _by_name(leaves: list[QWidget]) -> dict[str, QWidget]:
    return {leaf.objectName(): leaf for leaf in leaves}


def _splitter(side: Side) -> QSplitter:
    splitter = QSplitter(ORIENTATIONS[side])
    splitter.setChildrenCollapsible(False)
    return splitter


def _parent(leaf: QWidget) -> QSplitter:
    parent = leaf.parentWidget()
    assert isinstance(parent, QSplitter)
    return parent


def _children(splitter: QSplitter) -> list[QWidget]:
    found = [splitter.widget(row) for row in range(splitter.count())]
    return [widget for widget in found if widget is not None]


def _least(widget: QWidget) -> QSize:
    """What a widget needs at least, as it is now: splitters know it of themselves only when they are laid out next."""
    if not isinstance(widget, QSplitter):
        return widget.minimumSizeHint().expandedTo(widget.minimumSize()) if widget.minimumWidth() == 0 else _explicit(widget)
    sizes = [_least(child) for child in _children(widget) if not child.isHidden()]
    handles = widget.handleWidth() * max(len(sizes) - 1, 0)
    widths, heights = [size.width() for size in sizes], [size.height() for size in sizes]
    if widget.orientation() is Qt.Orientation.Horizontal:
        return QSize(sum(widths) + handles, max(heights, default=0))
    return QSize(max(widths, default=0), sum(heights) + handles)


def _explicit(widget: QWidget) -> QSize:
    """A width that is set counts more than what the layout would have."""
    return QSize(widget.minimumWidth(), max(widget.minimumSizeHint().height(), widget.minimumHeight()))


def _leaves(widget: QWidget) -> list[QWidget]:
    if not isinstance(widget, QSplitter):
        return [widget]
    return [leaf for child in _children(widget) for leaf in _leaves(child)]


def _state(splitter: QSplitter) -> Tree:
    side = "right" if splitter.orientation() is Qt.Orientation.Horizontal else "below"
    parts = [_state(child) if isinstance(child, QSplitter) else child.objectName() for child in _children(splitter)]
    return {"split": side, "sizes": splitter.sizes(), "parts": parts}


def _fill(splitter: QSplitter, tree: Tree, leaves: Mapping[str, QWidget]) -> None:
    for part in tree["parts"]:
        if isinstance(part, str):
            splitter.addWidget(leaves[part])
            leaves[part].setVisible(leaves[part].property(CLOSED) is not True)
        else:
            nested = _splitter(part["split"])
            splitter.addWidget(nested)
            _fill(nested, part, leaves)
    splitter.setSizes(tree["sizes"])
