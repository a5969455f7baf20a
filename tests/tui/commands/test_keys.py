"""`pendu-tui keys` lists the keys that the screens and panes really have."""

import pytest

from recordings.library import GOLDEN
from tests.tui.command_line import pendu
from tests.tui.harness import key_of, lab, player, uncomputed
from tui.views import VIEWS

NAMES = {  # of keys that Textual calls something else
    "arrows": {"left", "right", "up", "down"},
    "shift+arrows": {"shift+left", "shift+right", "shift+up", "shift+down"},
    **{f"F{number}": {f"f{number}"} for number in range(2, 6)},
    "pgup": {"pageup"},
    "pgdn": {"pagedown"},
    "esc": {"escape"},
    "enter, space": {"enter"},  # space is the lab's own
    "+": {"plus", "equals_sign"},
    "-": {"minus"},
    "<": {"less_than_sign"},
    ">": {"greater_than_sign"},
    "?": {"question_mark"},
    "*": {"asterisk"},
    "%": {"percent_sign"},
    ".": {"full_stop"},
    ",": {"comma"},
    "[": {"left_square_bracket"},
    "]": {"right_square_bracket"},
    "(": {"left_parenthesis"},
    ")": {"right_parenthesis"},
}
PANES = {
    "PhasePane": "phase space",
    "ErrorTable": "table",
    "SectionPane": "phase space",
    "AccuracyPane": "accuracy",
    "StabilityPane": "stability",
}
MOUSE = {"click", "click, drag", "wheel", "shift+drag"}


def listed() -> dict[str, set[str]]:
    """The keys of each place as Textual calls them, by `pendu-tui keys --json`."""
    places: dict[str, set[str]] = {}
    for row in pendu("keys", "--json").json["keys"]:
        capital = {f"shift+{row['key'].lower()}"} if len(row["key"]) == 1 and row["key"].isupper() else set()
        names = NAMES.get(row["key"], {row["key"], *capital}) if row["key"] not in MOUSE else set()
        places.setdefault(row["where"], set()).update(names)
    return places


def bound(node: object) -> set[str]:
    """The keys that our classes bind; Textual's own are not counted."""
    ours = [kind for kind in type(node).__mro__ if kind.__module__.startswith("tui.")]
    return {name for kind in ours for each in vars(kind).get("BINDINGS", ()) for name in each.key.split(",")}


@pytest.mark.parametrize("place", ["lab", "replay"])
async def test_the_keys_of_the_screens_and_panes_are_listed_and_no_others(place, monkeypatch):
    for view in ("accuracy", "stability"):
        monkeypatch.setattr(f"tui.views.{view}.view.computed", uncomputed)
    keys = listed()
    async with lab() if place == "lab" else player(GOLDEN / "drift.mcap") as theatre:
        tour = keys["tour"] if place == "lab" else set()
        assert bound(theatre.app) | bound(theatre.stage) == keys["lab and replay"] | keys[place] | tour
        for name in VIEWS:
            await theatre.press(key_of(name))
            await theatre.pilot.pause()
        panes = {type(pane).__name__: pane for pane in theatre.stage.query("*") if pane.can_focus}
        assert set(panes) == set(PANES)
        for name, pane in panes.items():
            elsewhere = {"PhasePane": {"tab", "x"}}.get(name, set())
            assert bound(pane) == keys[PANES[name]] - elsewhere  # there, tab is Textual's


def test_the_page_groups_the_keys_as_the_help_does():
    page = pendu("keys").out
    assert "\nPhase space\n  tab " in page
    assert "  space         pause" in page
