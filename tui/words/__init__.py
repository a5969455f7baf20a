"""What the numbers mean, in English: Source -> text, without colours or a screen.

`motion` is about the exact pendulum, and `orbit` about the orbits of a method's own map; `numbers`
writes the numbers. `insight` chooses the fact of the moment and has the table of its sentences,
`events` makes the list of what happened, `undone` describes an undo, `describe` puts the whole
state into sentences, and `plain_text` prints it all where there is no screen.  `cards` describes
methods and scenes, `command_line` gives the command that shows a moment again. `accuracy` names the
cheapest method at each accuracy and the growth of errors; `tour` has the steps of the tour.
"""
