"""What a recording vouches for: counts and a SHA-256 of what it holds, and the functions that its bits depend on.

The last message of every chunk is a seal.  Its digest is over all records in chunks before it and over the metadata,
in the order of the file, so an unfinished file is covered up to its last chunk.  It shows what was changed, left
out or added by somebody who did not recompute the digest; against one who did it proves nothing.
"""

import hashlib
import math
import platform
import struct
import time
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import version
from io import BytesIO
from typing import Any

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode

from engine.scenes import Scene
from recordings.fields import SCENE_NUMBERS
from recordings.format import FORMAT_VERSION

WallClock = Callable[[], int]  # ns since 1970

FUNCTIONS = ("sin", "sqrt")
"""What the simulation takes from this machine's libraries, besides + - * /, which are the same everywhere."""


_MESSAGE = struct.Struct("<BQHIQQ")  # opcode, length; channel, sequence, log_time [ns], publish_time [ns]
MESSAGE_SIZE = _MESSAGE.size  # bytes of a message's record before its data


class Digest:
    """The SHA-256 of records, in the order of the file."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()
        self._waiting = BytesIO()

    def message(self, channel: int, sequence: int, log_time: int, publish_time: int, data: bytes) -> None:
        """Add a message's record."""
        head = _MESSAGE.pack(Opcode.MESSAGE, MESSAGE_SIZE - 9 + len(data), channel, sequence, log_time, publish_time)
        self._waiting.write(head)
        self._waiting.write(data)

    def record(self, record: Any) -> None:
        """Add one of mcap's records."""
        builder = RecordBuilder()
        record.write(builder)
        self._waiting.write(builder.end())  # type: ignore[no-untyped-call]

    def add(self, data: "bytes | memoryview") -> None:
        """Add records as bytes."""
        self._hash.update(data)

    @property
    def sha256(self) -> str:
        """Of everything so far."""
        self._hash.update(self._waiting.getbuffer())
        self._waiting = BytesIO()
        return self._hash.hexdigest()


@cache
def fingerprint(function: str) -> str:
    """A checksum of this machine's sin or sqrt from 1e-8 to 1e8, at 4096 places: where it differs, so do runs' bits.

    Another libm, or the same one on another processor, rounds one sine in 1400 the other way.
    """
    arguments = ((-1) ** i * 10 ** (i / 256 - 8) * 1.1 for i in range(4096))
    if function == "sqrt":
        arguments = (abs(x) for x in arguments)
    values = map(getattr(math, function), arguments)
    return hashlib.sha256(struct.pack("<4096d", *values)).hexdigest()[:16]


def fingerprints() -> dict[str, str]:
    """Those of all FUNCTIONS."""
    return {function: fingerprint(function) for function in FUNCTIONS}


def other_functions(recorded: Mapping[str, str]) -> tuple[str, ...]:
    """Those that this machine computes differently, by their fingerprints.  Format 1 states that of sin only."""
    here = fingerprints()
    return tuple(name for name in dict.fromkeys(("sin", *recorded)) if recorded.get(name) != here[name])


@cache
def program_version() -> str:
    """The version of this program."""
    return version("pendu-tui")


def facts_of(scene: Scene, wall: WallClock | None) -> dict[str, str]:
    """For people.  Verification needs only the fingerprints, and takes them from the events' channel."""
    metadata = {
        "format": str(FORMAT_VERSION),
        **fingerprints(),
        "pendu-tui": program_version(),
        "scene": scene.name,
        "model": scene.model,
    }
    for name in SCENE_NUMBERS:
        metadata[f"{name}.hex"] = float.hex(float(getattr(scene, name)))
    if wall is not None:
        metadata["started"] = time.strftime("%Y-%m-%dT%H:%M:%S%z", time.localtime(wall() / 1e9))
        metadata["python"] = platform.python_version()
        metadata["platform"] = f"{platform.system()} {platform.machine()}"
    return metadata
