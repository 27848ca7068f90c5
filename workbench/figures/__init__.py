"""Headless figures."""
