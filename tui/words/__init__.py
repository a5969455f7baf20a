"""What the numbers mean, in English: Source -> text, without colours or a screen.

`motion` is about the exact pendulum, `orbit` about a method's own map; `numbers` formats numbers.
`insight` chooses the sentence of the moment, `events` lists what happened, `undone` describes an
undo, `describe` the whole state, and `plain_text` prints it without a screen.  `cards` describe
methods and scenes; `command_line` is the command that repeats a moment; `accuracy` is about costs
and growing errors; `tour` has the steps of the tour.
"""
