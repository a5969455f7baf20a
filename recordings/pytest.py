"""A pytest plugin: a check of energies, and recordings as tests.

It is loaded by being installed (entry point `pytest11`), so it imports NumPy and the engine only when
a test uses it.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from pendu_tui.engine.library import Judged


class EnergyDrift:
    """Checks the energies of one test."""

    def __init__(self, properties: list[tuple[str, object]]) -> None:
        self._properties = properties

    def check(
        self,
        times: "ArrayLike",
        energies: "ArrayLike",
        verdict: str = "bounded",
        max_drift: float | None = None,
        scale: float | str = "std",
    ) -> "Judged":
        """Fail unless `pendu_tui.engine.judge` returns this verdict and a trend of at most `max_drift`.

        The trend is that of the energies over the scale, per unit of time.
        """
        __tracebackhide__ = True
        from pendu_tui.engine import judge
        from pendu_tui.engine.run.verdicts import VERDICTS

        if verdict not in VERDICTS:
            pytest.fail(f"there is no verdict {verdict!r}; choose from {', '.join(VERDICTS)}")
        try:
            judged = judge(times, energies, scale)
        except ValueError as error:
            raise pytest.fail.Exception(str(error)) from None
        self._properties += [("verdict", judged.verdict), ("trend", judged.trend)]
        if judged.verdict != verdict:
            pytest.fail(f"the verdict is not {verdict}: {judged}")
        if max_drift is not None and (judged.trend is None or abs(judged.trend) > max_drift):
            pytest.fail(f"the energies drift by more than {max_drift:g}: {judged}")
        return judged


@pytest.fixture
def energy_drift(request: pytest.FixtureRequest) -> EnergyDrift:
    """Give a test `energy_drift.check(times, energies)`."""
    return EnergyDrift(request.node.user_properties)


def verify_recordings(folder: str | Path) -> Callable[[Any], None]:
    """Return a test of each recording below a folder: `test_... = verify_recordings(FOLDER)`.

    It fails if a recording is damaged or is not reproduced to the bit, and if there is none.
    """
    names = sorted(path.relative_to(folder).as_posix() for path in Path(folder).rglob("*.mcap"))

    @pytest.mark.parametrize("name", names or [""], ids=names or ["none"])
    def test(name: str) -> None:
        if not name:
            pytest.fail(f"there is no recording (*.mcap) in {folder}", pytrace=False)
        if flaw := _flaw(Path(folder, name)):
            pytest.fail(flaw, pytrace=False)

    return test


def _flaw(path: Path) -> str:
    """Return what is wrong with a recording; "" if nothing is."""
    from pendu_tui.recordings.errors import RecordingError
    from pendu_tui.recordings.verification import verify

    try:
        verification = verify(path)
    except RecordingError as error:
        return str(error)
    if first := verification.first_difference:
        where = f"run {first.run}, step {first.step}, t = {first.t:g} s"
        numbers = f"{first.computed!r}, recorded {first.recorded!r}"
        return f"{path}: {where}, {first.method} {first.field} is {numbers}"
    if verification.reason:
        return f"{path}: {verification.reason}"
    return ""
