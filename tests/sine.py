"""A mark for tests whose last digits or chaos only a well rounded sine gives."""

import math

import mpmath
import pytest

ANGLES = [0.37 * number + 0.001 * number**2 for number in range(1000)]
MISROUNDED = sum(math.sin(angle) != float(mpmath.sin(angle)) for angle in ANGLES)
needs_rounded_sine = pytest.mark.skipif(
    MISROUNDED > 10,  # glibc's 1, msvcrt's of Wine 36
    reason="sine: this C library's is often wrong in the last digit",
)
