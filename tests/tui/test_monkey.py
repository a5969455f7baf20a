"""Five thousand random keys and clicks over all views of the real program, live and replay."""

import os
import shutil

import pytest

from recordings.library import resolve
from recordings.verify import verify
from tests.tui.monkey import ESCDELAY, SIZE, play
from tests.tui.pty_lab import PtyLab


@pytest.mark.skipif("PENDU_MONKEY" not in os.environ, reason="its keys meet the program at other moments each time")
@pytest.mark.parametrize(("command", "seed"), [("live", 1), ("replay", 2)])
def test_a_monkey_does_no_harm_and_all_it_recorded_verifies(tmp_path, command, seed):
    library = tmp_path / "library"
    arguments = [command]
    if command == "replay":
        arguments.append(str(shutil.copy(resolve("drift"), tmp_path)))  # marks are kept beside it
    with PtyLab(*arguments, size=SIZE, PENDU_RECORDINGS=str(library), ESCDELAY=ESCDELAY) as pendu:
        pendu.wait_for("Quit")
        code = play(pendu, 2500, seed)
        assert code == 0, pendu.output.decode(errors="replace").rpartition("\x1b[?1049l")[2]
    recordings = list(library.glob("*"))
    assert not [path for path in recordings if path.suffix == ".part"]
    verified = [verify(path) for path in recordings if path.suffix == ".mcap"]
    assert verified or command == "replay"  # which records only if the monkey goes on live
    assert all(each.identical for each in verified)
