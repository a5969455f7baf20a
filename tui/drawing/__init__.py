"""Numbers -> characters in colours."""
