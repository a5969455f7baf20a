"""The screen looks the same with fewer bytes sent."""

import pyte
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tui.terminal.sgr import without_repeated_colours

COLOURS = ["38;2;1;2;3", "38;2;9;9;9", "38;5;7", "31", "97"]
GROUNDS = ["48;2;18;18;18", "48;5;3", "44", "107"]
ATTRIBUTES = ["1", "7", "1;4"]


def codes():
    choices = [st.sampled_from(["", *some]) for some in (ATTRIBUTES, COLOURS, GROUNDS)]
    return st.tuples(*choices).map(lambda some: ";".join(filter(None, some)))


PIECES = st.one_of(
    st.tuples(codes(), st.sampled_from(["ab", " ", "   ", "x y", "⣿"])).map(
        lambda piece: f"\x1b[{piece[0]}m{piece[1]}\x1b[0m" if piece[0] else piece[1]
    ),
    st.tuples(st.integers(1, 4), st.integers(1, 12)).map(lambda at: f"\x1b[{at[0]};{at[1]}H"),
    st.sampled_from(["\n", "\x1b[31m", "\x1b[0m", "\x1b[K"]),
)


def shown(*sent: str) -> list[object]:
    """The cells, and what the next character would look like; a blank has no colour of its own."""
    screen = pyte.Screen(20, 6)
    stream = pyte.Stream(screen)
    for each in sent:
        stream.feed(each)
    cells = [screen.buffer[y][x] for y in range(6) for x in range(20)]
    plain = [
        cell._replace(fg="") if cell.data == " " and not (cell.reverse or cell.underscore) else cell for cell in cells
    ]
    return [*plain, screen.cursor.x, screen.cursor.y, screen.cursor.attrs]


@given(st.lists(PIECES, max_size=12).map("".join), st.lists(PIECES, max_size=12).map("".join))
def test_the_screen_looks_the_same_after_each_write(one: str, other: str):
    one, other = f"{one}\x1b[0m", f"{other}\x1b[0m"
    assert shown(without_repeated_colours(one), without_repeated_colours(other)) == shown(one, other)


ON = ";48;2;18;18;18m"


@pytest.mark.parametrize(
    ("sent", "less"),
    [
        ("nothing", "nothing"),
        (f"\x1b[38;2;1;2;3{ON}a\x1b[0m\x1b[38;2;1;2;3{ON}b\x1b[0m", f"\x1b[38;2;1;2;3{ON}ab\x1b[0m"),
        (f"\x1b[31{ON}a\x1b[0m\x1b[32{ON}b\x1b[0m", f"\x1b[31{ON}a\x1b[32mb\x1b[0m"),
        (f"\x1b[31{ON}a\x1b[0m\x1b[32{ON}  \x1b[0m\x1b[31{ON}b\x1b[0m", f"\x1b[31{ON}a  b\x1b[0m"),
        (f"\x1b[31{ON}a\x1b[0m\x1b[5;9H\x1b[31{ON}b\x1b[0m", f"\x1b[31{ON}a\x1b[5;9Hb\x1b[0m"),
    ],
)
def test_colours_in_force_are_not_sent_again(sent: str, less: str):
    assert without_repeated_colours(sent) == less
