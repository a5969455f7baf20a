"""What `accuracy`, `stability` and `section` print, kept apart from their options because it loads NumPy and Rich.

`references` prints the reference lines of `accuracy --all`, and lists the points of all lines for JSON and CSV;
`orders` explains measured orders that differ from the claimed ones.
"""
