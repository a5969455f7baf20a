"""SVG pictures that every viewer shows alike."""

import html
import re

from rich.cells import cell_len


def normalised(svg: str) -> str:
    return re.sub(r"terminal-\d+-", "terminal-", svg)


def portable(svg: str) -> str:
    """Return the picture with a position for each word instead of a length for each text.

    Inkscape and librsvg ignore the length, and draw braille in fonts of other widths.
    """
    fonts = "font-family: Fira Code, DejaVu Sans Mono, monospace"
    text = r'(<text [^>]*)x="([\d.]+)" (y="[^>]*) textLength="([\d.]+)"([^>]*)>([^<]*)</text>'
    return re.sub(text, _placed, svg).replace("font-family: Fira Code, monospace", fonts)


def _placed(found: re.Match[str]) -> str:
    opening, start, y, length, rest, escaped = found.groups()
    text = html.unescape(escaped)
    cell = float(length) / max(1, cell_len(text))
    parts = []
    for word in re.finditer(r"[!-~]+|[^\s]", text):
        x = float(start) + cell_len(text[: word.start()]) * cell
        width = cell_len(word[0]) * cell
        place = f'{opening}x="{x:.5g}" {y} textLength="{width:.5g}"{rest}'
        parts.append(f"{place}>{html.escape(word[0])}</text>")
    return "".join(parts)
