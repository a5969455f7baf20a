"""Error over cost and over time (F4)."""
