"""What to cite for what the window shows."""
