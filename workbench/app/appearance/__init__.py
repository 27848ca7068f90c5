"""Themes, icons and the style sheet."""
