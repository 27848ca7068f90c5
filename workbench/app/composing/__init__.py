"""The figure composer of the window."""
