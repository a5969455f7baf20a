import os
import signal

import pytest
from hypothesis import settings

# A deadline judges how busy the machine is, not the code: everything here runs beside other work.
# In CI the same examples are tried each time, so that only a change can make it fail.
settings.register_profile(
    "pendu", deadline=None, max_examples=40, derandomize=bool(os.environ.get("CI"))
)
settings.load_profile("pendu")


if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in a job that a script put aside
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_xdist_auto_num_workers() -> int:
    """Twice the processors: half of the time of a test of a screen is spent waiting."""
    return 2 * (os.cpu_count() or 1)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--snapshot-update",
        action="store_true",
        help="store pictures of the screen as they look now",
    )
