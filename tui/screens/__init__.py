"""The screens: what frames the views, and what happens when a key is pressed.

`launch` opens the lab or a replay and runs the `app` (themes, signals, which screen follows the clock).
`base` has the screen that both share: each frame the source follows the clock and its sample goes down to the views
and lines; actions go up to the source; `host` is what it needs of the app.  `live` adds what changes a run, `replay`
what moves in a recording. Around a view: `status_line`, `seek_bar`, `insight_line`, `key_line`, or `too_small` alone;
styles are in app.tcss.
`tour` is what the tour adds to the lab.  Over it lie the `dialogs`, in a folder of their own.
`keys` is the table of keys, `extras` has the rarely used actions and the command palette's entries, and `still`
makes the picture of `pendu-tui snapshot` and the film of `pendu-tui export --format cast`.
"""
