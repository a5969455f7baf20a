"""Numbers -> characters with colours.

`canvas` draws dots and lines in braille and yields a Picture, characters with whose they are; `axes` finds round
labels, and what of a series falls into each column; `chart` has plotext draw curves along axes; `palette` gives the
colours of a theme; `cells` shows a Picture or rows of text in a widget.
"""
