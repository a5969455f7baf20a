"""A limit on a measured number has three outcomes: below, above, or the record cannot tell."""

import math
from typing import Literal

Outcome = Literal["below", "above", "cannot tell"]
LONGEST = 1e4  # a record of this many times the length is no advice


def outcome(value: float | None, bound: float | None, limit: float) -> Outcome:
    """Return where a number is that is below `bound` at 99 %, and above its mirror image.

    What is not known cannot be told.
    """
    if value is None or bound is None or not (math.isfinite(value) and math.isfinite(bound)):
        return "cannot tell"
    if bound <= limit:
        return "below"
    if 2 * value - bound > limit:
        return "above"
    return "cannot tell"


def advice(value: float, bound: float, limit: float) -> str:
    """Return how long a record would tell on which side of the limit a slope is, a clause.

    The uncertainty of a slope in white noise falls like length**-1.5.
    """
    missing = abs(limit - value)
    if missing > 0:
        longer = math.ceil(((bound - value) / missing) ** (2 / 3))
        if longer <= LONGEST:
            return f"a record about {longer} times as long would tell"
    return "a longer record may not tell"
