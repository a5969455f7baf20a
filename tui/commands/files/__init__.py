"""Commands about recordings: `verify`, `diff`, `export`, and `recordings`, the list of them."""
