"""The screens: the frame around the views, and the actions of the keys.

`launch` opens the lab or a replay and runs the `app` (themes, signals, the screen in front).
`base` has the screen that both share: with each frame the source follows the clock, and its sample
goes down to the views and lines; actions go up to the source; `host` is its view of the app.
`live` changes a run, `replay` moves in a recording, `tour` shows the shots of the tour.
Around a view: `status_line`, `seek_bar`, `insight_line`, `key_line`, or `too_small` alone; styles
are in app.tcss.  Each key is a line of BINDINGS beside its action: `key_line`, `help` and `palette`
are made from them.  `dialogs` lie over the lab, and `still` makes a snapshot.
"""
