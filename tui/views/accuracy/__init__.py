"""Error over cost and over time (F4): `view` has points computed, `pane` shows them as a `chart` to choose h from.

The command `pendu-tui accuracy` draws the same chart.
"""
