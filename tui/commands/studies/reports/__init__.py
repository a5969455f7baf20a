"""Reports of `accuracy`, of `stability` and of its --section, apart from the options: they load NumPy and Rich."""
