import itertools
from dataclasses import replace

import numpy as np
import pytest
from rich.style import Style

from pendu_tui.engine.methods import USUAL_CAST, method_of
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.picture import (
    EXACT,
    FAINT,
    FRAME,
    GOOD,
    NOBODY,
    PALETTES,
    QUIET,
    TEXT,
    WARN,
    Picture,
    faint,
    ink_of,
    inks,
    lines_of,
    mark,
    mixed,
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

# the distance of the classics and of the methods of a scene for the colour blind, of the latter for
# all others, and the contrast of words
THEMES = {
    "dark": (19.5, 10.6, 21, 4.5),
    "light": (13.3, 10.2, 20, 4.5),
    "high-contrast": (21.6, 11.2, 21, 7),
}


@pytest.fixture(params=THEMES)
def theme(request):
    return request.param


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


def test_methods_are_told_apart_by_the_colour_blind_too(theme):
    classics_apart, apart, plainly, _ = THEMES[theme]
    classics = PALETTES[theme].methods[:4]
    assert worst_pair(classics) == pytest.approx(classics_apart, abs=0.05)
    for scene in SCENES.values():
        colours = [PALETTES[theme].colour(ink) for ink in inks(scene.cast)]
        assert worst_pair(colours) >= apart, scene.name
        assert worst_pair(colours, SIGHT[:1]) >= plainly, scene.name


def test_the_classics_have_the_same_ink_in_every_cast_and_the_others_the_next_free_one():
    respa, imex = method_of("respa"), method_of("imex_euler")
    verlet, rk4 = USUAL_CAST[2:]
    assert inks(USUAL_CAST) == (0, 1, 2, 3)
    assert inks((respa, rk4, imex, verlet)) == (4, 3, 5, 2)
    assert ink_of(imex, (respa, rk4, imex)) == 5
    assert ink_of(rk4, ()) == 3
    assert mark(0, rk4) == "1 r"
    assert ink_of(respa, USUAL_CAST) == QUIET
    assert [faint(ink) for ink in (0, 3, EXACT)] == [FAINT, FAINT + 3, EXACT]
    for scene in SCENES.values():  # adding a method changes nobody's
        *before, last = inks((*scene.cast, replace(respa, key="new")))
        assert tuple(before) == inks(scene.cast)
        assert last not in before


def test_words_lines_and_trails_have_the_contrast_that_they_need(theme):
    colours = PALETTES[theme]

    def seen(ink):
        return contrast(colours.colour(ink), colours.background)

    *_, bound = THEMES[theme]  # of WCAG for words; 3 for graphics
    assert min(map(seen, (*range(10), EXACT, TEXT, NOBODY, WARN, QUIET, GOOD))) >= bound
    assert seen(FRAME) >= 3
    for ink in range(10):
        assert 1.85 <= seen(ink + FAINT) < 0.7 * seen(ink)


def test_points_trails_words_and_lines_have_the_colours_that_are_stored(snapshot):
    """After ten methods the ten come again; below 0 are the inks of words and lines."""
    lines = []
    for name, each in PALETTES.items():
        lines.append(f"{name}, on {each.background}")
        lines += [
            f"{ink} {each.colour(ink)} {each.colour(faint(ink))}" for ink in range(NOBODY, 11)
        ]
    snapshot("palettes.txt", "\n".join(lines) + "\n")


def test_other_themes_get_the_palette_that_suits_their_name():
    for theme, name in {"textual-light": "light", "ansi-light": "ansi", "nord": "dark"}.items():
        assert palette(theme) is PALETTES[name]
    assert [mixed("bright_red", "black", share) for share in (0.19, 0.2)] == ["bright_red", "red"]


def test_lines_for_the_terminal_have_the_colours_of_a_palette_or_none_and_no_blanks_at_the_end():
    picture = Picture([[("ab ", 1), ("c  ", Style(bold=True))]])
    for colours, styles in ((PALETTES["dark"], [PALETTES["dark"].methods[1]]), (None, [])):
        (line,) = lines_of(picture, colours)
        assert line.plain == "ab c"
        assert [each.style for each in line.spans] == [*styles, Style(bold=True)]
