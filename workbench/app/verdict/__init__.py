"""Whether the present map is injective, and where it is not."""
