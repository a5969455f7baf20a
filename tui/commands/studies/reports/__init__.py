"""Reports of `accuracy`, of `stability` and of its --section, apart from the options because they load NumPy and Rich.

`references` prints the reference lines of `accuracy --all`, and lists the points of all lines for JSON and CSV;
`orders` explains measured orders that differ from the claimed ones.
"""
