"""Error over cost and time (F4): computed by `view`, shown by `pane` as a `chart`.

The command `pendu-tui accuracy` draws the same chart.
"""
