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

SIZES = {"80x24": (80, 24), "120x40": (120, 40)}
SECONDS = 12.0

VIEWS = {"lab": [], "phase": ["f3", "5"], "accuracy": ["f4"], "stability": ["f5"]}


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


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.usefixtures("robust_studies")
async def test_every_view_at_every_size(snapshot, view, size):
    async with lab(size=SIZES[size]) as theatre:
        snapshot(f"{view}-{size}.txt", await settled(theatre, *VIEWS[view]))


@pytest.mark.parametrize("size", SIZES)
async def test_a_replay_at_every_size(snapshot, size):
    async with player(resolve("drift"), SIZES[size]) as theatre:
        snapshot(f"replay-{size}.txt", await settled(theatre, "home", *["right"] * 6))


async def test_the_lab_on_the_smallest_screen_in_ascii_and_without_colours(snapshot, monkeypatch):
    async with lab(size=SMALLEST) as theatre:
        snapshot("lab-60x16.txt", await settled(theatre))
    async with lab(size=SIZES["80x24"]) as theatre:
        theatre.app.action_use_pixels("ascii")
        snapshot("lab-ascii.txt", await settled(theatre))
    monkeypatch.setenv("NO_COLOR", "1")
    async with lab(size=SIZES["80x24"]) as theatre:
        snapshot("lab-no-color.txt", await settled(theatre))


def test_the_command_writes_the_same_picture_for_viewers_that_ignore_a_texts_length(
    tmp_path, snapshot
):
    out = tmp_path / "lab.svg"
    outcome = pendu("snapshot", "--time", SECONDS, "-o", out)
    assert (outcome.code, outcome.out, outcome.err) == (0, "", "")
    svg = out.read_text(encoding="utf-8")
    snapshot("lab.svg", svg)
    texts = map(html.unescape, re.findall(r"<text [^>]*>([^<]*)</text>", svg))
    assert all(text.isascii() or len(text) == 1 for text in texts)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--size", "10x10"], "60x16"),
        (["--size", "big"], "120x40"),
        (["--time", "nan"], "not a valid time"),
        (["-o", "lab.png"], "lab.svg"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_a_sentence(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert pendu("snapshot", "-o", "x.svg", *arguments).refused(2, words)
    assert not list(tmp_path.iterdir())
