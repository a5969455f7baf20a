import pytest

from engine.run.stepping import Stepping
from recordings.library import GOLDEN
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import pendu
from tests.tui.commands.test_verify import altered
from tests.tui.harness import recorded


def test_identical_recordings_say_so_in_three_lines(tmp_path):
    path = record(tmp_path / "ours.mcap", two_runs())
    outcome = pendu("diff", path, path)
    assert (outcome.code, outcome.err) == (0, "")
    assert outcome.out.splitlines()[2:] == ["identical: 10 samples"]


def test_names_stand_for_recordings_as_everywhere(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    (tmp_path / "mine.mcap").write_bytes((GOLDEN / "drift.mcap").read_bytes())
    assert pendu("diff", "latest", "drift").code == 0


def test_one_bit_is_found_and_shown_with_both_values(tmp_path):
    a, b = (record(tmp_path / f"{n}.mcap", entries) for n, entries in enumerate((two_runs(), altered())))
    outcome = pendu("diff", a, b)
    assert outcome.code == 1
    assert "first in omega at run 1, step 6, t = 0.6 s, velocity_verlet:" in outcome.out
    assert "1 ulps apart" in outcome.out
    first = pendu("diff", a, b, "--json").json["first_difference"]
    assert (first["run"], first["step"], first["method"], first["field"]) == (1, 6, "velocity_verlet", "omega")
    assert (float.fromhex(first["a_hex"]), float.fromhex(first["b_hex"])) == (first["a"], first["b"])


@pytest.mark.parametrize("other", ["drift", "spin", "reversed-time", "near-separatrix"])
def test_its_tables_fit_80_columns(other):
    lines = pendu("diff", "changes-of-h", other).out.splitlines()[2:]  # below the names of the files
    assert max(map(len, lines)) <= 80
    assert any(line.startswith("velocity_verlet") for line in lines)


def test_many_changes_are_cut_short_and_json_has_all(tmp_path):
    acts = [act for n in range(15) for act in (0.2, lambda live, n=n: live.set_stepping(Stepping(0.01 + n / 100)))]
    path = recorded(tmp_path / "many.mcap", *acts, 0.2)
    outcome = pendu("diff", path, recorded(tmp_path / "none.mcap", 3.2))
    assert "... and 5 more; --json lists all." in outcome.out
    assert len(pendu("diff", path, tmp_path / "none.mcap", "--json").json["event_differences"]) == 15


def test_a_damaged_recording_is_compared_as_far_as_it_is_intact(tmp_path):
    whole = record(tmp_path / "whole.mcap", two_runs())
    (tmp_path / "cut.mcap").write_bytes(whole.read_bytes()[: whole.stat().st_size * 3 // 5])
    outcome = pendu("diff", whole, tmp_path / "cut.mcap")
    assert outcome.code == 1
    assert outcome.err.count("\n") == 1
    assert "the rest is compared" in outcome.err
    answer = pendu("diff", whole, tmp_path / "cut.mcap", "--json").json
    assert (answer["a"]["complete"], answer["b"]["complete"], answer["first_difference"]) == (True, False, None)
    assert answer["samples"]["only_in_a"] > 0


def test_what_cannot_be_read_is_one_sentence(tmp_path):
    (tmp_path / "text.mcap").write_text("not a recording")
    assert pendu("diff", "drift", tmp_path / "text.mcap").refused(3, "not an MCAP file")
    assert pendu("diff", tmp_path / "text.mcap", "drift", "--json").refused(3, "not an MCAP file")
    assert pendu("diff", "drift").refused(2, "diff --help")


def test_text_from_a_file_cannot_steer_the_terminal(tmp_path):
    path = recorded(tmp_path / "evil.mcap", 1.0, lambda live: live.mark("\x1b[2J"), 1.0)
    outcome = pendu("diff", path, recorded(tmp_path / "plain.mcap", 2.0))
    assert "\x1b" not in outcome.out
