"""What is said about work under way and about what went wrong."""
