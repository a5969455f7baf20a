"""The terminal: what it can do, and when it is gone.

`options` reads theme, characters, mouse and frames from the command line and the environment;
`check` tests whether the lab can be shown, and whether the terminal keeps up; `signals` ends and
stops the lab when it is asked to, and when its terminal is gone; `character_sets` turns braille
into half blocks or ASCII.
Textual's own driver does all else.
"""
