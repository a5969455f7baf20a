"""The lab as it looks: a replay, the lab in ASCII, and a picture as SVG."""

import html
import re

from textual.widgets import Input

from pendu_tui.tui.cli.options import resolve
from tests.tui.command_line import pendu
from tests.tui.drawn import looks
from tests.tui.harness import lab, player
from tests.tui.views.test_snapshots import SECONDS, SMALL, settled


async def test_a_replay(snapshot):
    async with player(resolve("drift"), SMALL) as theatre:
        snapshot("replay-80x24.txt", await settled(theatre, "home", *["right"] * 6))


async def test_the_dialogs(snapshot, monkeypatch):
    monkeypatch.setattr(Input, "_toggle_cursor", lambda _: None)  # it does not blink
    pictures = []
    async with lab(size=SMALL) as theatre:
        await theatre.press("space")
        await theatre.run(0)
        for key in ("i", "M", "ctrl+p", "d"):
            await theatre.press(key)
            pictures.append(looks(theatre.app))
            await theatre.press("escape")
    snapshot("dialogs.txt", "\n".join(pictures))


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
    assert pendu("snapshot", "-o", out.with_suffix(".png")).refused(2, "lab.svg")
