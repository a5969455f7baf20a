"""What `accuracy`, `stability` and `section` print, kept apart from their options because it loads NumPy and Rich.

`front` is what `accuracy --all` says more: the lines beside the methods, and who is ahead; `orders` says why a measured
order is not the claimed one.
"""
