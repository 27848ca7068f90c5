"""Reading the numbers of what is under the pointer."""
