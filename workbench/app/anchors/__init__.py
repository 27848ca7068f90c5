"""Anchors as a table: shown, edited, copied, pasted, read and written."""
