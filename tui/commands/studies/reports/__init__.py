"""What `accuracy`, `stability` and `section` print, kept apart from their options because it loads NumPy and Rich.

`references` prints the reference lines of `accuracy --all`, and lists the points of all lines for JSON and CSV;
`orders` says why a measured order is not the claimed one.
"""
