"""Refining the mesh that is open."""
