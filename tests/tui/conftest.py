import difflib
import html
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.cells import cell_len

SNAPSHOTS = Path(__file__).parent / "snapshots"
CELL = 12.2  # units of a picture, across


@pytest.fixture
def snapshot(request: pytest.FixtureRequest) -> Callable[[str, str], None]:
    """Hold an SVG picture against the stored one of that name; --snapshot-update stores it."""

    def hold(name: str, svg: str) -> None:
        path = SNAPSHOTS / f"{name}.svg"
        if request.config.getoption("--snapshot-update"):
            path.parent.mkdir(exist_ok=True)
            path.write_text(svg, encoding="utf-8")
        if not path.exists():
            pytest.fail(f"there is no picture {path}: look at what --snapshot-update stores")
        stored = path.read_text(encoding="utf-8")
        if cells_of(stored) != cells_of(svg):
            (seen := path.with_suffix(".seen.svg")).write_text(svg, encoding="utf-8")
            lines = difflib.unified_diff(lines_of(stored), lines_of(svg), "stored", "seen", lineterm="", n=0)
            pytest.fail("\n".join([f"{name} looks different, see {seen}:", *lines]), pytrace=False)

    return hold


def cells_of(svg: str) -> dict[tuple[str, int], tuple[str, str]]:
    """Each cell's character and look, and each background, however they were strung together."""
    looks = dict(re.findall(r"\.terminal-(r\d+) { (.*) }", svg))
    cells: dict[tuple[str, int], tuple[str, str]] = {}
    for fill, x, y, width in re.findall(r'<rect fill="([^"]+)" x="([\d.]+)" y="([\d.]+)" width="([\d.]+)"', svg):
        first, count = round(float(x) / CELL), round(float(width) / CELL)
        cells |= {(f"behind {y}", column): ("", fill) for column in range(first, first + count)}
    for look, x, y, text in re.findall(
        r'<text class="terminal-(r\d+)" x="([\d.]+)" y="([\d.]+)"[^>]*>([^<]*)</text>', svg
    ):
        column = round(float(x) / CELL)
        for character in html.unescape(text):
            if not character.isspace():
                cells[y, column] = character, looks[look]
            column += cell_len(character)
    return cells


def lines_of(svg: str) -> list[str]:
    """The words of a picture, without their places."""
    return [text.replace("&#160;", " ").rstrip() for text in re.findall(r">([^<>\n]+)</text>", svg)]
