"""Race mode: solvers against each other from one start, in linked views, with curves and a time axis."""
