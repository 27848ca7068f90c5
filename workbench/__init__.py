"""Distortion Workbench: inversion-free maps of least distortion between simplicial meshes."""

__version__ = "0.1.0"
