"""StatusLine: what runs, how fast, from which start, and the state of the recording."""

from typing import NamedTuple

from rich.style import Style

from engine.run.lockstep import Sample
from recordings.errors import printable
from tui.drawing.palette import QUIET, TEXT, WARN
from tui.drawing.picture import Picture, Row
from tui.playback.source import Source
from tui.views.view import Pane
from tui.words.findings import limit_warning
from tui.words.numbers import factor, file_size, percent, seconds, start, two_digits

SLOW = 1.0  # s of the clock from step to step: without a word, the lab would seem to stand still
BADGE = -10
"""The owner of LIVE and REPLAY."""


class _Part(NamedTuple):
    keep: int  # the smallest go first where there is no room
    text: str
    owner: int = TEXT


def speed_text(speed: float) -> str:
    """As "1×", "1/8×", "1024×", "-2×"."""
    sign, size = "-" if speed < 0 else "", abs(speed)
    return f"{sign}{factor(size)}×" if size >= 1 else f"{sign}1/{factor(1 / size)}×"


def coarse(value: float) -> str:
    """As "12 s", "3 min", "1 h 02 min"."""
    return f"{int(value)} s" if value < 60 else f"{int(value / 60)} min" if value < 3600 else seconds(value)


def status_row(source: Source, width: int) -> Row:
    """The line, as far as there is room."""
    scene, playhead, pace, recording = source.scene, source.playhead, source.pace, source.recording_status
    z, live, named = abs(source.stepping.h) * scene.equations.fastest, source.kind == "LIVE", bool(scene.watch)
    warning = limit_warning(source.scene.cast, [abs(h) * scene.equations.fastest for h in source.stepping.own])
    parts = [
        _Part(12, "paused " if playhead.paused else "backwards" if source.stepping.h < 0 else "running"),
        _Part(7, speed_text(playhead.speed)),
        _Part(11, f"t {seconds(source.sample.t)}"),
        _Part(11, f"h {source.stepping.h:.4g} s{' equal cost' if source.stepping.equal_cost else ''}"),
        _Part(10, f"{'h·omega_s' if scene.model == 'spring' else 'z'} {z:.3g}", WARN if warning else TEXT),
        *([_Part(9, warning, WARN)] if warning else []),
        _Part(6 if named else 3, f"scene {scene.name}" if named else f"{scene.name} scene", QUIET),
        _Part(4 if named else 6, start(scene.theta, scene.omega)),
    ]
    if pace.share < 0.99:
        reached = playhead.speed * pace.share
        share = f"only {percent(pace.share)} of" if pace.share >= 0.095 else f"reached {two_digits(abs(reached))}× of"
        parts.insert(2, _Part(10, f"{share} {speed_text(playhead.speed)}", WARN))
    if not playhead.paused and abs(source.stepping.h / playhead.speed) >= SLOW and source.next_step is not None:
        parts.append(_Part(9, f"next step in {coarse(max(source.next_step, 0.0))}"))
    if recording is None:
        parts += [_Part(8, "not recorded", QUIET)] if playhead.seen is not None else []  # else it is yet to begin
    elif recording.failed:
        parts.append(_Part(10, "NOT RECORDED", WARN))
    else:
        if live:
            parts.append(_Part(8, f"REC {coarse(recording.seconds)}"))
        parts.append(_Part(2, file_size(recording.bytes), QUIET))
        parts.append(_Part(1, printable(recording.name), QUIET))
    badge = f" {source.kind} "
    while parts and len(badge) + sum(len(part.text) + 2 for part in parts) > width:
        parts.remove(min(parts))
    return [(badge, BADGE), *((text, owner) for part in parts for text, owner in (("  ", TEXT), part[1:]))]


class StatusLine(Pane):
    """The line; LIVE and REPLAY stand out."""

    def paint(self, source: Source, sample: Sample) -> None:
        self.show(Picture([status_row(source, self.room.width)]))

    def style_of(self, owner: int, base: Style) -> Style:
        if owner == BADGE:
            return super().style_of(WARN, base) + Style(reverse=True, bold=True)
        return super().style_of(owner, base)
