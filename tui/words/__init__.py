"""What the numbers mean, in English sentences: Source -> text, without colours and without a screen.

`findings` says what each method does, `motion` what the exact pendulum does, and `orbit` on what kind of orbit of a
method's own map a start lies; `numbers` writes the numbers.
From these, `insight` picks the one sentence of the moment, `events` makes the list of what happened, `undone` says
what an undo took back, `describe` puts the whole state into sentences, and `plain_text` prints it all where there is
no screen.  `cards` describes methods and scenes, `command_line` gives the command that shows a moment again, and
`recovered` reports recordings that were left unfinished.  `accuracy` says which method is the cheapest at each
accuracy, and how errors grow; `scope` which scenes have no map, no ring and no chart of cost, and why.  `tour` has
the steps of the tour, and says them.
"""
