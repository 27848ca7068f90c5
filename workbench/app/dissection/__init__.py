"""The window that takes a step apart."""
