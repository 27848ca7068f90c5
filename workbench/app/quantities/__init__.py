"""What can be shown on simplices, by name or formula."""
