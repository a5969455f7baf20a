"""The screens: the frame around the views, and the actions of the keys.

`launch` opens the lab or a replay and runs the `app` (themes, signals, the screen in front).
`base` has the screen that both share: with each frame the source follows the clock, and its sample
goes down to the views and `lines`; actions go up to the source.  `live` changes a run and shows the
tour, `replay` moves in a recording.  Each key is a line of BINDINGS beside its action; styles are
in app.tcss.  `dialogs` lie over the lab, and `still` makes a snapshot.
"""
