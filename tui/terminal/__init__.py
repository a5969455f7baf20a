"""The terminal, below Textual: what it can do, and what is sent to it.

Before the screen: `options` reads theme, characters, mouse and frames from the command line and the environment;
`check` tests whether the lab can be shown, and later whether the terminal is still there; `watchdog` ends the lab
where it is not.
Each frame: Textual -> `character_sets` (braille to half blocks or ASCII) -> `driver` -> terminal.  The driver handles
stop and continue, and measures its writes for `throughput`; on a slow line it sends `sgr`'s shorter form.
`screenshot` saves the screen as SVG and text, `asciicast` encodes a film for a terminal, `fault_log` keeps the errors
that did not end the lab.
"""
