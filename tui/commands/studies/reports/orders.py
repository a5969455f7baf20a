"""Remarks of `accuracy` on measured orders that differ from the claimed ones."""

import math
from collections.abc import Iterator, Sequence

from engine.accuracy.study import Order
from engine.methods import Method
from engine.methods.euler import SYMPLECTIC_EULER
from engine.methods.own import OwnMethod
from engine.scenes import Scene

APART = 0.25  # of two orders; larger differences get a remark


def claimed(method: Method) -> int | None:
    """The claimed order; nothing is claimed of a user's own method."""
    return None if isinstance(method, OwnMethod) else method.order


def order_remarks(scene: Scene, orders: Sequence[Order]) -> Iterator[str]:
    """Why a measured order is not the claimed one."""
    for method, measured in orders:
        order = claimed(method)
        if measured is None or order is None or abs(measured - order) < APART:
            continue
        why = "its errors do not follow a single power over these h"
        if method == SYMPLECTIC_EULER and math.remainder(scene.theta, math.pi) == 0:
            why = "from theta = 0 its angles are velocity Verlet's"
        elif not method.symplectic and round(measured) == order + 1:
            why = f"near the upright position the phase depends on the energy, which it loses as h^{measured:.0f}"
        yield f"{method.label} reads {measured:.2f}, not {order}: {why}"
