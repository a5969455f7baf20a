import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from rich.color import Color, ColorSystem

from engine.methods import METHODS, USUAL_CAST, method_of
from engine.scenes import SCENES
from tui.drawing.palette import (
    EXACT,
    FAINT,
    FRAME,
    GOOD,
    NOBODY,
    PALETTES,
    QUIET,
    TEXT,
    WARN,
    ink_of,
    inks,
    mark,
    palette,
)

# Machado, Oliveira & Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009) 1291: what the colour
# blind see, linear RGB: all colours, then protanopia, deuteranopia, tritanopia.
# fmt: off
SIGHT = np.array([
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
])
# fmt: on
# Ottosson, "A perceptual color space for image processing" (2020).
TO_CONES = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
]
TO_OKLAB = [
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
]

COMPUTED = [theme for theme in PALETTES if theme != "ansi"]
THEMES = pytest.mark.parametrize("theme", COMPUTED)
TERMINALS = {  # what the names of the 16 colours stand for: black, then bright red, blue, cyan, yellow
    "xterm": ("#000000", "#FF0000", "#5C5CFF", "#00FFFF", "#FFFF00"),
    "VGA": ("#000000", "#FF5555", "#5555FF", "#55FFFF", "#FFFF55"),
    "Tango": ("#000000", "#EF2929", "#729FCF", "#34E2E2", "#FCE94F"),
    "Windows": ("#0C0C0C", "#E74856", "#3B78FF", "#61D6D6", "#F9F1A5"),
}


def linear(colour):
    value = np.array([int(colour[at : at + 2], 16) for at in (1, 3, 5)]) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def oklab(rgb):
    return TO_OKLAB @ np.cbrt(TO_CONES @ np.clip(rgb, 0, 1))


def worst_pair(colours, sights=SIGHT):
    """The distance of the most similar pair."""
    return min(
        100 * np.linalg.norm(oklab(sight @ linear(one)) - oklab(sight @ linear(other)))
        for sight in sights
        for one, other in itertools.combinations(colours, 2)
    )


def contrast(colour, background):
    """As WCAG 2 defines it."""
    dark, light = sorted(linear(one) @ [0.2126, 0.7152, 0.0722] for one in (colour, background))
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize(
    ("theme", "apart"), [("dark", 19.5), ("light", 13.3), ("high-contrast", 21.6)]
)
def test_the_colour_blind_can_distinguish_the_classics(theme, apart):
    assert worst_pair(PALETTES[theme].methods[:4]) == pytest.approx(apart, abs=0.05)
    assert worst_pair(("#FF0000", "#00FF00", "#FFFF00", "#0000FF")) < apart / 3


@pytest.mark.parametrize(
    ("theme", "apart", "plainly"),
    [("dark", 10.6, 21), ("light", 10.2, 20), ("high-contrast", 11.2, 21)],
)
def test_in_no_scene_two_methods_look_alike(theme, apart, plainly):
    for scene in SCENES.values():
        colours = [PALETTES[theme].colour(ink) for ink in inks(scene.cast)]
        assert worst_pair(colours) >= apart, scene.name
        assert worst_pair(colours, SIGHT[:1]) >= plainly, scene.name


@THEMES
def test_no_colour_of_a_method_is_taken_for_black(theme):
    for colour in PALETTES[theme].methods:
        lightness, a, b = oklab(linear(colour))
        assert lightness > 0.35
        assert math.hypot(a, b) > 0.05


def test_the_classics_have_the_same_ink_in_every_cast_and_the_others_the_next_free_one():
    respa, imex = method_of("respa"), method_of("imex_euler")
    verlet, rk4 = USUAL_CAST[2:]
    assert inks(USUAL_CAST) == (0, 1, 2, 3)
    assert inks((respa, rk4, imex, verlet)) == (4, 3, 5, 2)
    assert ink_of(imex, (respa, rk4, imex)) == 5
    assert ink_of(rk4, ()) == 3
    assert ink_of(respa, USUAL_CAST) == QUIET


def test_another_method_changes_nobodys_colour():
    for scene in SCENES.values():
        new = replace(method_of("blanes_moan_6"), key="new", label="New", letter="z")
        *before, last = inks((*scene.cast, new))
        assert tuple(before) == inks(scene.cast)
        assert last not in before


@pytest.mark.parametrize(("theme", "bound"), [("dark", 4.5), ("light", 4.5), ("high-contrast", 7)])
def test_text_has_the_contrast_required_by_wcag(theme, bound):
    colours = PALETTES[theme]
    for ink in (*range(10), EXACT, TEXT, NOBODY, WARN, QUIET, GOOD):
        assert contrast(colours.colour(ink), colours.background) >= bound


@THEMES
def test_the_methods_differ_in_256_colours(theme):
    colours = PALETTES[theme]
    names = (*colours.methods[:4], colours.text, colours.background)
    downgraded = [Color.parse(name).downgrade(ColorSystem.EIGHT_BIT) for name in names]
    *fewer, background = (colour.get_truecolor().hex for colour in downgraded)
    assert worst_pair(fewer[:4]) >= 0.7 * worst_pair(colours.methods[:4])
    assert min(contrast(name, background) for name in fewer) > 3.6  # WCAG: graphics 3, text 4.5


@pytest.mark.parametrize("terminal", TERMINALS)
def test_the_methods_differ_in_the_terminals_own_16_colours(terminal):
    names = ("bright_red", "bright_blue", "bright_cyan", "bright_yellow")
    assert PALETTES["ansi"].methods[:4] == names
    black, *methods = TERMINALS[terminal]
    assert worst_pair(methods) >= 14.4
    assert min(contrast(method, black) for method in methods) >= 4.1


@THEMES
def test_lines_are_visible_and_trails_are_fainter_than_their_methods(theme):
    colours = PALETTES[theme]
    assert contrast(colours.colour(FRAME), colours.background) >= 3  # WCAG's bound for graphics
    for owner in range(10):
        pair = (colours.colour(owner), colours.colour(owner + FAINT))
        full, faint = (contrast(colour, colours.background) for colour in pair)
        assert 1.85 <= faint < 0.7 * full


@pytest.mark.parametrize("theme", COMPUTED)
def test_twenty_methods_have_colours_of_their_own(theme):
    assert len({PALETTES[theme].colour(ink) for ink in range(20)}) == 20


@pytest.mark.parametrize(
    ("theme", "name"),
    [
        *((name, name) for name in PALETTES),
        ("textual-dark", "dark"),
        ("textual-light", "light"),
        ("ansi-light", "ansi"),
        ("nord", "dark"),
    ],
)
def test_other_themes_get_the_palette_that_suits_their_name(theme, name):
    assert palette(theme) is PALETTES[name]


def test_marks_are_distinct_and_take_one_column_in_every_terminal():
    marks = [mark(place, method) for place, method in enumerate(METHODS)]
    assert marks[0] == "1 e"
    assert len(set(marks)) == len(METHODS)
    assert all(text.isascii() for text in marks)
