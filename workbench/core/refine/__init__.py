"""Refining a mesh together with a map of it: linear, Loop, Catmull-Clark (section 9, Fig. 20)."""

from workbench.core.refine.level_measures import FIGURE_20, LevelMeasures, measure_levels
from workbench.core.refine.refined import MOST_SIMPLICES, SCHEMES, Refined, refine, refined_count, refined_levels

__all__ = [
    "FIGURE_20",
    "MOST_SIMPLICES",
    "SCHEMES",
    "LevelMeasures",
    "Refined",
    "measure_levels",
    "refine",
    "refined_count",
    "refined_levels",
]
