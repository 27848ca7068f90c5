"""A closed surface filled with tetrahedra, in the window."""
