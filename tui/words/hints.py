"""Three hints for the first minute, each once, and only where one has not found out already."""

from collections.abc import Iterable

from recordings.events import Event, EventKind

SHOWN = 6.0  # s that a hint stays

HINTS: tuple[tuple[float, EventKind, str], ...] = (
    (24.0, "pause", "Press space to pause; . and , then go step by step."),
    (38.0, "set_h", "Press + for a larger step: who still keeps the energy?"),
    (52.0, "start", "Click anywhere in phase space (F3) to start from there."),
)
"""When, in s since the lab is on screen; what shows that it is known; and the hint."""


def hint(seconds: float, events: Iterable[Event]) -> str:
    """The hint that is due; "" if none is."""
    for begin, kind, text in HINTS:
        if begin <= seconds < begin + SHOWN:
            known = any(event.kind == kind and (kind != "start" or event.run > 1) for event in events)
            return "" if known else text
    return ""
