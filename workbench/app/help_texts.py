"""The words of the Help menu."""

from __future__ import annotations

SHORTCUTS = """
<h3>Mouse</h3>
<table cellspacing="6">
<tr><td>move</td><td>shows which vertex is meant</td></tr>
<tr><td>click</td><td>sets an anchor, or selects one</td></tr>
<tr><td>drag, target</td><td>moves an anchor with its group, in the plane of the view</td></tr>
<tr><td>X, Y, Z while dragging</td><td>along that axis; with Shift in the plane across it; once more: free</td></tr>
<tr><td>N while dragging</td><td>along the normal</td></tr>
<tr><td>Esc while dragging</td><td>back to where it was</td></tr>
<tr><td>arrows and rings</td><td>pull and turn the selected anchors; with Ctrl by stops of 15°</td></tr>
<tr><td>double click, Enter</td><td>place the selected anchors by numbers</td></tr>
<tr><td>Alt+click</td><td>anchors a whole face, or side of a figure, as one group</td></tr>
<tr><td>B, or Shift+drag</td><td>anchors what is seen in a box as one group; with Ctrl also what is behind</td></tr>
<tr><td>right click</td><td>removes an anchor; elsewhere, and on a group: a menu</td></tr>
<tr><td>wheel</td><td>zooms at the pointer</td></tr>
<tr><td>middle drag</td><td>pans</td></tr>
<tr><td>left drag, in space</td><td>turns the view</td></tr>
<tr><td>double click on the background</td><td>fits the view</td></tr>
</table>
<h3>Keys</h3>
<table cellspacing="6">
<tr><td>Space</td><td>run, pause</td></tr>
<tr><td>. (period)</td><td>one step</td></tr>
<tr><td>Home</td><td>reset to the start</td></tr>
<tr><td>F</td><td>fit all views</td></tr>
<tr><td>E</td><td>show or hide edges</td></tr>
<tr><td>Ctrl+Z, Ctrl+Shift+Z</td><td>undo, redo</td></tr>
<tr><td>Ctrl+Alt+S, Ctrl+Shift+O</td><td>save the session, open one</td></tr>
<tr><td>Delete</td><td>remove the selected anchors</td></tr>
<tr><td>Esc</td><td>clear the brush</td></tr>
<tr><td>Ctrl+E</td><td>compose a figure of what is shown: PDF, SVG, PNG</td></tr>
<tr><td>Ctrl+H</td><td>compare maps by their shape signatures</td></tr>
<tr><td>Ctrl+I</td><td>inspector: formula, properties and plots of the distortion</td></tr>
<tr><td>Ctrl+Shift+R</td><td>race solvers against each other</td></tr>
<tr><td>Ctrl+D</td><td>take the next step apart</td></tr>
<tr><td>Ctrl+J</td><td>is the map one-to-one? where not?</td></tr>
<tr><td>F3, Shift+F3</td><td>next and previous place to blame</td></tr>
<tr><td>Ctrl+B</td><td>pin the boundary</td></tr>
<tr><td>Ctrl+.</td><td>stop what hangs</td></tr>
</table>
<h3>Solids</h3>
<table cellspacing="6">
<tr><td>C, Shift+C</td><td>cut across the line of sight; show all again</td></tr>
<tr><td>Cut</td><td>a plane of the source (⋯: of the target); drag its handle; ⇄ keeps the other side</td></tr>
<tr><td>Section</td><td>cuts tetrahedra through, or else leaves them whole</td></tr>
<tr><td>Peel</td><td>takes away the tetrahedra of least distortion; ⋯ chooses of which kind</td></tr>
<tr><td>Marked</td><td>draws only what is marked, as by a drag across the histogram</td></tr>
<tr><td>Spread</td><td>pulls tetrahedra apart</td></tr>
</table>
<h3>Race</h3>
<table cellspacing="6">
<tr><td>Space, . and Home</td><td>run or pause all, one step of all, restart</td></tr>
<tr><td>left, right</td><td>an iteration back or forth, with Shift ten</td></tr>
<tr><td>L</td><td>back from the past to the newest maps</td></tr>
<tr><td>X</td><td>A and B change places; hold Y for a moment's look</td></tr>
</table>
"""

ABOUT = """
<h3>Distortion Workbench</h3>
<p>Inversion-free maps of triangles and tetrahedra, and how they distort: choose a distortion, a solver and a start,
drag anchors, and watch the map follow.</p>
<p>The numbers in round brackets are equations of the survey by A. Naitsat, G. Naitzat and Y. Y. Zeevi,
<i>On Inversion-Free Mapping and Distortion Minimization</i>.</p>
"""
