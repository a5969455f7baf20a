"""What the numbers mean, in English: Source -> text, without colours or a screen.

`numbers` formats numbers.  `insight` chooses the sentence of the moment, `events` lists what
happened, and `plain_text` describes the whole state, also without a screen.  `cards` describe
methods and scenes, `orbit` a method's own map; `command_line` is the command that repeats a moment;
`accuracy` is about costs and growing errors; `tour` has the steps of the tour.
"""
