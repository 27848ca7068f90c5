"""The README inside the window: chapters, search, and the chapter that belongs to what is in use."""
