"""What mouse and keys do where no action stands for it: in words, by where they do it."""

from __future__ import annotations

Rows = tuple[tuple[str, str], ...]

GESTURES: dict[str, Rows] = {
    "Mouse in a view": (
        ("Move", "shows which vertex is meant"),
        ("Click", "sets an anchor, or selects one"),
        ("Shift+click, Ctrl+click", "on an anchor: one more is selected, one less"),
        ("Drag, in the target", "moves an anchor with its group and all that is selected, in the plane of the view"),
        ("Alt+click", "anchors a whole face, or side of a figure, as one group"),
        ("Shift+drag", "anchors what is seen in a box as one group; with Ctrl also what is behind"),
        ("Double click, Enter", "places the selected anchors by numbers"),
        ("Right click", "removes an anchor; elsewhere, and on a group: a menu"),
        ("Arrows and rings", "pull and turn the selected anchors; with Ctrl by stops of 15°"),
        ("Wheel", "zooms at the pointer"),
        ("Middle drag", "pans"),
        ("Left drag, in space", "turns the view"),
        ("Double click on the background", "fits the view"),
        ("Right click on its title", "splits the view, closes it, links its camera, chooses what it draws"),
    ),
    "While anchors are held": (
        ("X, Y, Z", "along that axis; with Shift in the plane across it; once more: free"),
        ("N", "along the normal"),
        ("Esc", "back to where they were"),
        ("0 to 9, . and -", "after G, R or S: so far, by so many degrees, by this factor; Tab goes to the next axis"),
        ("G, R, S", "after one of them: move, turn or scale instead"),
        ("Enter, Space or a click", "after G, R or S: stay there"),
        ("Wheel", "with falloff: how far others follow"),
    ),
    "While a box or a lasso is drawn": (
        ("B, L", "a box, a lasso instead"),
        ("T", "whether what is hidden is taken, too"),
        ("Shift, Ctrl", "held while it is drawn: add what is inside, take it away"),
        ("Esc", "leave it"),
    ),
    "While a loop or a path is pinned": (
        ("Move", "shows what would be pinned"),
        ("Click", "pins the loop; begins the path, then ends it"),
        ("Esc, right click", "leave it"),
    ),
    "Panels": (
        ("Drag across the histogram", "marks those simplices in every view; Esc clears"),
        ("Right click on a colour bar", "holds, fits or edits its range, for all views or for one"),
        ("Pointer on a mark of the curves", "what was switched there"),
        ("Click in Steps", "goes back or forth to that step"),
        ("Drag in the plane of the inspector", "marks those simplices"),
        ("Title of a panel", "drag it elsewhere; its buttons float and close it"),
    ),
    "Time line": (
        ("Drag", "looks back; the solver goes on meanwhile"),
        ("Left, Right", "by one map, with Shift by ten"),
        ("Home, End", "the first map, the newest"),
        ("Space", "plays it, or pauses"),
        ("A, B", "mark the moment that is shown; once more lets it go"),
        ("X", "from A to B and back"),
        ("L", "the newest map, as it comes"),
    ),
    "Formula": (
        ("Enter", "takes the formula that was typed"),
        ("Esc", "brings back the one before"),
        ("Ctrl+Space", "lists the names that it may hold; up, down and Tab choose"),
    ),
    "Solids": (
        ("Cut", "a plane of the source (⋯: of the target); drag its handle; ⇄ keeps the other side"),
        ("Section", "cuts tetrahedra through, or else leaves them whole"),
        ("Peel", "takes away the tetrahedra of least distortion; ⋯ chooses of which kind"),
        ("Marked", "draws only what is marked, as by a drag across the histogram"),
        ("Spread", "pulls tetrahedra apart"),
    ),
    "Command palette": (
        ("Up, Down, Page up, Page down", "choose"),
        ("Enter or a click", "does it"),
        ("Esc", "leaves it"),
    ),
}
RACE_GESTURES: Rows = (("Y, held", "a moment's look with A and B changed"), ("Slider", "all maps as they were then"))
"""Beside the actions of the race."""
VIEW_KEYS = frozenset("XYZNT")
"""Letters that mean something while anchors are held or areas are drawn, and so must not be shortcuts."""
