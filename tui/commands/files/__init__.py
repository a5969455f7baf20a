"""Recordings: `verify`, `info`, `diff`, `recover`, `export`, and the list of them, `recordings`.

`foxglove` makes the layout with which other viewers show one.
"""
