"""Laws of who flies: the take-off, the shape in the air, the landing."""
