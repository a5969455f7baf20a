"""What `accuracy`, `stability` and `section` print, kept apart from their options because it loads NumPy and Rich."""
