"""Files of what the window shows."""
