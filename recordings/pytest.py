"""A pytest plugin: a check of energies, and recordings as tests.

It is loaded by being installed (entry point `pytest11`), so it imports NumPy and the engine only
when a test uses it.
"""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from pendu_tui.engine.library import Judged
    from pendu_tui.engine.methods.method import Measured, Phases
    from pendu_tui.engine.run.record import Order

ORDER_TOLERANCE = 0.1  # errors are measured at finite steps: an order of 6 reads 5.91

NO_RECORDING = "no recording"  # the name of the test that fails for want of one


class _Checks:
    def __init__(self, properties: list[tuple[str, object]]) -> None:
        self._properties = properties  # of the test, in pytest's reports


class EnergyDrift(_Checks):
    """Checks the energies of one test."""

    def check(
        self,
        times: "ArrayLike",
        energies: "ArrayLike",
        verdict: str | Sequence[str] = "bounded",
        max_drift: float | None = None,
        max_error: float | None = None,
        max_fluctuation: float | None = None,
        scale: float | str = "first",
    ) -> "Judged":
        """Fail unless `pendu_tui.engine.judge` returns one of these verdicts, and each limit holds.

        Limits are those of energies over the scale: `max_drift` of the magnitude of the slope, per
        unit of time, `max_error` of the distance from the first energy, and `max_fluctuation` of
        the standard deviation about a line.  A slope is within its limit only if its bound is.
        """
        __tracebackhide__ = True
        from pendu_tui.engine import judge
        from pendu_tui.engine.inputs import check_name
        from pendu_tui.engine.run.verdicts import UNDECIDED, VERDICTS, not_within

        wanted = [verdict] if isinstance(verdict, str) else verdict
        try:
            for word in wanted:
                check_name("verdict", word, VERDICTS)
            judged = judge(times, energies, scale)
        except ValueError as error:
            raise pytest.fail.Exception(str(error)) from None
        self._properties += [("verdict", judged.verdict), ("slope", judged.slope)]
        flaws = []
        if max_drift is not None:
            slope = judged.slope and abs(judged.slope)
            flaws.append(not_within(max_drift, "the drift", slope, judged.bound))
        for name, value, limit in (
            ("error", judged.max_error, max_error),
            ("fluctuation", judged.fluctuation, max_fluctuation),
        ):
            if limit is not None and not (value is not None and value <= limit):
                flaws.append(f"the {name} is {value}, more than {limit:g}")
        if judged.verdict not in wanted:
            told = "cannot tell: " if judged.verdict == UNDECIDED else ""
            flaws.insert(0, f"{told}the verdict is not {' or '.join(wanted)}")
        if found := "; ".join(filter(None, flaws)):
            pytest.fail(f"{found}\n{judged}")
        return judged

    def check_order(
        self, runs: "Iterable[tuple[float, ArrayLike, ArrayLike]]", at_least: float
    ) -> "Order":
        """Fail unless the energy of runs (h, times, energies) fluctuates as h^`at_least` or better.

        It fails if the order plus twice its uncertainty is below the limit, and if the runs are so
        short that they cannot distinguish one order from the next.
        """
        __tracebackhide__ = True
        from pendu_tui.engine import fluctuation_order

        try:
            order = fluctuation_order(runs)
        except ValueError as error:
            raise pytest.fail.Exception(str(error)) from None
        self._properties += [("order", order.power), ("order_uncertainty", order.uncertainty)]
        if order.highest is None:
            pytest.fail(order.doubt)
        if not order.highest >= at_least:
            pytest.fail(
                f"the energy fluctuates as {order}, not as h^{at_least:g}: "
                "smaller steps do not improve the runs as they should"
            )
        return order


class MethodProperties(_Checks):
    """Checks the properties of a method."""

    def check(
        self,
        step: "Phases",
        order: float | None = None,
        symplectic: bool | None = None,
        reversible: bool | None = None,
    ) -> "Measured":
        """Fail unless a generator function (force, phase, h) has the properties given.

        The order may be higher, and is measured to ORDER_TOLERANCE.
        """
        __tracebackhide__ = True
        from pendu_tui.engine import measure
        from pendu_tui.engine.methods.method import no_order

        try:
            found = measure(step)
        except ValueError as error:
            raise pytest.fail.Exception(str(error)) from None
        self._properties += found._asdict().items()
        flaws = []
        if order is not None and not (found.order or 0) > order - ORDER_TOLERANCE:
            flaws.append(no_order(found.order) or f"its order is {found.order:.3f}, not {order:g}")
        for name, wanted in (("symplectic", symplectic), ("reversible", reversible)):
            has = getattr(found, name)
            if wanted not in (None, has):
                flaws.append(f"{name} is {has}, not {wanted}")
        if flaws:
            name = getattr(step, "__name__", "the method")
            pytest.fail(f"{name}: {'; '.join(flaws)}\n{found}")
        return found


@pytest.fixture
def method_properties(request: pytest.FixtureRequest) -> MethodProperties:
    """Give a test `method_properties.check(step, order=2, symplectic=True)`."""
    return MethodProperties(request.node.user_properties)


@pytest.fixture
def energy_drift(request: pytest.FixtureRequest) -> EnergyDrift:
    """Give a test `energy_drift.check(times, energies)`."""
    return EnergyDrift(request.node.user_properties)


def verify_recordings(folder: str | Path) -> Callable[[Any], None]:
    """Return a test of each recording below a folder: `test_... = verify_recordings(FOLDER)`.

    It fails if a recording is damaged or is not reproduced bit for bit, and if there is none.
    """
    names = sorted(path.relative_to(folder).as_posix() for path in Path(folder).rglob("*.mcap"))

    @pytest.mark.parametrize("name", names or [NO_RECORDING])
    def test(name: str) -> None:
        if name == NO_RECORDING:
            pytest.fail(f"{folder}: there is no recording below this folder", pytrace=False)
        if flaw := _flaw(Path(folder, name)):
            pytest.fail(flaw, pytrace=False)

    return test


def _flaw(path: Path) -> str:
    """Return what is wrong with a recording; "" if nothing is."""
    from pendu_tui.recordings.files import RecordingError
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
