"""Panels where choices are made."""
