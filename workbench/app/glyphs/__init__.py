"""Glyphs on the views of the window: principal stretches, and images of circles."""
