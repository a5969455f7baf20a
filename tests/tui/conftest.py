import asyncio
import difflib
import pickle
from collections.abc import AsyncIterator, Callable, Iterator
from itertools import islice
from pathlib import Path

import pytest
from textual import _wait

# Textual's pilot waits until the processor was idle for so long; tests of keys would take twice as
# long with its 20 ms.
_wait.SLEEP_GRANULARITY = 0.004  # s
_wait.SLEEP_IDLE = _wait.SLEEP_GRANULARITY / 20

SNAPSHOTS = Path(__file__).parent / "snapshots"

_computed: dict[bytes, list[object]] = {}


async def computed_here(
    function: Callable[..., Iterator[object]], *arguments: object
) -> AsyncIterator[object]:
    """Compute as tui.views.background.computed does, but in a thread, and keep the results.

    Another process takes seconds to import everything, and many tests need the same map.
    """
    task = pickle.dumps((function, arguments))
    for item in _computed.get(task, ()):
        yield item
    if task not in _computed:
        items = function(*arguments)
        computed = []
        while (item := await asyncio.to_thread(next, items, None)) is not None:
            computed.append(item)
            yield item
        _computed[task] = computed


@pytest.fixture(autouse=True)
def _views_compute_here(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.node.get_closest_marker("other_process") is None:
        monkeypatch.setattr("pendu_tui.tui.views.background.computed", computed_here)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which is that of the recordings, too."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    return tmp_path


@pytest.fixture
def uncomputed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Views get no results."""

    async def nothing(*_: object) -> AsyncIterator[object]:
        return
        yield

    monkeypatch.setattr("pendu_tui.tui.views.background.computed", nothing)


@pytest.fixture
def snapshot(request: pytest.FixtureRequest) -> Callable[[str, str], None]:
    """Compare a text with the file of that name; --snapshot-update writes the file."""

    def hold(name: str, text: str) -> None:
        path = SNAPSHOTS / name
        if request.config.getoption("--snapshot-update"):
            path.write_text(text, encoding="utf-8", newline="\n")
        stored = path.read_text(encoding="utf-8")
        if stored != text:
            diff = difflib.unified_diff(stored.splitlines(), text.splitlines(), lineterm="", n=0)
            first = [line[:200] for line in islice(diff, 40)]  # those of an SVG are long
            pytest.fail("\n".join([f"{name} looks different:", *first]), pytrace=False)

    return hold
