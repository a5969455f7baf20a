import pytest

from tui.playback.frame_rate import FrameRate


class Machine:
    """Paints a frame in `cost` s of its one core, evenly or not at all, as Textual's timer does."""

    def __init__(self, cost: float, wanted: int = 30) -> None:
        self.now = self.processor = 0.0
        self.cost, self.rate = cost, FrameRate(wanted)
        self.changes: list[tuple[float, int]] = []

    def run(self, seconds: float) -> "Machine":
        end = self.now + seconds
        while self.now < end:
            if self.rate.frame(self.now, self.processor):
                self.changes.append((self.now, self.rate.rate))
            due = 1 / self.rate.rate
            self.now += due * max(1, -(-self.cost // due))  # a tick that is missed is skipped
            self.processor += self.cost
        return self


def test_a_fast_machine_paints_all_frames():
    machine = Machine(0.010).run(60.0)
    assert machine.rate.rate == 30
    assert not machine.rate.is_slow


@pytest.mark.parametrize(("cost", "rate"), [(0.040, 20), (0.055, 15), (0.070, 10), (0.5, 10)])
def test_a_slow_machine_paints_as_many_as_it_can(cost, rate):
    machine = Machine(cost).run(60.0)
    assert machine.rate.rate == rate
    assert machine.rate.is_slow
    assert len(machine.changes) <= 3


def test_a_machine_that_had_company_paints_all_frames_again():
    machine = Machine(0.040).run(20.0)
    machine.cost = 0.005
    assert machine.run(15.0).rate.rate == 30


def test_a_machine_at_the_edge_is_not_tried_again_and_again():
    """Every frame takes little of the core, and yet a higher rate is late: somebody else is busy."""

    class Edge(Machine):
        def run(self, seconds: float) -> "Machine":
            end = self.now + seconds
            while self.now < end:
                if self.rate.frame(self.now, self.processor):
                    self.changes.append((self.now, self.rate.rate))
                self.now += (1 if self.rate.rate < 30 else 2) / self.rate.rate
                self.processor += 0.001
            return self

    machine = Edge(0.0).run(300.0)
    assert len(machine.changes) <= 16
    assert len([now for now, _ in machine.changes if now > 150.0]) <= 6


def test_a_stop_is_not_a_late_frame():
    machine = Machine(0.005).run(0.5)
    for _ in range(20):
        machine.now += 5.0
        machine.run(0.5)
    assert machine.rate.rate == 30


def test_a_low_frame_rate_is_not_lowered_further():
    assert Machine(0.5, wanted=10).run(30.0).rate.rate == 10
    assert Machine(0.2, wanted=12).run(30.0).rate.rate == 10


def test_a_clock_that_stands_changes_nothing():
    rate = FrameRate(30)
    assert not any(rate.frame(1.0, 0.0) for _ in range(1000))
