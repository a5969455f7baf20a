"""Arithmetic: what the bits of a run depend on, apart from its inputs."""

import hashlib
import math
import struct
from functools import cache
from typing import NamedTuple

from engine.run import NUMERICS


class Arithmetic(NamedTuple):
    """The version of the numerics, and fingerprints of the library functions, that made a run.

    The simulation calls no other functions; + - * / give the same bits everywhere.
    """

    numerics: int
    sin: str
    sqrt: str

    def other_functions(self) -> tuple[str, ...]:
        """Return the names of the functions that this machine computes differently."""
        names = ("sin", "sqrt")
        return tuple(name for name in names if getattr(self, name) != fingerprint(name))


@cache
def fingerprint(function: str) -> str:
    """Return a checksum of this machine's sin or sqrt at 4096 places from 1e-8 to 1e8.

    Another libm, or the same one on another processor, rounds one sine in 1400 the other way.
    """
    places = [(-1) ** i * 10 ** (i / 256 - 8) * 1.1 for i in range(4096)]
    if function == "sqrt":
        places = list(map(abs, places))
    values = map(getattr(math, function), places)
    return hashlib.sha256(struct.pack("<4096d", *values)).hexdigest()[:16]


def arithmetic_here() -> Arithmetic:
    """Return the arithmetic of this version on this machine."""
    return Arithmetic(NUMERICS, fingerprint("sin"), fingerprint("sqrt"))
