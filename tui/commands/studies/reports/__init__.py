"""What the commands `accuracy` and `stability` print, kept apart from their options because it loads NumPy and Rich."""
