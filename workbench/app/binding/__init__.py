"""Linear equations between coordinates of the map, as the window shows them."""
