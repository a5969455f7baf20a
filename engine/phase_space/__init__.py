"""What a step does to neighbouring starts, and what many steps do to all of them."""
