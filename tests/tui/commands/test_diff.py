from dataclasses import replace

import pytest

from tests.recordings.examples import record, two_runs
from tests.recordings.test_verify import altered
from tests.tui.command_line import pendu


@pytest.fixture
def whole(tmp_path):
    return record(tmp_path / "a.mcap", two_runs())


def test_the_first_difference_has_its_time_step_method_and_field(whole, tmp_path):
    assert pendu("diff", whole, whole).out.startswith("identical")
    other = record(tmp_path / "b.mcap", altered(two_runs(), 3, 2, omega=-5.0))
    answer = pendu("diff", whole, other, "--json").json
    place = {"run": 1, "step_a": 6, "step_b": 6, "t": pytest.approx(0.6)}
    place |= {"method": "velocity_verlet", "field": "omega", "b": -5.0}
    assert answer["first"] == answer["first"] | place
    assert answer["samples"] == 10


def test_what_was_done_differently_is_listed(whole, tmp_path):
    entries = two_runs()
    scene = replace(entries[0].value.scene, theta=2.5)
    entries[0] = entries[0]._replace(value=entries[0].value._replace(scene=scene))
    other = [entry for entry in entries if getattr(entry.value, "kind", "") != "mark"]
    done = pendu("diff", whole, record(tmp_path / "b.mcap", other), "--json").json["done"]
    assert ["run 1, theta", "2.0", "2.5"] in done
    assert ["run 1, mark at step 15, t = 1.2 s", "what is this?", "-"] in done


def test_recordings_with_other_steps_or_models_are_compared_at_equal_times():
    assert pendu("diff", "drift", "changes-of-h", "--json").json["samples"] > 10
    assert pendu("diff", "swapped-cast", "stiff-slow").code == 1


def test_a_damaged_recording_is_compared_as_far_as_it_is_intact(whole, tmp_path):
    (tmp_path / "cut.mcap").write_bytes(whole.read_bytes()[:-900])
    assert "the rest is compared" in pendu("diff", whole, tmp_path / "cut.mcap").err
