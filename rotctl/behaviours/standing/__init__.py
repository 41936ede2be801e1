"""Laws of who stands: balance on feet and hands, steps, and a turn over them."""
