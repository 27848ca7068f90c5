"""What is open: mesh, choices, anchors and map, and the talk with the engine about them."""
