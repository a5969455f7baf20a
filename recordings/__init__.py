"""Recordings: MCAP in and out.

The bytes of a file become numbers in one way, and each module is a stretch of it:

    bytes > framing > chunks of messages > layout > entries: samples and events, by format
               |
               +-- walk      the whole file in order, every checksum, past damage > verify, recover
               +-- summary   what is where, from its end: one look                > recording (the player)

`index` is what `recording` opens a file with: by the summary or, where that does not hold, by a walk.

- What a file holds: `events`, `fields` (the table), `format` (to bytes and back).
- Writing: `recorder` one file, `sitting` a sitting whatever becomes of the disk, `headless` a run without a screen.
- Reading: `recording` any moment, `export` all of it as CSV, `verify` by a `rerun` of each run, `recover` what is
  intact as a new file, `rescue` that for what a killed sitting left.
- Files: `names`, `lock` (who is using one), `library` (the folder), `errors`.
"""
