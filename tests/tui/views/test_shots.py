"""What each scene promises is visible in its shot within 20 s, in small terminals, too."""

import math
from itertools import pairwise

import pytest

from engine.scenes import SCENES
from tests.tui.drawn import cells
from tui.drawing.palette import FAINT, inks
from tui.drawing.time_chart import CROSSING, Marks, time_chart
from tui.playback.live import Live
from tui.playback.shown import Shown
from tui.views.phase.picture import method_points, phase_picture
from tui.views.phase.portrait import Portrait
from tui.views.phase.viewport import Viewport

CHARTS = {"120x40": (68, 16), "80x24": (50, 14)}
PORTRAITS = {"120x40": (118, 28), "80x24": (78, 15)}


class Seen:
    """The pictures of a scene so many seconds of the clock after its start."""

    def __init__(self, name, seconds, size):
        self.scene = scene = SCENES[name]
        self.live = Live(scene, scene.speed, clock=lambda: 0.0)
        for third in range(round(3 * seconds) + 1):
            self.live.tick(third / 3)
        shown = self.shown = Shown().through(scene)
        line = shown.line if shown.line and shown.line.quantity == shown.quantity else None
        marks = Marks(line=line and (line.value, line.name))
        window = self.live.history.window(shown.seconds)
        self.chart = time_chart(window, scene.cast, shown, *CHARTS[size], marks)
        self.size = size

    def heights(self, letter):
        """The rows from the lower edge of the chart that a curve is in, column by column."""
        place = [method.letter for method in self.scene.cast].index(letter)
        ink = inks(self.scene.cast)[place]
        found = {}
        bottom = CHARTS[self.size][1] - 3
        for (row, column), (character, own) in cells(self.chart.picture).items():
            if own == ink and "⠀" < character <= "⣿":
                found.setdefault(column, []).append(bottom - row)
        return [found[column] for column in sorted(found)]

    def spread(self, letter):
        rows = [row for column in self.heights(letter) for row in column]
        return max(rows) - min(rows)

    def dips(self, letter, share):
        """How often a curve goes through this share of the chart's height, downwards."""
        level = share * (CHARTS[self.size][1] - 3)
        above = [max(column) > level for column in self.heights(letter)]
        return sum(before and not after for before, after in pairwise(above))

    def apart(self, upper, lower):
        return min(self.heights(upper)[-1]) - max(self.heights(lower)[-1])

    def above_line(self, letter):
        """Rows from the reference line to the end of a curve."""
        text = self.chart.picture.text.splitlines()
        row = next(at for at, line in enumerate(text) if self.shown.line.name in line) + 1
        return max(self.heights(letter)[-1]) - (CHARTS[self.size][1] - 3 - row)


PROMISES = {
    # name: (seconds of the clock, what is to be seen, at least so many rows)
    "drift": (12, lambda seen: seen.apart("e", "s"), 2),
    "gentle": (12, lambda seen: seen.apart("e", "v"), 4),
    "linear": (12, lambda seen: seen.spread("e"), 5),
    "large-swing": (12, lambda seen: seen.apart("e", "r"), 5),
    "crossover": (12, lambda seen: seen.chart.picture.text.count(CROSSING), 1),
    "near-separatrix": (8, lambda seen: seen.apart("r", "v"), 2),
    "spin": (12, lambda seen: seen.apart("s", "v"), 2),
    "euler-caught": (20, lambda seen: 1 - abs(seen.above_line("e")), 0),
    "verlet-limit": (6, lambda seen: seen.dips("v", 0.5), 2),
    "verlet-limit-above": (10, lambda seen: seen.spread("v"), 6),
    "rk4-limit": (6, lambda seen: seen.spread("r"), 6),
    "rk4-limit-above": (15, lambda seen: seen.spread("r"), 6),
    "resonance": (10, lambda seen: seen.spread("v"), 7),
    "damped": (15, lambda seen: seen.apart("e", "c"), 2),
    "halving": (15, lambda seen: seen.apart("h", "v"), 2),
    "stiff-slow": (10, lambda seen: seen.spread("r"), 4),
    "stiff-limit": (10, lambda seen: seen.chart.picture.text.count("↑v"), 1),
    "stiff-resonance": (10, lambda seen: seen.chart.picture.text.count("↑"), 1),
    "learned": (15, lambda seen: seen.apart("z", "t"), 3),
    "precision": (10, lambda seen: seen.apart("n", "k"), 3),
    "precision-deep": (10, lambda seen: seen.apart("v", "k"), 3),
    "mean-field": (15, lambda seen: seen.spread("r"), 3),
}


def test_every_scene_has_a_promise_that_is_seen():
    assert {*PROMISES, "chaos-fenced", "chaos-loose"} == set(SCENES)  # those two below


@pytest.mark.parametrize("size", CHARTS)
@pytest.mark.parametrize("name", PROMISES)
def test_the_promise_of_a_scene_is_visible_in_its_shot(name, size):
    seconds, seen, least = PROMISES[name]
    assert seconds <= 20
    assert seen(Seen(name, seconds, size)) >= least


def in_phase_space(name, size):
    """The largest |omega| of the methods over the line's, and the rows of dots beyond the lines."""
    seen = Seen(name, 20, size)
    scene = seen.scene
    shown = seen.shown
    assert scene.shot.view == "phase"
    viewport = Viewport.portrait(*PORTRAITS[size], scene, math.pi, shown.line.value)
    points = method_points(seen.live, seen.live.sample, shown, None)
    assert [point.letter for point in points] == ["s", "v"]
    picture = phase_picture(Portrait.of(viewport, scene.equations), points, line=shown.line)
    lines = [at for at, text in enumerate(picture.text.splitlines()) if "pi/h" in text]
    assert len(lines) == 2
    own = {inks(scene.cast)[place] % FAINT for place in shown.places(scene.cast)}
    dots = [row for (row, _), (_, ink) in cells(picture).items() if ink >= 0 and ink % FAINT in own]
    beyond = [row for row in dots if not lines[0] - 1 <= row <= lines[1] + 1]
    fastest = abs(seen.live.history.trails(4000)[:, :, 1]).max(axis=0) / shown.line.value
    return fastest[1:3], beyond


@pytest.mark.parametrize("size", PORTRAITS)
def test_chaos_stays_below_its_fence(size):
    fastest, beyond = in_phase_space("chaos-fenced", size)
    assert all(0.5 < each < 1 for each in fastest)
    assert not beyond


@pytest.mark.slow
@pytest.mark.parametrize("size", PORTRAITS)
def test_chaos_without_a_fence_passes_its_line(size):
    fastest, beyond = in_phase_space("chaos-loose", size)
    assert fastest.max() > 1
    assert beyond


def test_an_altered_scene_has_the_shot_of_all_and_a_recorded_one_that_of_its_name():
    resonance = SCENES["resonance"]
    shown = Shown().through(resonance)
    assert shown.hidden == {"symplectic_euler"}
    assert Shown().through(resonance.altered(h=1.0)) == Shown()
