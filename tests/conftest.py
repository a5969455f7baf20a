import gc
import os
import signal
import sys
from pathlib import Path

import pytest
from hypothesis import settings

import pendu_tui.engine
from pendu_tui.engine.methods.measure import examined
from pendu_tui.engine.methods.own import own_function
from pendu_tui.tui.cli import cast, watchdog

CHECKOUT = Path(__file__).resolve().parent.parent
TESTED = Path(str(pendu_tui.engine.__file__)).resolve().parent.parent
if TESTED != CHECKOUT:
    raise pytest.UsageError(
        f"these tests would test the pendu-tui in {TESTED}, not this checkout;"
        " run `pip install -e '.[test]'` here."
    )

# Many tests start a process, which would compile the program again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# Tests leave little garbage; looking for it would take a tenth of the time of those of screens.
gc.set_threshold(20_000)

# No deadline, which a busy machine would miss.  CI tries the same examples each time, so that only a
# change of the code can make it fail.
settings.register_profile(
    "pendu", deadline=None, max_examples=40, derandomize=bool(os.environ.get("CI"))
)
settings.load_profile("pendu")


if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in a script's background job
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):  # which nohup ignores
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Return half more than there are processors, as tests of screens wait."""
    if config.getoption("--snapshot-update"):
        return 0  # some tests write to the same file
    return round(1.5 * (os.cpu_count() or 1))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--snapshot-update",
        action="store_true",
        help="run what compares with stored files, and store them as they are now",
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--snapshot-update"):
        items[:] = [
            each for each in items if "snapshot" in each.fixturenames or "json_field" in each.name
        ]


@pytest.fixture(autouse=True)
def _tests_are_importable(monkeypatch):
    """Undo what trying a user's method sets, so that other processes can import `tests`."""
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)


@pytest.fixture(autouse=True)
def _methods_are_tried_here(request, monkeypatch):
    """Try a user's method in the test's process, unwatched: each other one takes half a second."""

    def tried(source, key, file):
        return examined(own_function(source, key, file), f"{file}: {key}")

    if request.node.get_closest_marker("other_process") is None:
        monkeypatch.setattr(cast, "_tried", tried)
        monkeypatch.setattr(watchdog, "watch_calls_in_c", bool)


@pytest.fixture(autouse=True)
def _no_own_method_is_known(monkeypatch):
    monkeypatch.setattr("pendu_tui.recordings.events._own", {})
