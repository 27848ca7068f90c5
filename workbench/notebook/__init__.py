"""A notebook's way to work: open, pose, solve, measure and draw, each with a picture and a table of what came out."""

from workbench.notebook.citing import References, references
from workbench.notebook.drawing import Drawing, figure
from workbench.notebook.measuring import Measured, measure
from workbench.notebook.solution import Solution
from workbench.notebook.solving import solve
from workbench.notebook.source import Source, load

__all__ = ["Drawing", "Measured", "References", "Solution", "Source", "figure", "load", "measure", "references", "solve"]
