import json
from collections.abc import Sequence

import pyte
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.segment import Segment
from rich.style import Style

from tui.terminal.asciicast import BEGIN, cells, changed, event, header

RED, BLUE = Style(color="#ff0000"), Style(color="#0000ff", bold=True)
WIDTH = 12


def screen(*rows: Sequence[tuple[str, Style | None]]):
    return cells([[Segment(text, style) for text, style in row] for row in rows])


def shown(*screens) -> pyte.Screen:
    """A terminal that was sent one screen after the other."""
    terminal = pyte.Screen(WIDTH, 3)
    stream = pyte.Stream(terminal)
    stream.feed(BEGIN)
    for before, after in zip([[], *screens], screens, strict=False):
        stream.feed(changed(before, after))
    return terminal


def test_the_header_and_an_event_are_those_of_asciicast_2():
    assert json.loads(header((80, 24), "θ")) == {"version": 2, "width": 80, "height": 24, "title": "θ"}
    assert json.loads(event(1 / 3, "⠿\x1b[m")) == [0.333333, "o", "⠿\x1b[m"]
    assert "⠿" in event(0, "⠿")  # a third of the bytes of its escape


def test_only_what_changed_is_sent():
    before, after = (screen([("abc", RED), (f"de{letter}ghijk", RED)]) for letter in "fF")
    assert changed(before, before) == ""
    assert changed(before, after) == "\x1b[1;6H\x1b[38;2;255;0;0mF\x1b[0m"


def test_changes_with_little_between_them_are_sent_as_one():
    before, near, far = (screen([(text, None)]) for text in ("abcdefghijkl", "ABcDefghijkl", "AbcdefghijkL"))
    assert changed(before, near) == "\x1b[1;1HABcD"
    assert changed(before, far) == "\x1b[1;1HA\x1b[1;12HL"


def test_a_colour_alone_is_a_change():
    assert "x" in changed(screen([("x", RED)]), screen([("x", BLUE)]))


def test_a_wide_character_is_sent_whole():
    terminal = shown(screen([("ab子c", RED)]), screen([("ab丑c", RED)]), screen([("ab丑d", BLUE)]))
    assert terminal.display[0].startswith("ab丑d")
    assert changed(screen([("a子b", RED)]), screen([("axyb", RED)])).count("xy") == 1


@given(st.lists(st.lists(st.text("ab 子", max_size=6), min_size=3, max_size=3), min_size=1, max_size=4))
def test_the_terminal_shows_the_last_screen_whatever_came_before(texts):
    def row(text: str) -> list[tuple[str, Style]]:
        filled = text + " " * (WIDTH - len(text) - text.count("子"))
        return [(character, RED if at % 2 else BLUE) for at, character in enumerate(filled)]

    frames = [screen(*map(row, rows)) for rows in texts]
    terminal, last = shown(*frames), shown(frames[-1])
    assert terminal.display == last.display
    assert [line.rstrip() for line in terminal.display] == [text.rstrip() for text in texts[-1]]


@pytest.mark.parametrize("style", [RED, BLUE])
def test_its_colours_arrive(style):
    character = shown(screen([("x", style)])).buffer[0][0]
    assert (character.fg, character.bold) == (style.color.triplet.hex[1:], bool(style.bold))
