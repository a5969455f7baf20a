import json
from io import BytesIO

import pytest
from mcap.writer import Writer

from engine.run.lockstep import Sample
from recordings.events import Entry
from recordings.library import golden_names
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import pendu


def altered() -> list[Entry]:
    """A sitting in which one number of one sample was changed by one unit in the last place."""
    entries = two_runs()
    place = next(
        i for i, (_, value) in enumerate(entries) if isinstance(value, Sample) and value.step == 6
    )
    sample = entries[place].value
    reading = sample.readings[2]
    changed = reading._replace(omega=reading.omega * (1 + 2**-52))
    readings = (*sample.readings[:2], changed, sample.readings[3])
    entries[place] = entries[place]._replace(value=sample._replace(readings=readings))
    return entries


def foreign() -> bytes:
    """An MCAP file of somebody else."""
    stream = BytesIO()
    writer = Writer(stream)
    writer.start()
    writer.register_channel("/camera", "json", writer.register_schema("x", "jsonschema", b"{}"))
    writer.finish()
    return stream.getvalue()


def test_the_bundled_recordings_verify():
    outcome = pendu("verify", "golden")
    assert (outcome.code, outcome.err) == (0, "")
    for name in golden_names():
        assert f"{name}.mcap" in outcome.out


def test_json_has_the_fields_of_the_design(tmp_path):
    path = record(tmp_path / "ours.mcap", two_runs())
    answer = pendu("verify", path, "--json").json
    assert answer["schema"] == "pendu.verify/1"
    (told,) = answer["files"]
    assert (told["file"], told["complete"], told["runs"], told["identical"]) == (
        str(path),
        True,
        2,
        True,
    )
    assert (told["other_functions"], told["first_difference"]) == ([], None)


def test_a_difference_of_one_bit_is_exit_1_and_located(tmp_path):
    path = record(tmp_path / "altered.mcap", altered())
    outcome = pendu("verify", path)
    assert outcome.code == 1
    assert outcome.out.startswith("different ")
    for word in (str(path), "run 1, step 6", "velocity_verlet", "omega", "0x1."):
        assert word in outcome.out
    (told,) = pendu("verify", path, "--json").json["files"]
    difference = told["first_difference"]
    assert (difference["run"], difference["step"], difference["method"]) == (
        1,
        6,
        "velocity_verlet",
    )


def test_a_folder_means_all_recordings_below_it(tmp_path):
    (tmp_path / "a").mkdir()
    record(tmp_path / "one.mcap", two_runs())
    record(tmp_path / "a" / "two.mcap", two_runs())
    outcome = pendu("verify", tmp_path)
    assert outcome.out.count("identical   ") == 2
    assert outcome.out.endswith("2 recordings, 2 identical\n")


def test_a_folder_without_recordings_has_not_been_verified(tmp_path):
    assert pendu("verify", tmp_path).refused(3, "no recordings in this folder")


def test_an_incomplete_recording_fails_the_check_with_its_reason(tmp_path):
    path = record(tmp_path / "cut.mcap", two_runs())
    path.write_bytes(path.read_bytes()[:-40])
    outcome = pendu("verify", path)
    assert outcome.code == 1
    assert outcome.out.startswith("unfinished  ")
    assert "its end is missing" in outcome.out
    (told,) = pendu("verify", path, "--json").json["files"]
    assert (told["complete"], told["identical"]) == (False, True)
    assert pendu("verify", path, record(tmp_path / "whole.mcap", two_runs())).out.endswith(
        "2 recordings, 1 identical\n"
    )


def test_the_leftover_of_a_killed_lab_verifies_as_far_as_it_goes(tmp_path):
    path = record(tmp_path / "a.mcap", two_runs()).rename(tmp_path / "a.mcap.part")
    path.write_bytes(path.read_bytes()[:-40])
    outcome = pendu("verify", path)
    assert (outcome.code, outcome.out.split()[0]) == (0, "identical")
    assert "its end is missing" in outcome.out


@pytest.mark.parametrize(
    "content", [b"", b"hello", b"\x89MCAP0\r\n", foreign()], ids=["empty", "text", "cut", "foreign"]
)
def test_a_file_that_is_not_a_recording_is_one_sentence_and_exit_3(tmp_path, content):
    path = tmp_path / "file.mcap"
    path.write_bytes(content)
    assert pendu("verify", path).refused(3, str(path))
    assert pendu("recordings", "show", path).refused(3, str(path))
    assert pendu("replay", path, "--plain").refused(3, str(path))
    assert pendu("export", path).refused(3, str(path))
    assert pendu("recordings", "recover", path, "-o", tmp_path / "out.mcap").refused(3, str(path))
    assert [other.name for other in tmp_path.iterdir()] == ["file.mcap"]


def test_an_unreadable_file_does_not_keep_the_others_from_being_verified(tmp_path):
    (tmp_path / "a.mcap").touch()
    record(tmp_path / "b.mcap", two_runs())
    outcome = pendu("verify", tmp_path)
    assert (outcome.code, outcome.err.count("\n")) == (3, 1)
    assert [line.split()[0] for line in outcome.out.splitlines()] == ["identical", "2"]
    assert [
        told["identical"] for told in json.loads(pendu("verify", tmp_path, "--json").out)["files"]
    ] == [False, True]


def test_an_unknown_name_does_not_keep_the_others_from_being_verified(tmp_path):
    path = record(tmp_path / "a.mcap", two_runs())
    outcome = pendu("verify", "no/such.mcap", path)
    assert (outcome.code, outcome.err.count("\n")) == (3, 1)
    assert [line.split()[0] for line in outcome.out.splitlines()] == ["identical", "2"]
    missing, there = pendu("verify", "no/such.mcap", path, "--json").json["files"]
    assert (missing["file"], missing["identical"], there["identical"]) == (
        "no/such.mcap",
        False,
        True,
    )
    assert "there is no recording 'no/such.mcap'" in missing["error"]


def test_only_the_methods_asked_for_are_compared(tmp_path):
    path = record(tmp_path / "ours.mcap", altered())  # one number of velocity Verlet
    assert pendu("verify", path).code == 1
    assert pendu("verify", path, "--methods", "rk4,verlet").code == 1
    assert pendu("verify", path, "--methods", "rk4,s").code == 0
    assert pendu("verify", path, "--methods", "rk5").refused(2, "did you mean rk4?")
    assert (
        pendu("run", "--time", "2", "--methods", "rk4", "--record", tmp_path / "alone.mcap").code
        == 0
    )
    assert pendu("verify", tmp_path / "alone.mcap", "--methods", "rk4").code == 0
    assert pendu("verify", tmp_path / "alone.mcap", "--methods", "s,v").refused(
        3, "run 1 has none of the methods sym"
    )


def test_a_recording_of_other_numerics_is_named_as_such(tmp_path, monkeypatch):
    with monkeypatch.context() as earlier:
        earlier.setattr("recordings.arithmetic.NUMERICS", 1)
        path = record(tmp_path / "earlier.mcap", two_runs())
    assert "made with version 1 of the numerics, this is version" in pendu("verify", path).out
