"""Recordings: MCAP in and out.

    samples, events --format--> messages --recorder--> file --reader--> chunks --recording--> any moment

- What a file holds: `events`; `fields`, the one table of names and units; `format`, messages to bytes and back;
  `arithmetic`, what the bits of a run depend on besides its inputs.
- Writing: `recorder` writes one file, `live_recorder` goes on when the disk fails, `headless` runs without a
  screen, `files` gives a finished file its name.
- Reading: `reader` finds the intact chunks, with mcap; `recording` gives any moment, with events and runs.
- Using: `verification` re-simulates each run; `recovery` salvages what is intact; `diff` compares two.
- Files: `library` (the folder, the names, and who is using a file), `errors`.

Data: `golden/` has the bundled recordings, `viewers/` a layout for Foxglove.
"""
