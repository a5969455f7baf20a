import difflib
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tui.terminal.screenshot import text_of

SNAPSHOTS = Path(__file__).parent / "snapshots"

Hold = Callable[[str, str], None]


@pytest.fixture
def snapshot(request: pytest.FixtureRequest) -> Hold:
    """Compare an SVG picture with the stored one of that name; --snapshot-update stores it."""

    def hold(name: str, svg: str) -> None:
        compare(SNAPSHOTS / f"{name}.svg", svg, lines_of, request.config.getoption("--snapshot-update"))

    return hold


@pytest.fixture
def text_snapshot(request: pytest.FixtureRequest) -> Hold:
    """The same for the text of an SVG picture and its colours: small, and a changed word is one changed line."""

    def hold(name: str, svg: str) -> None:
        colours = sorted(set(re.findall(r"fill: ?(#[0-9a-fA-F]{6})", svg)))
        text = f"{text_of(svg)}\ncolours: {' '.join(colours)}\n"
        compare(SNAPSHOTS / f"{name}.txt", text, str.splitlines, request.config.getoption("--snapshot-update"))

    return hold


def compare(path: Path, picture: str, lines: Callable[[str], list[str]], update: bool) -> None:
    if update:
        path.parent.mkdir(exist_ok=True)
        path.write_text(picture, encoding="utf-8")
    if not path.exists():
        pytest.fail(f"{path} is missing: look at what --snapshot-update stores")
    stored = path.read_text(encoding="utf-8")
    if stored != picture:
        (seen := path.with_suffix(f".seen{path.suffix}")).write_text(picture, encoding="utf-8")
        diff = difflib.unified_diff(lines(stored), lines(picture), "stored", "seen", lineterm="", n=0)
        pytest.fail("\n".join([f"{path.name} looks different, see {seen}:", *diff]), pytrace=False)


def lines_of(svg: str) -> list[str]:
    """The words of a picture, without their places."""
    return [text.replace("&#160;", " ").rstrip() for text in re.findall(r">([^<>\n]+)</text>", svg)]
