"""What each scene promises is visible in its shot within 20 s, in small terminals, too."""

import math
from itertools import pairwise

import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.picture import FAINT, inks
from pendu_tui.tui.drawing.time_chart import LARGEST, time_chart
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.portrait import Portrait, method_points, phase_picture
from pendu_tui.tui.views.viewport import Viewport
from tests.tui.drawn import cells

CHARTS = ((36, 6), (48, 12), (73, 13), (123, 14))  # columns and rows, from 60×16 to 200×60
CHART = CHARTS[1]
PORTRAIT = (78, 15)


class Seen:
    """The pictures of a scene so many seconds of the clock after its start."""

    def __init__(self, name, seconds):
        self.scene = scene = SCENES[name]
        self.live = Live(scene, scene.speed, clock=lambda: 0.0)
        for third in range(round(3 * seconds) + 1):
            self.live.tick(third / 3)
        self.shown = Shown().through(scene)
        self.draw(CHART)

    def draw(self, size):
        window = self.live.history.window(self.shown.seconds)
        self.plot = time_chart(window, self.scene.cast, self.shown, *size)
        self.chart = self.plot.picture
        self.bottom = size[1] - 3

    def heights(self, letter):
        """The rows from the lower edge of the chart that a curve is in, column by column."""
        place = [method.letter for method in self.scene.cast].index(letter)
        columns = {}
        for (row, column), (character, ink) in cells(self.chart).items():
            if ink == inks(self.scene.cast)[place] and "⠀" < character <= "⣿":
                columns.setdefault(column, []).append(self.bottom - row)
        return [columns[column] for column in sorted(columns)]

    def spread(self, letter):
        rows = [row for column in self.heights(letter) for row in column]
        return max(rows) - min(rows)

    def dips(self, letter):
        """How often a curve goes through the middle of the chart, downwards."""
        above = [max(column) > self.bottom / 2 for column in self.heights(letter)]
        return sum(before and not after for before, after in pairwise(above))

    def apart(self, upper, lower):
        return min(self.heights(upper)[-1]) - max(self.heights(lower)[-1])

    @property
    def line(self):
        """The row of the reference line, from the lower edge of the chart."""
        level = self.shown.line.value
        return self.bottom - self.plot.row(math.log10(level) if self.shown.log else level)

    def near_line(self, letter):
        """Rows from the end of a curve to the reference line, less than 0 beyond one."""
        return 1 - abs(max(self.heights(letter)[-1]) - self.line)

    def reaches_line(self, letter):
        """Rows from the highest point of a curve up to the reference line, less than 0 below."""
        return 1 + max(map(max, self.heights(letter))) - self.line

    def crosses_line(self, letter):
        """How many rows a curve ends beyond the reference line, after it began before it."""
        heights = self.heights(letter)
        return min(min(heights[0]) - self.line, self.line - max(heights[-1]))

    def least_share(self, size):
        """The least share of its columns that a method is in, in a chart of this size."""
        self.draw(size)
        known = (abs(self.plot.values) <= LARGEST).sum(axis=0)
        pairs = zip(self.plot.letters, known, strict=True)
        return min(len(self.heights(each)) / of for each, of in pairs)

    def count(self, *sign):
        return self.chart.text.count("".join(sign))


PROMISES = {
    # name: (seconds of the clock, what is to be seen of which methods, at least so many rows)
    "drift": (12, "apart", "es", 2),
    "gentle": (12, "apart", "ev", 4),
    "linear": (12, "spread", "e", 5),
    "large-swing": (12, "apart", "er", 5),
    "crossover": (12, "apart", "vr", 1),
    "near-separatrix": (8, "apart", "rv", 2),
    "spin": (12, "apart", "sv", 2),
    "euler-caught": (20, "near_line", "e", 0),
    "verlet-limit": (6, "dips", "v", 2),
    "verlet-limit-above": (10, "reaches_line", "v", 0),
    "rk4-limit": (6, "crosses_line", "r", 1),
    "rk4-limit-above": (15, "spread", "r", 6),
    "resonance": (10, "spread", "v", 7),
    "damped": (15, "apart", "ec", 2),
    "halving": (15, "apart", "hv", 2),
    "stiff-slow": (10, "spread", "r", 4),
    "stiff-limit": (10, "count", "↑v", 1),
    "stiff-resonance": (10, "count", "↑", 1),
    "learned": (15, "apart", "zt", 3),
    "precision": (10, "apart", "nk", 3),
    "precision-deep": (10, "apart", "vk", 3),
    "mean-field": (15, "spread", "r", 3),
}


def test_every_scene_has_a_promise_that_is_seen():
    assert {*PROMISES, "chaos-fenced", "chaos-loose"} == set(SCENES)  # those two below
    assert max(seconds for seconds, *_ in PROMISES.values()) <= 20


@pytest.mark.parametrize("name", PROMISES)
def test_the_promise_of_a_scene_is_visible_in_its_shot(name):
    seconds, what, letters, least = PROMISES[name]
    seen = Seen(name, seconds)
    assert getattr(seen, what)(*letters) >= least
    if what != "count":  # a method that leaves the chart at once has a label there
        assert min(map(seen.least_share, CHARTS)) >= 0.5


@pytest.mark.parametrize(
    "name", ["chaos-fenced", pytest.param("chaos-loose", marks=pytest.mark.slow)]
)
def test_chaos_stays_below_its_fence_and_without_one_passes_its_line(name):
    seen = Seen(name, 20)
    scene = seen.scene
    shown = seen.shown
    assert scene.shot.view == "phase"
    viewport = Viewport.portrait(*PORTRAIT, scene, math.pi, shown.line.value)
    points = method_points(seen.live, seen.live.sample, shown, None)
    assert [point.letter for point in points] == ["s", "v"]
    portrait = Portrait(viewport, scene.equations)
    picture = phase_picture(portrait, points, line=shown.line)
    top, bottom = (at for at, text in enumerate(picture.text.splitlines()) if "pi/h" in text)
    own = {inks(scene.cast)[place] for place in shown.places(scene.cast)}
    rows = [row for (row, _), (_, ink) in cells(picture).items() if ink >= 0 and ink % FAINT in own]
    beyond = [row for row in rows if not top - 1 <= row <= bottom + 1]
    fastest = abs(seen.live.history.rows["states"][:, 1:3, 1]).max(axis=0) / shown.line.value
    if name == "chaos-fenced":
        assert all(0.5 < each < 1 for each in fastest)
        assert not beyond
    else:
        assert fastest.max() > 1
        assert beyond
