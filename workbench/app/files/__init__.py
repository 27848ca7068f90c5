"""Asking for files, by dialog or by drop."""
