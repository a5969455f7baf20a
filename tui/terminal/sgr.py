"""The same picture in less than half the bytes: without the colours that are in force already.

Every piece of text comes with all of its colours before it and a reset behind it.  Pure.
"""

import re
from functools import lru_cache

_SGR = re.compile("\x1b\\[([0-9;]*)m")
_INVISIBLE = re.compile("(?:\x1b\\[[0-9]+;[0-9]+H|\n)*")  # the cursor moves
_COLOURS = re.compile(
    "(38;2;[0-9]+;[0-9]+;[0-9]+|38;5;[0-9]+|[39][0-7])?;?(48;2;[0-9]+;[0-9]+;[0-9]+|48;5;[0-9]+|4[0-7]|10[0-7])?"
)


def lean(sent: str) -> str:
    """What shows the same on a terminal without colours and attributes in force, and leaves it so."""
    first, *rest = _SGR.split(sent)
    parts, now, wanted = [first], "", ""
    for codes, text in zip(rest[::2], rest[1::2], strict=True):
        if codes.startswith("0") or not codes:
            wanted = codes.lstrip("0").lstrip(";")
        else:
            wanted = f"{wanted};{codes}" if wanted else codes
        unseen = _INVISIBLE.fullmatch(text) or (text.isspace() and _same_for_blanks(now, wanted))
        if wanted != now and not unseen:
            parts.append(_change(now, wanted))
            now = wanted
        parts.append(text)
    return "".join([*parts, _change(now, "")] if now else parts)


@lru_cache(maxsize=1024)
def _change(now: str, wanted: str) -> str:
    """What leads from some codes in force to others."""
    before, after = _COLOURS.fullmatch(now), _COLOURS.fullmatch(wanted)
    if not (wanted and before and after):  # attributes can only be switched off together
        return f"\x1b[0;{wanted}m" if now and wanted else f"\x1b[{wanted or 0}m"
    pairs = zip(before.groups(), after.groups(), ("39", "49"), strict=True)
    return f"\x1b[{';'.join(new or default for old, new, default in pairs if old != new)}m"


@lru_cache(maxsize=1024)
def _same_for_blanks(now: str, wanted: str) -> bool:
    """Whether nothing differs but the colour of letters."""
    before, after = _COLOURS.fullmatch(now), _COLOURS.fullmatch(wanted)
    return before is not None and after is not None and before[2] == after[2]
