"""Faults of ours or of a plugin: told once, with a way to keep the work; nothing is sent anywhere."""
