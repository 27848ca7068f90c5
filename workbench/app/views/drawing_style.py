"""How things are drawn that a user may have otherwise: one place that all views of the program read."""

from __future__ import annotations

ANCHOR_RADIUS, EDGE_WIDTH, EDGES_UP_TO, COLOUR_MAP = 6.5, 1.0, 12_000, "CET_L19"

anchor_radius = ANCHOR_RADIUS
"""Of an anchor's disc, in pixels."""
edge_width = EDGE_WIDTH
"""Of the edges of simplices, in pixels."""
edges_up_to = EDGES_UP_TO
"""Triangles up to which their edges are drawn unasked."""
colour_map = COLOUR_MAP
"""Of distortions: a table of colorcet that has no yellow, which stands for inverted simplices."""


def restore() -> None:
    """As it was in the beginning."""
    global anchor_radius, edge_width, edges_up_to, colour_map
    anchor_radius, edge_width, edges_up_to, colour_map = ANCHOR_RADIUS, EDGE_WIDTH, EDGES_UP_TO, COLOUR_MAP
