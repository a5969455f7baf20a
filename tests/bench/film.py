"""Draw the animation of the README, .github/lab.svg: the lab as it runs, without scripts.

python tests/bench/film.py
"""

import asyncio
import re
import sys
from pathlib import Path

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.screens.still import still

TARGET = Path(__file__).parent.parent.parent / ".github" / "lab.svg"
SIZE = (80, 24)
SECONDS_PER_FRAME = 0.6
TIMES = [SECONDS_PER_FRAME * index for index in range(1, 21)]  # s: over the top at 7
MAX_BYTES = 1_500_000


def main() -> int:
    """Write the film; return 1 if it is too large for a README."""
    frames = [asyncio.run(still(DEFAULT_SCENE, time, SIZE)) for time in TIMES]
    film = film_of(frames)
    size = len(film.encode())
    if size > MAX_BYTES:
        print(f"{size} bytes are more than {MAX_BYTES}", file=sys.stderr)
        return 1
    TARGET.write_text(film, encoding="utf-8")
    print(f'{{"frames": {len(frames)}, "bytes": {size}}}')
    return 0


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
    sys.exit(main())
