"""The window in which maps are compared by their shape signatures."""
