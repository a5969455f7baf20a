"""What one step does to neighbouring starts, and what many steps do to many starts."""
