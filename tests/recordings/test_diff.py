import pytest

from engine.run.lockstep import Sample
from engine.run.stepping import Stepping
from engine.scenes import DEFAULT_SCENE
from recordings.diff import Comparison, compare
from recordings.events import Entry, Event
from recordings.headless import simulate
from recordings.recorder import Recorder
from recordings.recording import Recording
from tests.recordings.examples import record, start, tiny, two_runs
from tests.tui.harness import recorded

EULER, VERLET = 0, 2


def compared(a, b) -> Comparison:
    with Recording.open(a) as one, Recording.open(b) as other:
        return compare(one, other)


def changed(entries: list[Entry], step: int, **values: float) -> list[Entry]:
    """The entries with other numbers of Verlet at the first sample of a step."""
    place = next(at for at, (_, value) in enumerate(entries) if isinstance(value, Sample) and value.step == step)
    clock, sample = entries[place]
    readings = list(sample.readings)
    readings[VERLET] = readings[VERLET]._replace(**values)
    return [*entries[:place], Entry(clock, sample._replace(readings=tuple(readings))), *entries[place + 1 :]]


@pytest.fixture
def whole(tmp_path):
    return record(tmp_path / "whole.mcap", two_runs())


def swing(path, scene, seconds, every=None):
    with Recorder(path) as recorder:
        list(simulate(scene, seconds, recorder, every))
    return path


def test_a_recording_is_identical_to_itself_and_to_one_made_the_same_way(whole, tmp_path):
    again = compared(whole, record(tmp_path / "again.mcap", two_runs()))
    assert again.identical
    assert (again.paired, again.differing, again.unpaired, again.first) == (10, 0, [0, 0], None)


def test_the_first_number_that_differs_is_found_to_the_last_bit(whole, tmp_path):
    omega = two_runs()[3].value.readings[VERLET].omega
    other = changed(changed(two_runs(), 9, theta=2.5), 6, omega=omega * (1 + 2**-52))
    result = compared(whole, record(tmp_path / "other.mcap", other))
    assert not result.identical
    first = result.first
    assert (first.run, first.step, first.step_b, first.method, first.field) == (1, 6, 6, "velocity_verlet", "omega")
    assert (first.a, first.b, first.ulps) == (omega, omega * (1 + 2**-52), 1)
    assert result.differing == 2
    apart = result.errors["velocity_verlet"]
    assert (apart.theta_difference, apart.run, apart.t) == (abs(2.5 - two_runs()[4].value.readings[2].theta), 1, 0.9)
    assert result.errors["rk4"].run is None


def test_zero_and_minus_zero_are_not_the_same_bits(tmp_path):
    a, b = (record(tmp_path / f"{zero}.mcap", changed(two_runs(), 3, omega=zero)) for zero in (0.0, -0.0))
    result = compared(a, b)
    assert (result.first.a, result.first.b, result.first.ulps) == (0.0, -0.0, 1)
    assert str(result.first.b) == "-0.0"


def test_other_starts_are_listed_number_by_number(tmp_path):
    a = swing(tmp_path / "a.mcap", DEFAULT_SCENE, 1)
    b = swing(tmp_path / "b.mcap", DEFAULT_SCENE.altered(theta=1.1, length=2.0), 1)
    result = compared(a, b)
    found = {(each.field, each.a, each.b) for each in result.scenes if each.field != "watch"}
    assert found == {("name", "drift", "custom"), ("theta", 1.0, 1.1), ("length", 1.0, 2.0)}
    assert (result.first.step, result.first.field) == (0, "theta")


def test_events_of_one_recording_only_are_listed_and_make_them_differ(tmp_path):
    a = recorded(tmp_path / "a.mcap", 1.0, lambda live: live.mark("here"), 1.0)
    b = recorded(tmp_path / "b.mcap", 1.0, lambda live: live.mark("there"), 1.0)
    result = compared(a, b)
    assert [(each.only_in, each.event.text) for each in result.events] == [("a", "here"), ("b", "there")]
    assert result.first is None
    assert not result.identical


def test_a_run_and_a_method_that_only_one_has_are_named(whole, tmp_path):
    one_run = two_runs()
    del one_run[next(at for at, (_, value) in enumerate(one_run) if value.run == 2) :]
    result = compared(record(tmp_path / "one.mcap", one_run), whole)
    assert result.runs_only == ([], [2])
    assert result.unpaired == [0, 3]
    result = compared(whole, tiny(tmp_path / "tiny.mcap"))
    assert result.methods_only == (["explicit_euler", "symplectic_euler", "rk4"], [])
    assert result.errors["rk4"].max_energy_error[1] is None
    assert result.first is None
    assert not result.identical


def test_samples_taken_less_often_are_the_same_where_both_have_one(tmp_path):
    often = swing(tmp_path / "often.mcap", DEFAULT_SCENE, 10, every=1)
    seldom = swing(tmp_path / "seldom.mcap", DEFAULT_SCENE, 10, every=5)
    result = compared(often, seldom)
    assert (result.paired, result.differing, result.unpaired) == (41, 0, [160, 0])
    assert result.first is None


@pytest.mark.parametrize("factor", [2, 3, 10])
def test_runs_of_different_step_sizes_are_held_together_by_time(tmp_path, factor):
    fine = swing(tmp_path / "fine.mcap", DEFAULT_SCENE.altered(h=0.1 / factor), 20, every=1)
    coarse = swing(tmp_path / "coarse.mcap", DEFAULT_SCENE.altered(h=0.1), 20, every=1)
    result = compared(fine, coarse)
    assert (result.paired, result.unpaired) == (201, [200 * (factor - 1), 0])
    assert (result.first.step, result.first.step_b) == (factor, 1)
    first, second = result.errors["velocity_verlet"].max_energy_error
    assert second / first == pytest.approx(factor**2, rel=0.1)  # a method of second order


def test_time_that_runs_backwards_is_still_compared_in_order(tmp_path):
    def there_and_back(path, h):
        return recorded(path, 1.0, lambda live: live.set_stepping(Stepping(-h)), 1.0)

    same = compared(there_and_back(tmp_path / "a.mcap", 0.05), there_and_back(tmp_path / "b.mcap", 0.05))
    assert same.identical
    other = compared(tmp_path / "a.mcap", there_and_back(tmp_path / "c.mcap", 0.025))
    assert other.first.t < 1.0
    assert other.first.step > 20  # on the way back


def test_the_intact_part_of_a_damaged_recording_is_compared(whole, tmp_path):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size * 3 // 5])
    result = compared(whole, cut)
    assert result.first is None
    assert result.paired > 0
    assert result.unpaired[0] > 0
    assert not result.identical


def test_progress_counts_the_samples_of_both(tmp_path):
    path = swing(tmp_path / "long.mcap", DEFAULT_SCENE, 120, every=1)
    seen = []
    with Recording.open(path) as one, Recording.open(path) as other:
        compare(one, other, lambda done, total: seen.append((done, total)))
    assert seen == [(2000, 4802), (4000, 4802)]


def test_an_event_repeated_is_counted(tmp_path):
    mark = Event("mark", 1, 0, 0.0, text="x")
    sample = two_runs()[1]
    a = record(tmp_path / "a.mcap", [Entry(0.0, start()), sample, Entry(0.0, mark), Entry(0.0, mark)])
    b = record(tmp_path / "b.mcap", [Entry(0.0, start()), sample, Entry(0.0, mark)])
    assert [each.only_in for each in compared(a, b).events] == ["a"]
