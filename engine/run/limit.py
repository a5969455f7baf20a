"""A limit on a drift has three outcomes: below it, above it, or the record cannot tell."""

import math

LONGEST = 1e4  # records of this many times the length are no advice


def drift_flaw(slope: float | None, bound: float | None, limit: float) -> str:
    """Return why a drift is not known to be at most `limit`, a clause; "" if it is.

    |slope| is below `bound` at 99 %.  All three are in one unit.
    """
    if slope is None or bound is None or not (math.isfinite(slope) and math.isfinite(bound)):
        return f"cannot tell whether the energy drifts by more than {limit:.3g}: no line fits it"
    size = abs(slope)
    if bound <= limit:
        return ""
    if 2 * size - bound > limit:
        return f"the energy drifts by {slope:+.3g}, more than {limit:.3g}"
    # The uncertainty of a slope in white noise falls like length**-1.5.
    longer = math.inf
    if size != limit:
        longer = math.ceil(((bound - size) / abs(limit - size)) ** (2 / 3))
    advice = "a longer record may not help"
    if longer <= LONGEST:
        advice = f"that takes a record about {longer} times as long"
    return (
        f"cannot tell whether the energy drifts by more than {limit:.3g}: this record sees drifts "
        f"above {bound:.2g}; {advice}"
    )
