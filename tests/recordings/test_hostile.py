"""Hostile files: commands answer in time, in a sentence, and print nothing that steers a terminal."""

import time

import pytest

from tests.recordings.hostile import FILES, false_heads, write_file
from tests.tui.command_line import pendu

MANY = 500
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
    )
    for command in commands:
        began = time.process_time()
        answer = pendu(*command)
        assert time.process_time() - began < MAX_SECONDS
        assert answer.code in (0, 1, 3)
        assert (answer.out + answer.err).replace("\n", "").isprintable()


def test_work_is_proportional_to_the_size_of_a_file_of_false_chunks(tmp_path):
    path = tmp_path / "heads.mcap"
    path.write_bytes(false_heads(count=100_000))
    began = time.process_time()
    assert pendu("verify", path).refused(3, "its end is missing")
    assert time.process_time() - began < 2.0  # 0.2 s; each chunk of 4 MB read would take 100 s


def test_an_impossible_step_size_is_damage(tmp_path):
    for name in ("h of 0", "h of 5e-324", "h of 1e300"):
        write_file(tmp_path / name, name, 1)
        assert pendu("verify", tmp_path / name).refused(3, "cannot have been recorded")
        assert pendu("replay", tmp_path / name, "--plain").code == 3
