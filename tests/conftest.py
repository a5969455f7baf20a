import os

import pytest
from hypothesis import settings

# A deadline judges how busy the machine is, not the code: everything here runs beside other work.
# In CI the same examples are tried each time, so that only a change can make it fail.
settings.register_profile("pendu", deadline=None, derandomize=bool(os.environ.get("CI")))
settings.load_profile("pendu")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--snapshot-update",
        action="store_true",
        help="store pictures of the screen as they look now",
    )
