"""Readers and writers of meshes, maps, anchors and reports."""
