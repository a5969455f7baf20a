"""The methods, one family a file, and the list that everything else derives from.

A method is a generator function (force, phase, h) -> phases, written as in the book, with only
+ - * / on the phase and never `+=`, which would change arrays in place.  So it runs unchanged on
floats, NumPy arrays, complex numbers, mpmath numbers and under Numba.  The families
"friction", "step doubling", "precision", "fast and slow parts" and "learned" are made for one scene
each.
"""

import copyreg
import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence

from pendu_tui.engine.inputs import InputError, nearest
from pendu_tui.engine.methods import implicit, learned, parts, runge_kutta, splitting, verlet
from pendu_tui.engine.methods.method import Method as Method
from pendu_tui.engine.methods.parts import TAYLOR_20 as TAYLOR_20
from pendu_tui.engine.methods.runge_kutta import EXPLICIT_EULER, RK4
from pendu_tui.engine.methods.verlet import SYMPLECTIC_EULER, VELOCITY_VERLET

Cast = tuple[Method, ...]
"""The methods of a run, in order."""

FAMILIES: dict[str, Cast] = {
    "Euler": (EXPLICIT_EULER, SYMPLECTIC_EULER),
    "Verlet": verlet.FAMILY,
    "Runge-Kutta": runge_kutta.FAMILY,
    "splitting": splitting.FAMILY,
    "implicit": implicit.FAMILY,
    "friction": parts.FRICTION,
    "step doubling": verlet.STEP_DOUBLING,
    "precision": verlet.PRECISION,
    "fast and slow parts": parts.FAST_AND_SLOW,
    "learned": learned.FAMILY,
}

METHODS: Cast = tuple(method for family in FAMILIES.values() for method in family)

GENERAL: Cast = tuple(method for method in METHODS if method.general)
"""The methods for any force and any numbers."""

USUAL_CAST: Cast = (EXPLICIT_EULER, SYMPLECTIC_EULER, VELOCITY_VERLET, RK4)


def method_of(key: str) -> Method:
    """Return the method of a key.  Raises KeyError."""
    return _BY_KEY[key]


def named(name: str, methods: Sequence[Method] = METHODS, model: str | None = None) -> Method:
    """Return the method with a name, or whose key, or a word in it, starts like this.

    Raises InputError, which suggests methods for the model if it is given.
    """
    found = matching(name, methods)
    if len(found) == 1:
        return found[0]
    if found:
        keys = " or ".join(method.key for method in found)
        raise InputError(f"{name!r} may be {keys}; type more of it.")
    if matching(name, (TAYLOR_20,)):
        raise InputError(
            "the Taylor series has no force evaluations to count; see it with pendu-tui accuracy "
            "--cost seconds --methods taylor_20,rk4."
        )
    suited = [method for method in methods if model is None or model in method.models]
    known = {simplified(each): method.key for method in suited for each in method.names}
    near = nearest(simplified(name), known)
    advice = f"; choose from {', '.join(method.key for method in suited)}."
    if near:
        advice = f": did you mean {known[near]}?"
    raise InputError(f"there is no method {name!r}{advice}")


def all_named(
    names: Iterable[str], methods: Sequence[Method] = METHODS, model: str | None = None
) -> Cast:
    """Return the methods of names, as `named` does.  Raises InputError, also if two are one."""
    cast: list[Method] = []
    for name in names:
        method = named(name, methods, model)
        if method in cast:
            raise InputError(f"{method.key} is given twice; name each method once.")
        cast.append(method)
    if not cast:
        raise InputError("no method is given; name at least one, for example rk4.")
    return tuple(cast)


def family_of(key: str) -> str:
    """Return a method's family."""
    found = (name for name, some in FAMILIES.items() if key in [each.key for each in some])
    return next(found, "your own")


def matching(name: str, methods: Sequence[Method] = METHODS) -> list[Method]:
    """Return the one method of this name, or those in whose keys a word starts with it.

    Case, accents and hyphens do not count.  Methods for one scene match only if no general one
    does, and later words of keys only if no first one does.
    """
    wanted = simplified(name)
    for method in methods:
        if wanted in map(simplified, method.names):
            return [method]
    if not wanted:
        return []
    general = [method for method in methods if method.general]
    for candidates in (general, methods):
        keys = {method: simplified(method.key) for method in candidates}
        matches = [method for method, key in keys.items() if key.startswith(wanted)]
        matches = matches or [method for method, key in keys.items() if f" {wanted}" in key]
        if matches:
            return matches
    return []


def simplified(name: str) -> str:
    """Return a name in lower case, without accents, its words separated by single spaces."""
    letters = unicodedata.normalize("NFKD", name.casefold())
    return " ".join(re.findall(r"[a-z0-9]+", letters.encode("ascii", "ignore").decode()))


_BY_KEY = {method.key: method for method in (*METHODS, TAYLOR_20)}


def _by_key(method: Method) -> tuple[Callable[[str], Method], tuple[str]]:
    """Pickle a method of METHODS by its key: builders' functions have no importable name."""
    if method.key not in _BY_KEY:
        from pendu_tui.engine.methods.own import OwnMethodError

        raise OwnMethodError(
            f"It needs the file of the method {method.key}: give it with --method "
            f"FILE.py:{method.key}."
        )
    return method_of, (method.key,)


copyreg.pickle(Method, _by_key)
