"""The same screen in less than half the bytes, for a slow line.

Textual sends each piece of text with all of its colours before it and a reset after it; most of them repeat.
"""

import re
from functools import lru_cache

_SGR = re.compile("\x1b\\[([0-9;]*)m")
_INVISIBLE = re.compile("(?:\x1b\\[[0-9]+;[0-9]+H|\n)*")  # the cursor moves
_COLOURS = re.compile(
    "(38;2;[0-9]+;[0-9]+;[0-9]+|38;5;[0-9]+|[39][0-7])?;?(48;2;[0-9]+;[0-9]+;[0-9]+|48;5;[0-9]+|4[0-7]|10[0-7])?"
)


def without_repeated_colours(sent: str) -> str:
    """The same screen in fewer bytes, for a terminal with no colours or attributes in force, before and after."""
    first, *rest = _SGR.split(sent)
    parts, now, wanted = [first], "", ""
    for codes, text in zip(rest[::2], rest[1::2], strict=True):
        if codes.startswith("0") or not codes:
            wanted = codes.lstrip("0").lstrip(";")
        else:
            wanted = f"{wanted};{codes}" if wanted else codes
        invisible = _INVISIBLE.fullmatch(text) or (text.isspace() and _same_for_blanks(now, wanted))
        if wanted != now and not invisible:
            parts.append(_change(now, wanted))
            now = wanted
        parts.append(text)
    return "".join([*parts, _change(now, "")] if now else parts)


@lru_cache(maxsize=1024)
def _change(now: str, wanted: str) -> str:
    """The sequence that changes the codes in force from `now` to `wanted`."""
    before, after = _COLOURS.fullmatch(now), _COLOURS.fullmatch(wanted)
    if not (wanted and before and after):  # attributes can only be switched off together
        return f"\x1b[0;{wanted}m" if now and wanted else f"\x1b[{wanted or 0}m"
    pairs = zip(before.groups(), after.groups(), ("39", "49"), strict=True)
    return f"\x1b[{';'.join(new or default for old, new, default in pairs if old != new)}m"


@lru_cache(maxsize=1024)
def _same_for_blanks(now: str, wanted: str) -> bool:
    """Whether only the colour of letters differs, which a blank does not show."""
    before, after = _COLOURS.fullmatch(now), _COLOURS.fullmatch(wanted)
    return before is not None and after is not None and before[2] == after[2]
