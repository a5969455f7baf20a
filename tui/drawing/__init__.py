"""Numbers -> characters in colours.

`picture` is what a widget shows: rows of characters with inks, which `palette` turns into the
colours of a theme. `canvas` draws dots, lines and words in braille and yields a Picture; `cells` is
the widget that shows one; `axes` finds round labels, and what of a series falls into each column;
`loglog` places points between two logarithmic axes, `chart` has plotext draw curves along axes,
`time_chart` those of a run.
"""
