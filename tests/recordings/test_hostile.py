"""Hostile files: commands answer in time, in a sentence, and print nothing that steers a terminal."""

import time

import pytest

from tests.recordings.hostile import FILES, write_file
from tests.tui.command_line import pendu

MANY = 500  # tests/bench/hostile.py: 90 000
MAX_SECONDS = 10.0  # on a busy machine


@pytest.mark.parametrize("name", FILES)
def test_a_hostile_file_is_answered_in_time_with_a_sentence(tmp_path, name):
    path = tmp_path / "hostile.mcap"
    write_file(path, name, MANY)
    commands = (
        ("verify", path),
        ("recordings", "show", path),
        ("recordings", "recover", path, "-o", tmp_path / "out.mcap", "--force"),
        ("export", path, "-o", tmp_path / "out.csv", "--force"),
        ("diff", path, path),
    )
    for command in commands:
        began = time.process_time()
        answer = pendu(*command)
        assert time.process_time() - began < MAX_SECONDS
        assert answer.code in (0, 1, 3)
        assert (answer.out + answer.err).replace("\n", "").isprintable()


@pytest.mark.parametrize("h", ["0", "5e-324", "1e300"])
def test_an_impossible_step_size_is_damage(tmp_path, h):
    path = tmp_path / "hostile.mcap"
    write_file(path, f"h of {h}", 1)
    assert pendu("verify", path).refused(3, "cannot have been recorded")
    assert pendu("replay", path, "--plain").code == 3
