"""The screen and the command line.  A room imports only rooms below it:

- `commands`: one module a subcommand.
- `screens`: the app, the live and the replay screen, and the lines around a view.
- `views`: lab, phase space, accuracy and stability, each with its panes, pictures, words and keys.
- `words`: sentences; `terminal`: what the terminal can do, and how it is driven.
- `drawing`: numbers into characters: canvas, axes, charts, colours, cells.
- `playback`: what a screen shows, a lab or a recording, and its clock; without Textual.
- `cli`: what all commands share; `__main__` starts it for `python -m pendu_tui.tui`.
"""
