"""A pytest plugin: a check of energies, and recordings as tests.

It is loaded by being installed (entry point `pytest11`), so it imports NumPy and the engine only
when a test uses it.
"""

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from pendu_tui.engine.library import Judged
    from pendu_tui.engine.methods.measure import Measured
    from pendu_tui.engine.methods.method import Phases
    from pendu_tui.engine.run.order import Order

ORDER_TOLERANCE = 0.1  # errors are measured at finite steps: an order of 6 reads 5.91


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
        scale: float | str = "first",
    ) -> "Judged":
        """Fail unless `pendu_tui.engine.judge` returns this verdict and a trend up to `max_drift`.

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
        self._properties += [("verdict", judged.verdict), ("slope", judged.slope)]
        if judged.verdict != verdict:
            pytest.fail(f"the verdict is not {verdict}: {judged}")
        if max_drift is not None and (judged.slope is None or abs(judged.slope) > max_drift):
            pytest.fail(f"the energies drift by more than {max_drift:g}: {judged}")
        return judged

    def check_order(
        self, runs: "Iterable[tuple[float, ArrayLike, ArrayLike]]", at_least: float
    ) -> "Order":
        """Fail unless the energy of runs (h, times, energies) fluctuates as h^`at_least` or better.

        It fails if the order and twice its uncertainty are below the limit, and if the runs are so
        short that not even an order of 0 would be.
        """
        __tracebackhide__ = True
        from pendu_tui.engine import fluctuation_order

        try:
            order = fluctuation_order(runs)
        except ValueError as error:
            raise pytest.fail.Exception(str(error)) from None
        self._properties += [("order", order.power), ("order_uncertainty", order.uncertainty)]
        if order.power + 2 * order.uncertainty < at_least:
            pytest.fail(
                f"the energy fluctuates as {order}, not as h^{at_least:g}: "
                "the runs do not solve the same equation better with smaller steps"
            )
        if 2 * order.uncertainty >= at_least:
            longer = math.ceil((4 * order.uncertainty / at_least) ** 2)
            pytest.fail(
                f"cannot tell: the energy fluctuates as {order}, and even order 0 would pass; "
                f"make the runs {longer} times as long"
            )
        return order


class MethodProperties:
    """Checks the properties of a method."""

    def __init__(self, properties: list[tuple[str, object]]) -> None:
        self._properties = properties

    def check(
        self,
        step: "Phases",
        order: float | None = None,
        symplectic: bool | None = None,
        reversible: bool | None = None,
    ) -> "Measured":
        """Fail unless a generator function (force, phase, h) has the properties that are given.

        The order may be higher, and is measured to ORDER_TOLERANCE.
        """
        __tracebackhide__ = True
        from pendu_tui.engine import measure
        from pendu_tui.engine.methods.measure import no_order

        try:
            found = measure(step)
        except ValueError as error:
            raise pytest.fail.Exception(str(error)) from None
        self._properties += found._asdict().items()
        flaws = [
            f"it is {'' if wanted else 'not '}to be {name}, and is{'' if has else ' not'}"
            for name, wanted, has in (
                ("symplectic", symplectic, found.symplectic),
                ("reversible", reversible, found.reversible),
            )
            if wanted is not None and wanted != has
        ]
        if order is not None and not (found.order or 0) > order - ORDER_TOLERANCE:
            flaws.insert(
                0, no_order(found.order) or f"its order is {found.order:.3f}, not {order:g}"
            )
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
