"""Error over cost (F4)."""
