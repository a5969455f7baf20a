"""Verify: simulate a recording's runs again from their events, and compare every sample bit for bit."""

from dataclasses import dataclass
from pathlib import Path

from recordings.errors import RecordingError, named
from recordings.events import Event
from recordings.format import sin_fingerprint
from recordings.lock import open_file
from recordings.rerun import Difference, Rerun
from recordings.scan import Gap, Scan, ShowProgress


@dataclass(frozen=True, slots=True)
class Verification:
    """What came of it.  Complete and identical: nothing was changed since it was recorded, and nothing is missing."""

    file: Path
    complete: bool  # finished, and every checksum right
    reason: str | None  # why not, a clause
    runs: int
    samples: int
    same_sin: bool
    identical: bool  # every sample, to the last bit, or within the tolerance where sin differs; and no damage
    max_difference: float  # of any number, in its unit, within tolerance or not
    first_difference: Difference | None


def verify(path: Path, progress: ShowProgress | None = None) -> Verification:
    """Verify a recording up to where it is first damaged.

    Raises RecordingError for what is no recording, or breaks the rules of one, or has no samples.
    """
    with named(path), open_file(path) as stream:
        scan = Scan(stream, progress)
        runs = samples = 0
        same_sin = True
        max_difference = 0.0
        first: Difference | None = None
        rerun: Rerun | None = None
        for piece in scan:
            if isinstance(piece, Gap):
                break
            same_sin = piece.layout.sin == sin_fingerprint()
            for _, (_, value) in piece.layout.entries(piece.chunk.messages):
                if isinstance(value, Event) and value.kind == "start":
                    if rerun is not None and value.run <= rerun.run:
                        raise RecordingError("its runs are not in order")
                    rerun = Rerun(value, exact=same_sin)
                    runs += 1
                if rerun is None or value.run != rerun.run:
                    raise RecordingError(f"something of run {value.run} lies outside of it")
                if isinstance(value, Event):
                    rerun.follow(value)
                    continue
                samples += 1
                for difference in rerun.compare(value):
                    first = first or difference
                max_difference = max(max_difference, rerun.max_difference)
        if samples == 0:
            raise scan.nothing("verified")
        return Verification(
            file=path,
            complete=scan.complete,
            reason=scan.reason,
            runs=runs,
            samples=samples,
            same_sin=same_sin,
            identical=first is None and not scan.damaged,
            max_difference=max_difference,
            first_difference=first,
        )
