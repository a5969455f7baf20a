"""The lab as it looks: SVG pictures of each view and of a replay at 120x40, text for small screens.

The studies are stored beside the pictures: chaos would show the last bits of another processor's sine.
"""

import html
import pickle
import re
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.screens.app import normalised
from pendu_tui.tui.screens.launch import still
from pendu_tui.tui.terminal.options import SMALLEST, TerminalOptions
from tests.tui.command_line import pendu
from tests.tui.conftest import SNAPSHOTS
from tests.tui.harness import player

SIZES = {"80x24": (80, 24), "120x40": (120, 40)}
SECONDS = 12.0

STUDIES = SNAPSHOTS / "studies.pickle.z"
PASSES = (20, 300)  # steps of the stability map: they take no time

VIEWS = {"lab": [], "phase": ["f3", "5"], "accuracy": ["f4"], "stability": ["f5"]}


@pytest.fixture
def stored_studies(monkeypatch, request):
    """Give the views the studies that are stored, or store what they compute with --snapshot-update."""
    is_update = request.config.getoption("--snapshot-update")
    studies = pickle.loads(zlib.decompress(STUDIES.read_bytes())) if STUDIES.exists() else {}

    async def computed(function, *arguments):
        task = function.__name__, repr(arguments[2:])
        if is_update:
            studies[task] = [
                item for item in function(*arguments) if getattr(item, "steps", 0) != PASSES[0]
            ]
        for item in studies[task]:
            yield item

    monkeypatch.setattr("pendu_tui.tui.views.stability.PASSES", PASSES)
    monkeypatch.setattr("pendu_tui.tui.views.background.computed", computed)
    yield
    if is_update:
        STUDIES.write_bytes(zlib.compress(pickle.dumps(studies, protocol=4), 9))


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.usefixtures("stored_studies")
async def test_every_view_at_every_size(snapshot, text_snapshot, view, size):
    hold = snapshot if size == "120x40" else text_snapshot
    hold(f"{view}-{size}-dark", await still(DEFAULT_SCENE, SECONDS, SIZES[size], keys=VIEWS[view]))


@pytest.mark.parametrize("size", SIZES)
async def test_a_replay_at_every_size(snapshot, text_snapshot, size):
    hold = snapshot if size == "120x40" else text_snapshot
    async with player(resolve("drift"), SIZES[size]) as theatre:
        await theatre.run(SECONDS / 2)
        await theatre.settled()
        hold(f"replay-{size}-dark", normalised(theatre.app.export_screenshot()))


async def test_the_lab_on_the_smallest_screen_in_ascii_and_without_colours(
    text_snapshot, monkeypatch
):
    text_snapshot("lab-60x16", await still(DEFAULT_SCENE, SECONDS, SMALLEST))
    ascii_only = TerminalOptions(character_set="ascii")
    text_snapshot("lab-ascii", await still(DEFAULT_SCENE, SECONDS, SIZES["80x24"], ascii_only))
    monkeypatch.setenv("NO_COLOR", "1")
    text_snapshot("lab-no-color", await still(DEFAULT_SCENE, SECONDS, SIZES["80x24"]))


def test_the_command_writes_the_same_picture_for_viewers_that_ignore_a_texts_length(
    tmp_path, snapshot
):
    out = tmp_path / "lab.svg"
    outcome = pendu("snapshot", "--time", SECONDS, "-o", out)
    assert (outcome.code, outcome.out, outcome.err) == (0, "", "")
    svg = out.read_text(encoding="utf-8")
    snapshot("lab-120x40-dark", svg)
    texts = map(html.unescape, re.findall(r"<text [^>]*>([^<]*)</text>", svg))
    assert all(text.isascii() or len(text) == 1 for text in texts)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--size", "10x10"], "60x16"),
        (["--size", "big"], "120x40"),
        (["--time", "nan"], "not a valid time"),
        (["-o", "lab.png"], "lab.svg"),
        (["-o", "lab"], "lab.svg"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_a_sentence(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert pendu("snapshot", "-o", "x.svg", *arguments).refused(2, words)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_pictures_are_the_same_on_processors_with_other_last_bits():
    here = Path(__file__)
    others = here.with_name("test_tour.py"), here.parents[1] / "views" / "phase"
    options = ["-q", "-n0", "-k", "snapshots or command", "-p", "no:cacheprovider"]
    python = [sys.executable, "-m", "pytest", "-p", "tests.tui.last_bits", *options]
    done = subprocess.run([*python, here, *others], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
