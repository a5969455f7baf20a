"""Hostile files: commands answer in time, in a sentence, and print nothing that steers a terminal."""

import time
from unittest.mock import Mock

from pendu_tui.recordings import reader
from pendu_tui.recordings.files import MAGIC, RecordingError
from pendu_tui.recordings.format import EVENTS
from pendu_tui.recordings.recorder import Recorder
from tests.recordings.examples import false_head, two_runs
from tests.tui.command_line import pendu


def test_a_huge_message_is_answered_in_time_with_a_sentence(tmp_path):
    path = tmp_path / "hostile.mcap"
    with Recorder(path) as recorder:
        for clock, value in two_runs()[:2]:
            recorder.add(value, clock)
        recorder._write([(EVENTS, b'{"text": "' + b"x" * (1 << 27) + b'"}')], 1.0)
    for command in (
        ("verify", path),
        ("recordings", "show", path),
        ("recordings", "recover", path, "-o", tmp_path / "out.mcap"),
        ("export", path, "-o", tmp_path / "out.csv"),
    ):
        began = time.process_time()
        answer = pendu(*command)
        assert time.process_time() - began < 10.0  # s, on a busy machine
        assert answer.code in (0, 1, 3)
        assert (answer.out + answer.err).replace("\n", "").isprintable()


def test_work_is_proportional_to_the_size_of_a_file_of_false_chunks(tmp_path, monkeypatch):
    path = tmp_path / "heads.mcap"
    path.write_bytes(MAGIC + 100_000 * false_head().ljust(100, b"\0"))
    monkeypatch.setattr(reader, "read_chunk", Mock(side_effect=9 * [RecordingError("none")]))
    assert pendu("verify", path).refused(3, "its end is missing")
