"""Where the lab's panes go: any size, one to six methods."""

from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.geometry import Region

from pendu_tui.tui.views.lab.view import CHART, PANE, places


@given(st.integers(1, 400), st.integers(1, 150), st.integers(0, 6))
def test_panes_cover_the_stage_and_never_each_other(columns, rows, methods):
    tiles, others = places(columns, rows, methods)
    regions = [*tiles, *others.values()]
    assert sum(region.area for region in regions) == columns * rows
    assert not any(one.intersection(other) for one, other in combinations(regions, 2))
    assert all(Region(0, 0, columns, rows).contains_region(region) for region in regions)


@pytest.mark.parametrize(
    ("body", "methods", "panes", "names"),  # cells above the table of four methods
    [
        ((80, 15), 4, 0, {"overlay", "chart"}),
        ((81, 41), 4, 0, {"overlay", "events", "chart", "phase"}),
        ((100, 41), 4, 0, {"overlay", "events", "chart", "phase"}),
        ((120, 22), 4, 0, {"overlay", "events", "chart", "phase"}),
        ((120, 32), 1, 1, {"events", "chart", "phase"}),
        ((120, 32), 4, 4, {"events", "chart", "phase"}),
        ((120, 32), 6, 0, {"overlay", "events", "chart", "phase"}),
        ((200, 52), 6, 6, {"events", "chart", "second_chart", "phase"}),
    ],
)
def test_each_method_has_a_pane_and_there_are_more_panes_where_there_is_room(
    body, methods, panes, names
):
    tiles, others = places(*body, methods)
    assert len(tiles) == panes
    assert set(others) == names
    assert all(tile.width >= PANE.width and tile.height >= PANE.height for tile in tiles)
    assert others["chart"].width >= CHART
    assert all(others[name].height >= 5 for name in names)
