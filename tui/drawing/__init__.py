"""Numbers -> characters with colours.

`canvas` draws dots and lines in braille and yields a Picture, characters with whose they are; `axes` finds round
labels, and what of a series falls into each column; `loglog` places points between two logarithmic axes, `chart` has
plotext draw curves along axes, `time_chart` those of a run; `palette` gives the colours of a theme; `sketch` is a
canvas for few dots that are drawn anew with every frame, `trails` keep many from frame to frame; `cells` shows a
Picture, a Sketch or rows of text in a widget, `painted` keeps what Textual has been given of them, and `faults`
reports errors there.
"""
