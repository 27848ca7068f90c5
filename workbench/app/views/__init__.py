"""Views of a mesh: what is drawn, the camera, picking, the layer of anchors above."""
