"""Draw the pictures of the pages, and the animation of the README: a run and a throw.

python -m tests.bench.film
"""

import asyncio
import re
from pathlib import Path

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.commands.lab import still
from pendu_tui.tui.screens.app import normalised
from pendu_tui.tui.views.stage import Stage
from pendu_tui.tui.views.view import Held
from tests.tui.harness import lab

FOLDER = Path(__file__).parent.parent.parent / ".github"
TARGET = FOLDER / "lab.svg"
VIEWS = {"accuracy": "f4", "stability": "f5"}
"""The pictures of the pages, and the keys of their views."""

SIZE = (80, 24)
SECONDS_PER_FRAME = 0.6
BEFORE = 5  # frames of the first run
HELD = (0.5, 1.4, 2.1, 2.4)  # rad, where the pointer holds all bobs
OMEGA = 1.5  # rad/s, with which it throws them
AFTER = 9  # frames in which they part


def main() -> None:
    for name, key in VIEWS.items():
        picture = asyncio.run(still(DEFAULT_SCENE, 12.0, (120, 40), keys=[key]))
        (FOLDER / "docs" / f"{name}.svg").write_text(picture, encoding="utf-8")
    TARGET.write_text(film_of(asyncio.run(shot())), encoding="utf-8")


async def shot() -> list[str]:
    """Return pictures of a run, of the bobs in the hand, and of the run after the throw."""
    pictures = []
    async with lab(size=SIZE) as theatre:
        stage = theatre.stage.query_one(Stage)

        async def take(seconds: float) -> None:
            await theatre.run(seconds)
            pictures.append(normalised(theatre.app.export_screenshot()))

        for _ in range(BEFORE):
            await take(SECONDS_PER_FRAME)
        for theta in HELD:
            stage.post_message(Held(theta))
            await take(0.0)
        stage.post_message(Held(None))
        stage.start_at(HELD[-1], OMEGA)
        await theatre.pilot.pause()
        for _ in range(AFTER):
            await take(SECONDS_PER_FRAME)
    return pictures


def film_of(frames: list[str]) -> str:
    """Return an SVG that shows SVG pictures of equal size one after the other, in a loop."""
    duration = SECONDS_PER_FRAME * len(frames)
    share = 100 / len(frames)
    view_box = re.search(r'viewBox="([^"]*)"', frames[0])[1]
    rules = [
        f"@keyframes film {{ 0%, {share:.4f}% {{ visibility: visible }}"
        f" {share:.4f}1%, 100% {{ visibility: hidden }} }}",
        f".frame {{ visibility: hidden; animation: film {duration}s step-end infinite }}",
    ]
    groups = []
    for index, frame in enumerate(frames):
        delay = SECONDS_PER_FRAME * index - duration  # s; below zero: all are moving at once
        unique = frame.replace("terminal-", f"f{index}-")
        style = f"animation-delay: {delay:.1f}s"
        if index == len(frames) - 1:
            style += "; visibility: visible"  # where nothing moves
        groups.append(f'<g class="frame" style="{style}">{unique}</g>')
    style = "<style>" + "\n".join(rules) + "</style>"
    start = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box}">{style}'
    return "\n".join([start, *groups, "</svg>\n"])


if __name__ == "__main__":
    main()
