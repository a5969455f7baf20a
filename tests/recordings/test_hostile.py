"""Hostile files: commands answer in time, in a sentence, and print nothing that steers a terminal."""

import time

import pytest

from tests.recordings.hostile import FILES, false_heads, write
from tests.tui.command_line import pendu

MAX_SECONDS = 10.0  # on a busy machine


@pytest.mark.parametrize("name", FILES)
def test_a_hostile_file_is_answered_in_time_with_a_sentence(tmp_path, name):
    path = tmp_path / "hostile.mcap"
    write(path, FILES[name]())
    for command in (
        ("verify", path),
        ("recordings", "show", path),
        ("recordings", "recover", path, "-o", tmp_path / "out.mcap", "--force"),
        ("export", path, "-o", tmp_path / "out.csv", "--force"),
    ):
        began = time.process_time()
        answer = pendu(*command)
        assert time.process_time() - began < MAX_SECONDS
        assert answer.code in (0, 1, 3)
        assert (answer.out + answer.err).replace("\n", "").isprintable()
    if name == "h of 0":
        assert pendu("verify", path).refused(3, "cannot have been recorded")
        assert pendu("replay", path, "--plain").code == 3


def test_work_is_proportional_to_the_size_of_a_file_of_false_chunks(tmp_path):
    path = tmp_path / "heads.mcap"
    path.write_bytes(false_heads(count=100_000))
    began = time.process_time()
    assert pendu("verify", path).refused(3, "its end is missing")
    assert time.process_time() - began < MAX_SECONDS  # if each chunk of 4 MB were read, 100 s
