"""Whatever numbers within the limits a model is given: no crash, and no number that is none, on screen and in JSON."""

import math
import re
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pendu_tui.engine.models import MODELS, NUMBERS
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.drawing.time_chart import time_chart
from pendu_tui.tui.playback.shown import Shown, quantities
from pendu_tui.tui.screens.lines import status_row
from pendu_tui.tui.views.error_table import table
from pendu_tui.tui.words.insight import insight, lasting
from pendu_tui.tui.words.plain_text import description
from tests.truths import LIMITS
from tests.tui.harness import Lab


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of every size within limits; the limits themselves are likely."""
    if low <= 0:
        return st.floats(low, high)
    return st.floats(math.log(low), math.log(high)).map(
        lambda log: min(max(math.exp(log), low), high)
    )


def scenes(model: str) -> st.SearchStrategy[Scene]:
    base = next(scene for scene in SCENES.values() if scene.model == model)
    limits = LIMITS | {name: NUMBERS[name][3:5] for name in base.parameters}
    values = st.fixed_dictionaries(
        {name: numbers(*each) for name, each in limits.items()} | {"z": numbers(1e-8, 2.5)}
    )

    def scene(given: dict[str, float]) -> Scene:
        w0 = math.sqrt(given["gravity"] / given["length"])
        for name in base.parameters:
            given[name] = min(given[name], NUMBERS[name].max_over_w0 * w0)
        z = given.pop("z")
        return base.altered(h=z / w0, **given)

    return values.map(scene)


def on_screen(live) -> str:
    """The text of the lab's lines, tables and charts, and its sentences."""
    pictures = [Picture([status_row(live, Shown(), 120), *table(live, live.sample, Shown(), 120)])]
    for quantity, log in product(quantities(live.scene), (True, False)):
        shown = Shown(quantity=quantity, log=log)
        chart = time_chart(live.history.window(), live.scene.cast, shown, 60, 14)
        pictures.append(chart.picture)
    sentences = [*description(live), insight(live).text, *(each.text for each in lasting(live))]
    return "\n".join([*(picture.text for picture in pictures), *sentences])


@pytest.mark.parametrize("model", MODELS)
@settings(max_examples=6)
@given(data=st.data())
def test_any_numbers_of_any_model_can_be_shown(model, data):
    scene = data.draw(scenes(model))
    lab = Lab(scene, speed=scene.h / 0.05)
    lab.run(0.25)
    assert not re.search(r"\b(nan|inf)\b", on_screen(lab.live))
