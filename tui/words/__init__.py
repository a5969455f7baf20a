"""What the numbers mean, in English sentences: Source -> text, without colours and without a screen.

`findings` says what each method does, and `motion` what the exact pendulum does; `numbers` writes the numbers.
From these, `insight` picks the one sentence of the moment, `events` makes the list of what happened, `describe` puts
the whole state into sentences, and `plain_text` prints it all where there is no screen.  `cards` describes methods
and scenes, `command_line` gives the command that shows a moment again, and `recovered` reports recordings that were
left unfinished.  `tour` has the steps of the tour, and says them.
"""
