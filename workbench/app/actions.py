"""Everything that menus, buttons and keys can do, named once."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction, QKeySequence

from workbench.app.appearance.icons import DRAWINGS, icon
from workbench.app.appearance.theme import Theme
from workbench.app.exporting.export_kinds import KINDS

TITLE = "title"
"""Property of an action whose text changes: what it is called in lists that stand for good."""


@dataclass(frozen=True)
class ActionText:
    """Words, keys and tip of one action; `picture` names an icon."""

    text: str
    keys: tuple[str, ...] = ()
    tip: str = ""
    picture: str = ""
    checkable: bool = False


TEXTS: dict[str, ActionText] = {
    "open": ActionText("&Open…", ("Ctrl+O",), "Open a mesh or a case", "open"),
    "save": ActionText("&Save map…", ("Ctrl+S",), "Save the map as OBJ, npz or VTU", "save"),
    "fill": ActionText("Fill &with tetrahedra…", (), "Make a solid of a closed surface"),
    "open-session": ActionText("Open s&ession…", ("Ctrl+Shift+O",), "Open a session: mesh, choices, anchors and map"),
    "save-session": ActionText("Save sess&ion", ("Ctrl+Alt+S",), "Save mesh, choices, anchors and map as they are now"),
    "save-session-as": ActionText("Save session &as…", (), "Save the session to another file"),
    "undo": ActionText("Undo", ("Ctrl+Z",), "Take the last step back"),
    "redo": ActionText("Redo", ("Ctrl+Shift+Z", "Ctrl+Y"), "Do the step again that was taken back last"),
    "refine": ActionText("&Refine source and map…", ("Ctrl+R",), "Refine the mesh with its map; distortion against level"),
    "figure": ActionText("Fi&gure…", ("Ctrl+E",), "Compose a figure fit to print of what the window shows"),
    "shot-window": ActionText("The &window…", ("Ctrl+Shift+S",), "Save a picture of the whole window"),
    **{name: ActionText(kind.text, (), kind.tip) for name, kind in KINDS.items()},
    "quit": ActionText("&Quit", ("Ctrl+Q",), "Close the window; what was not saved is kept as the last session"),
    "pin": ActionText("&Pin boundary", ("Ctrl+B",), "Set an anchor at every boundary vertex, where it is now", "pin"),
    "pin-loop": ActionText("Pin a l&oop", (), "Anchor the loop of the boundary that you click, where it is now"),
    "pin-path": ActionText("Pin a pa&th", ("P",), "Anchor the shortest path along edges between two clicks (P)"),
    "box": ActionText("Anchor a &box", ("B",), "Anchor the vertices in a box that you drag, as one group (B)"),
    "lasso": ActionText("Anchor a &lasso", ("L",), "Anchor the vertices in a lasso that you draw, as one group (L)"),
    "select-all": ActionText("Select &all anchors", ("Ctrl+A",), "Select every anchor"),
    "select-none": ActionText("Select &no anchor", (), "Nothing is selected any longer"),
    "select-box": ActionText("Select a &box", ("Shift+B",), "Select the anchors in a box; Shift adds, Ctrl takes away"),
    "select-lasso": ActionText("Select a &lasso", ("Shift+L",), "Select the anchors in a lasso; Shift adds, Ctrl takes away"),
    "through": ActionText("Also what is &hidden", (), "Boxes and lassos take what the solid hides, too", checkable=True),
    "group": ActionText("&Group anchors", ("Ctrl+G",), "The selected anchors move together from now on"),
    "ungroup": ActionText("&Ungroup anchors", ("Ctrl+Shift+G",), "Each of the selected anchors moves alone from now on"),
    "move": ActionText("&Move anchors", ("G",), "The selected anchors follow the pointer; X, Y, Z: axis, or type numbers (G)"),
    "turn": ActionText("&Turn anchors", ("R",), "Turn the selected anchors; X, Y, Z: axis, or type degrees (R)"),
    "scale": ActionText("&Scale anchors", ("S",), "Scale the selected anchors; X, Y, Z: axis, or type a factor (S)"),
    "mirror": ActionText("&Mirror", ("M",), "Mirror twins of anchors move likewise (M)", "mirror", checkable=True),
    "mirror-x": ActionText("&x to -x", (), "The plane across x through the middle of the source", checkable=True),
    "mirror-y": ActionText("&y to -y", (), "The plane across y through the middle of the source", checkable=True),
    "mirror-z": ActionText("&z to -z", (), "The plane across z through the middle of the source", checkable=True),
    "mirror-found": ActionText("As &found", (), "The plane about which the source is most symmetric", checkable=True),
    "falloff": ActionText("&Falloff", ("O",), "Anchors near by follow; the wheel: how far (O)", "falloff", checkable=True),
    "falloff-edges": ActionText("Fallo&ff along edges", (), "Distances on the mesh; or else straight ones", checkable=True),
    "remove": ActionText("&Remove selected anchors", ("Del", "Backspace"), "Let the selected anchors go"),
    "import-anchors": ActionText("I&mport anchors…", (), "Read anchors from a CSV file, or from one of a spreadsheet"),
    "export-anchors": ActionText("E&xport anchors…", (), "Write vertices, targets, weights and groups as a CSV file"),
    "clear": ActionText("&Clear anchors", ("Ctrl+Shift+A",), "Remove all anchors", "clear"),
    "equations": ActionText("&Linear equations…", ("Ctrl+L",), "Bind coordinates of the map, by equations typed or in a file"),
    "run": ActionText("Run", ("Space",), "Run or pause the solver (Space)", "run"),
    "step": ActionText("Step", (".",), "Take one iteration (.)", "step"),
    "reset": ActionText("Reset", ("Home",), "Make the start anew (Home)", "reset"),
    "stop": ActionText("Stop", ("Ctrl+.",), "End what hangs; the last good map stays (Ctrl+.)", "stop"),
    "fit": ActionText("&Fit views", ("F",), "Show everything in every view (F)", "fit"),
    "edges": ActionText("Show &edges", ("E",), "Sides of all triangles, in source and target (E)", checkable=True),
    "wireframe": ActionText("&Wireframe", ("W",), "Sides of triangles in their colours, nothing within (W)", checkable=True),
    "seams": ActionText("&Seams", (), "Where the texture of the file jumps, and where a fix cut", checkable=True),
    "boundary": ActionText("&Boundary", (), "Edges of one triangle only", checkable=True),
    "scale-bar": ActionText("Scale ba&r", (), "A length in units of the mesh, across the line of sight", checkable=True),
    "split-right": ActionText("Split &right", ("Ctrl+\\",), "One more view to the right of the one that was clicked last"),
    "split-below": ActionText("Split &below", ("Ctrl+Alt+\\",), "One more view below the one that was clicked last"),
    "close-view": ActionText("Close vie&w", ("Ctrl+W",), "Close the view that was clicked last; View > Views has them again"),
    "readings": ActionText("Rea&dings", ("V",), "Every number of the simplex under the pointer (V)", checkable=True),
    "copy-readings": ActionText("Copy readin&gs", ("Ctrl+Shift+C",), "Copy the numbers that were read last, for a spreadsheet"),
    "lock": ActionText("&Hold colour ranges", (), "Keep the ranges of the colour bars as they are", checkable=True),
    "picture": ActionText("&Picture…", (), "Lay a PNG or JPEG over the source; it can be dropped on a view, too"),
    "pattern": ActionText("&Size and turn…", (), "How large patterns are, how they are turned, where they are even"),
    "glyphs-none": ActionText("&None", (), "No glyphs", checkable=True),
    "glyphs-stretches": ActionText("&Stretches", (), "Singular vectors: stretched red, squeezed blue", checkable=True),
    "glyphs-ellipses": ActionText("&Ellipses", (), "What the map makes of equal circles, in space of balls", checkable=True),
    "glyphs-on-source": ActionText("On the s&ource", (), "Show glyphs on the source", checkable=True),
    "glyphs-on-target": ActionText("On the &target", (), "Show glyphs on the target", checkable=True),
    "glyphs-more": ActionText("&More glyphs", (), "Half as many again, up to 2000"),
    "glyphs-fewer": ActionText("&Fewer glyphs", (), "A third fewer"),
    "glyphs-larger": ActionText("&Larger glyphs", (), "Half as large again"),
    "glyphs-smaller": ActionText("S&maller glyphs", (), "A third smaller"),
    "unbrush": ActionText("Clear &brush", ("Esc",), "No simplex is marked any longer (Esc)"),
    "cut": ActionText("&Cut the solid", ("C",), "A plane across the line of sight, or none", checkable=True),
    "uncut": ActionText("Show &all of the solid", ("Shift+C",), "Neither cut, peeled nor pulled apart (Shift+C)"),
    "signatures": ActionText("Shape &signatures…", ("Ctrl+H",), "Compare maps by their histograms of (78)"),
    "race": ActionText("&Race solvers…", ("Ctrl+Shift+R",), "Let solvers run against each other from one start"),
    "judge": ActionText("&Injectivity…", ("Ctrl+J",), "Whether the map is one-to-one, and where it is not"),
    "next-place": ActionText("&Next inverted simplex", ("F3",), "To the next inverted simplex, or place of the verdict (F3)"),
    "last-place": ActionText("Previous inverted simplex", ("Shift+F3",), "To the inverted simplex or place before (Shift+F3)"),
    "worst": ActionText("W&orst simplex", ("F4",), "To the worst simplex by what is shown; again: the next worst (F4)"),
    "less-bad": ActionText("One worse", ("Shift+F4",), "Back to the simplex that is one worse (Shift+F4)"),
    "dissect": ActionText("A step &dissected…", ("Ctrl+D",), "Direction, bound and line search of the next step"),
    "save-layout": ActionText("&Save the layout as…", (), "Keep the panels as they lie now under a name"),
    "present": ActionText("&Present", ("F11",), "Views alone on the whole screen; F11 ends it", checkable=True),
    "preferences": ActionText("Pre&ferences…", ("Ctrl+,",), "What the window looks like, begins with and keeps"),
    "palette": ActionText("&Command palette…", ("Ctrl+Shift+P",), "Find whatever the window can do by a few letters"),
    "past-live": ActionText("&Newest map", (), "Let the views show the newest map again, as it comes"),
    "past-go-on": ActionText("&Go on from here", (), "Take the earlier map that is shown, with its anchors; undo brings back"),
    "past-compare": ActionText("&Compare A and B…", (), "How two moments of the time line differ: maps, colours, displacement"),
    "film": ActionText("&Film…", (), "Make a GIF or an MP4 of the time line"),
    "help": ActionText("&Help", ("F1",), "The README, at the chapter about what is in use (F1)"),
    "log": ActionText("&Log", (), "All that was told, with times and details"),
    "shortcuts": ActionText("&Keys and mouse…", ("Ctrl+F1",), "Every key and gesture, to be searched, copied and printed"),
    "cite": ActionText("&Cite what this session uses…", (), "Distortions, solvers and start as BibTeX, with the survey"),
    "report": ActionText("&Report on the mesh", (), "What was found in the file, and what was done to it"),
    "about": ActionText("&About", (), "What this program is, and which survey it follows"),
}


def make_actions(parent: QObject, theme: Theme) -> dict[str, QAction]:
    """One `QAction` for each text; whoever wants one connects to `triggered`."""
    actions = {}
    for name, text in TEXTS.items():
        action = QAction(text.text, parent)
        action.setObjectName(name)
        action.setShortcuts([QKeySequence(key) for key in text.keys])
        action.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        action.setCheckable(text.checkable)
        action.setToolTip(text.tip)
        action.setStatusTip(text.tip)
        actions[name] = action
    set_icons(actions, theme)
    return actions


def set_icons(actions: dict[str, QAction], theme: Theme) -> None:
    for name, text in TEXTS.items():
        if text.picture in DRAWINGS:
            actions[name].setIcon(icon(text.picture, theme))


def show_running(action: QAction, is_running: bool, theme: Theme) -> None:
    """Turn Run into Pause and back."""
    action.setText("Pause" if is_running else "Run")
    action.setIcon(icon("pause" if is_running else "run", theme))
