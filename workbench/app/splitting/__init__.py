"""Views that are split: panes of the window's own, made by one factory, arranged by one tree of splitters."""
