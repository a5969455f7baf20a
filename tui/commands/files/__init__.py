"""Recordings: `verify`, `info`, `diff`, `recover`, `export`, and the list of them, `recordings`."""
