import pytest

from pendu_tui.recordings.files import golden_names
from pendu_tui.tui.commands import verify
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import own_method, pendu


@pytest.fixture
def whole(tmp_path):
    return record(tmp_path / "whole.mcap", two_runs())


def test_golden_means_the_bundled_recordings_or_all_below_a_folder_of_that_name(
    tmp_path, monkeypatch
):
    count = len(golden_names())
    told = pendu("verify", "golden").out
    assert told.count("identical   ") == count
    assert told.endswith(f"\n{count} recordings, {count} identical\n")
    monkeypatch.chdir(tmp_path)
    below = tmp_path / "golden" / "below"
    below.mkdir(parents=True)
    assert pendu("verify", "golden").refused(3, "no recordings in this folder")
    record(below / "one.mcap", two_runs())
    assert pendu("verify", "golden").out.startswith("identical")


COMMANDS = (
    "verify FILE",
    "recordings show FILE",
    "replay FILE --plain",
    "export FILE",
    "recordings recover FILE -o out.mcap",
)


@pytest.mark.parametrize("name", ["empty.mcap", "cut.mcap", 300 * "x"], ids=len)
@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_not_a_recording_is_one_sentence_and_exit_3(command, name, here):
    (here / "empty.mcap").touch()
    (here / "cut.mcap").write_bytes(b"\x89MCAP0\r\n")
    assert pendu(*command.replace("FILE", name).split()).refused(3, name)
    assert len([*here.iterdir()]) == 2


def test_a_method_of_ones_own_that_no_recording_has_is_named(whole, tmp_path, monkeypatch):
    known = []
    monkeypatch.setattr("pendu_tui.tui.commands.verify.remember", known.extend)
    outcome = pendu("verify", whole, "--method", own_method(tmp_path))
    assert (outcome.code, "has the method mine" in outcome.err) == (0, True)
    assert [method.key for method in known] == ["mine"]


def test_other_functions_of_the_machine_and_a_changed_source_are_told(whole):
    first = {"run": 2, "step": 3, "t": 0.25, "field": "t", "method": None}
    told = verify._sentence(
        verify._row(whole, None, None)
        | {"other_functions": ["sin", "sqrt"], "changed_sources": ["mine"], "numerics": 1}
        | {"first_difference": first | {"recorded": None, "computed": 0.5}}
    )
    assert told == (
        f"different   {whole}: 10 samples in 2 runs; within tolerance only: this machine computes "
        "sin() and sqrt() differently; made with version 1 of the numerics, not "
        f"{verify.NUMERICS}; the source of mine differs from the recorded one\n"
        "  first in t at run 2, step 3, t = 0.25 s, all methods:\n"
        "    recorded nothing\n"
        "    computed 0.5 (0x1.0000000000000p-1)"
    )
