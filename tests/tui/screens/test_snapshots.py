"""The lab as it looks: characters and colours of each view and of a replay, and a picture as SVG."""

import html
import re

import pytest

from pendu_tui.engine.studies.accuracy import ladder
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.terminal.options import SMALLEST
from tests.tui.command_line import pendu
from tests.tui.drawn import looks
from tests.tui.harness import Theatre, lab, player

SMALL = (80, 24)
LARGE = (120, 40)
SECONDS = 12.0


@pytest.fixture
def robust_studies(monkeypatch):
    """Let the views compute what no last bit of another processor's sine can change visibly.

    In 60 steps chaos does not carry it as far as a dot; no error comes near the rounding.
    """
    steps = ladder(20.0, h_max=0.4, h_min=0.02, count=8)
    monkeypatch.setattr("pendu_tui.tui.views.accuracy.usual", lambda scene, all: (20.0, steps))
    monkeypatch.setattr("pendu_tui.tui.views.stability.PASSES", (60,))


async def settled(theatre: Theatre, *keys: str) -> str:
    await theatre.run(SECONDS)
    await theatre.press(*keys)
    await theatre.settled()
    await theatre.pilot.pause()
    return looks(theatre.app)


@pytest.mark.parametrize(
    ("name", "size", "keys"),
    [
        ("lab-60x16", SMALLEST, []),
        ("lab-80x24", SMALL, []),
        ("lab-120x40", LARGE, []),
        ("phase-80x24", SMALL, ["f3", "5"]),
        ("accuracy-120x40", LARGE, ["f4"]),
        ("stability-80x24", SMALL, ["f5"]),
    ],
)
@pytest.mark.usefixtures("robust_studies")
async def test_every_view(snapshot, name, size, keys):
    async with lab(size=size) as theatre:
        snapshot(f"{name}.txt", await settled(theatre, *keys))


async def test_a_replay(snapshot):
    async with player(resolve("drift"), SMALL) as theatre:
        snapshot("replay-80x24.txt", await settled(theatre, "home", *["right"] * 6))


async def test_the_lab_in_ascii_without_colours(snapshot, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    async with lab(size=SMALL) as theatre:
        theatre.app.action_use_pixels("ascii")
        snapshot("lab-ascii.txt", await settled(theatre))


def test_the_command_writes_the_same_picture_for_viewers_that_ignore_a_texts_length(
    tmp_path, snapshot
):
    out = tmp_path / "lab.svg"
    outcome = pendu("snapshot", "--time", SECONDS, "-o", out)
    assert (outcome.code, outcome.out) == (0, "")
    svg = out.read_text(encoding="utf-8")
    snapshot("lab.svg", svg)
    texts = map(html.unescape, re.findall(r"<text [^>]*>([^<]*)</text>", svg))
    assert all(text.isascii() or len(text) == 1 for text in texts)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--size", "10x10"], "60x16"),
        (["--size", "120x201"], "400x200"),
        (["--size", "big"], "120x40"),
        (["--time", "nan"], "out of range"),
        (["-o", "lab.png"], "lab.svg"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_a_sentence(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert pendu("snapshot", "-o", "x.svg", *arguments).refused(2, words)
    assert not list(tmp_path.iterdir())
