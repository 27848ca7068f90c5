"""The words of the Help menu."""

from __future__ import annotations

ABOUT = """
<h3>Distortion Workbench</h3>
<p>Inversion-free maps of triangles and tetrahedra, and how they distort: choose a distortion, a solver and a start,
drag anchors, and watch the map follow.</p>
<p>The numbers in round brackets are equations of the survey by A. Naitsat, G. Naitzat and Y. Y. Zeevi,
<i>On Inversion-Free Mapping and Distortion Minimization</i>.</p>
"""
