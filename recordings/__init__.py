"""Recordings: MCAP in and out.

    samples, events --format--> messages --recorder--> file --framing--> chunks --contents--> samples, events
                                                        |
                                                        +-- summary   its index, if it is whole    > recording
                                                        +-- scan      every byte, past any damage  > verify, recover

- What a file holds: `events`; `fields`, the one table of names and units; `format`, messages to bytes and back.
- Writing: `recorder` writes one file, `live_recorder` goes on when the disk fails, `headless` runs without a screen.
- Reading: `framing` takes records apart, `contents` knows channels and chunks, by the `summary` or by a `scan`.
- Using: `recording` gives any moment, with its events and runs in the columns of `timeline`; `verify`
  re-simulates each run; `recover` salvages what is intact, also of killed labs; `diff` compares two recordings.
- Files: `library` (the folder, the names, and who is using a file), `errors`.

Data: `golden/` has the bundled recordings, `viewers/` a layout for Foxglove.
"""
