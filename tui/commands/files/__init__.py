"""Recordings: `verify`, `info`, `recover`, `export`, and the list of them, `recordings`."""
