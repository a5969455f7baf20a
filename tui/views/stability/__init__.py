"""The stability map (F5): computed by `view`, shown by `pane` as a `picture`.

`words` describe the outcome of one swing.  The command `pendu-tui stability` draws the same
picture.
"""
