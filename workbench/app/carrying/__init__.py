"""A surface that the map of a solid carries with it, in the window."""
