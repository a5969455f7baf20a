"""The screens: the frame around the views, and the actions of the keys.

`launch` opens the lab or a replay and runs the `app` (themes, signals, which screen follows the clock).
`base` has the screen that both share: each frame the source follows the clock and its sample goes down to the views
and lines; actions go up to the source; `host` is what it needs of the app.  `live` adds what changes a run, `replay`
what moves in a recording; `tour` shows the shots of the tour in the lab.  Around a view: `status_line`, `seek_bar`,
`insight_line`, `key_line`, or `too_small` alone; styles are in app.tcss.  Each key is a line of BINDINGS beside its
action: `key_line`, `help` and `palette` are made from them.  Over the lab lie the `dialogs`, in a folder of their own,
and `still` makes the picture of `pendu-tui snapshot`.
"""
