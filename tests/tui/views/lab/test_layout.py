"""Where the lab's panes go: any size, one to six methods."""

from itertools import combinations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from textual.geometry import Region

from tui.views.lab.layout import CHART, PANE, Places, places

BODIES = {  # of the terminal: the cells above the table of four methods
    "80x24": (80, 15),
    "81x50": (81, 41),
    "100x50": (100, 41),
    "120x30": (120, 22),
    "120x40": (120, 32),
    "200x60": (200, 52),
}


def regions(found: Places) -> list[Region]:
    others = (found.overlay, found.events, found.chart, found.second_chart, found.phase)
    return [*found.pendulums, *(region for region in others if region is not None)]


@given(st.integers(1, 400), st.integers(1, 150), st.integers(0, 6))
@example(columns=78, rows=9, methods=1)
def test_panes_cover_the_stage_and_never_each_other(columns, rows, methods):
    found = regions(places(columns, rows, methods))
    assert sum(region.area for region in found) == columns * rows
    assert not any(one.intersection(other) for one, other in combinations(found, 2))
    assert all(Region(0, 0, columns, rows).contains_region(region) for region in found)


@pytest.mark.parametrize("name", [name for name in BODIES if name != "80x24"])
def test_from_81x50_or_120x30_on_there_are_phase_space_and_events(name):
    found = places(*BODIES[name], methods=4)
    assert found.phase.height >= 10
    assert found.events.height >= 5
    assert found.chart.width >= CHART


def test_at_80x24_there_are_one_overlay_and_one_chart():
    assert places(*BODIES["80x24"], methods=4) == Places(
        overlay=Region(0, 0, 28, 15), chart=Region(28, 0, CHART, 15)
    )


@pytest.mark.parametrize(
    ("name", "methods", "panes"),
    [
        *(("120x40", methods, methods) for methods in (1, 2, 3, 4)),
        *(("200x60", methods, methods) for methods in (5, 6)),
        *((name, 4, 0) for name in ("100x50", "120x30")),
        ("120x40", 6, 0),
    ],
)
def test_each_method_has_a_pane_where_there_is_room_else_they_share_one(name, methods, panes):
    found = places(*BODIES[name], methods)
    assert len(found.pendulums) == panes
    assert (found.overlay is None) == bool(panes)
    for region in found.pendulums:
        assert region.width >= PANE.width
        assert region.height >= PANE.height


def test_where_there_is_much_room_there_is_a_second_chart():
    found = places(*BODIES["200x60"], methods=4)
    assert [found.chart.height, found.second_chart.height, found.phase.height] == [17, 17, 18]
