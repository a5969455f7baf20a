import asyncio
import difflib
import html
import pickle
import re
from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path

import pytest
from rich.cells import cell_len

SNAPSHOTS = Path(__file__).parent / "snapshots"
CELL = 12.2  # units of a picture, across
TEXT = re.compile(
    r'<text [^>]*x="([\d.]+)"[^>]*clip-path="url\(#terminal-(?:\d+-)?line-(\d+)\)">([^<]*)</text>'
)

Hold = Callable[[str, str], None]
_computed: dict[bytes, list[object]] = {}


async def computed_here(
    function: Callable[..., Iterator[object]], *arguments: object
) -> AsyncIterator[object]:
    """Compute as tui.views.background.computed does, but in a thread, and keep the results.

    Another process takes seconds to import everything, and many tests need the same map.
    """
    task = pickle.dumps((function, arguments))
    for item in _computed.get(task, ()):
        yield item
    if task not in _computed:
        items = function(*arguments)
        computed = []
        while (item := await asyncio.to_thread(next, items, None)) is not None:
            computed.append(item)
            yield item
        _computed[task] = computed


@pytest.fixture(autouse=True)
def _views_compute_here(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.node.get_closest_marker("other_process") is None:
        monkeypatch.setattr("pendu_tui.tui.views.background.computed", computed_here)


@pytest.fixture
def snapshot(request: pytest.FixtureRequest) -> Hold:
    """Compare an SVG picture with the stored one of that name; --snapshot-update stores it."""
    update = request.config.getoption("--snapshot-update")
    return lambda name, svg: compare(SNAPSHOTS / f"{name}.svg", svg, cells_of, lines_of, update)


@pytest.fixture
def text_snapshot(request: pytest.FixtureRequest) -> Hold:
    """Compare the text and the colours of an SVG picture with those stored."""
    update = request.config.getoption("--snapshot-update")

    def hold(name: str, svg: str) -> None:
        looks = {look for _, look in cells_of(svg).values()}
        colours = sorted(set(re.findall(r"#[0-9a-fA-F]{6}", " ".join(looks))))
        text = f"{text_of(svg)}\ncolours: {' '.join(colours)}\n"
        compare(SNAPSHOTS / f"{name}.txt", text, str, str.splitlines, update)

    return hold


def compare(
    path: Path,
    picture: str,
    essence: Callable[[str], object],
    lines: Callable[[str], list[str]],
    update: bool,
) -> None:
    if update:
        path.write_text(picture, encoding="utf-8")
    stored = path.read_text(encoding="utf-8")
    if essence(stored) != essence(picture):
        seen = path.with_suffix(f".seen{path.suffix}")
        seen.write_text(picture, encoding="utf-8")
        diff = difflib.unified_diff(lines(stored), lines(picture), lineterm="", n=0)
        pytest.fail("\n".join([f"{path.name} looks different, see {seen}:", *diff]), pytrace=False)


def cells_of(svg: str) -> dict[tuple[str, int], tuple[str, str]]:
    """Return the character and the style of each cell, and the backgrounds."""
    looks = dict(re.findall(r"\.terminal-(r\d+) { (.*) }", svg))
    cells: dict[tuple[str, int], tuple[str, str]] = {}
    behind = r'<rect fill="([^"]+)" x="([\d.]+)" y="([\d.]+)" width="([\d.]+)"'
    for fill, x, y, width in re.findall(behind, svg):
        first = round(float(x) / CELL)
        for column in range(first, first + round(float(width) / CELL)):
            cells[f"behind {y}", column] = "", fill
    words = r'<text class="terminal-(r\d+)" x="([\d.]+)" y="([\d.]+)"[^>]*>([^<]*)</text>'
    for look, x, y, text in re.findall(words, svg):
        column = round(float(x) / CELL)
        for character in html.unescape(text):
            if not character.isspace():
                cells[y, column] = character, looks[look]
            column += cell_len(character)
    return cells


def lines_of(svg: str) -> list[str]:
    """Return the words of a picture, without their places."""
    return [text.replace("&#160;", " ").rstrip() for text in re.findall(r">([^<>\n]+)</text>", svg)]


def text_of(svg: str) -> str:
    """Return the text of an SVG of the screen, without trailing blanks."""
    lines: dict[int, str] = {}
    for x, line, text in TEXT.findall(svg):
        before = lines.get(int(line), "").ljust(round(float(x) / CELL))
        lines[int(line)] = before + html.unescape(text).replace("\xa0", " ")
    return "\n".join(lines.get(line, "").rstrip() for line in range(max(lines, default=-1) + 1))
