"""The stability map (F5): `view` has it computed, `pane` shows it as a `picture` to choose h and amplitude from.

`words` describe the outcome of one swing.  The command `pendu-tui stability` draws the same
picture.
"""
