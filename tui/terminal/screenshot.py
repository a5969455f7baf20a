"""The screen in a file: as an SVG picture, and as text."""

import html
import re
import time
from pathlib import Path

from recordings.library import free_path

CELL = 12.2  # the width of a cell in Rich's SVG pictures
_TEXT = re.compile(r'<text [^>]*x="([\d.]+)"[^>]*clip-path="url\(#terminal-(?:\d+-)?line-(\d+)\)">([^<]*)</text>')


def text_of(svg: str) -> str:
    """The characters of an SVG of the screen, line by line, without trailing blanks."""
    lines: dict[int, str] = {}
    for x, line, text in _TEXT.findall(svg):
        before = lines.get(int(line), "")
        lines[int(line)] = before.ljust(round(float(x) / CELL)) + html.unescape(text).replace("\xa0", " ")
    return "\n".join(lines.get(line, "").rstrip() for line in range(max(lines, default=-1) + 1))


def save_screenshot(svg: str, folder: Path, now: time.struct_time | None = None) -> tuple[Path, Path]:
    """Save an SVG and its text, named after date and time; returns their paths.  Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    picture = free_path(folder / (time.strftime("%Y-%m-%dT%H-%M-%S", now or time.localtime()) + ".svg"))
    text = picture.with_suffix(".txt")
    picture.write_text(svg, encoding="utf-8")
    text.write_text(text_of(svg) + "\n", encoding="utf-8")
    return picture, text
