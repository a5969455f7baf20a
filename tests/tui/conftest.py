import difflib
import re
from collections.abc import Callable
from pathlib import Path

import pytest

SNAPSHOTS = Path(__file__).parent / "snapshots"


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
        if stored != svg:
            (seen := path.with_suffix(".seen.svg")).write_text(svg, encoding="utf-8")
            lines = difflib.unified_diff(lines_of(stored), lines_of(svg), "stored", "seen", lineterm="", n=0)
            pytest.fail("\n".join([f"{name} looks different, see {seen}:", *lines]), pytrace=False)

    return hold


def lines_of(svg: str) -> list[str]:
    """The words of a picture, without their places."""
    return [text.replace("&#160;", " ").rstrip() for text in re.findall(r">([^<>\n]+)</text>", svg)]
