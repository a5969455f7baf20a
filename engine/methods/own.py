"""A user's own method: a generator function from a file, whose numbers are checked in use.

Its code is executed like any Python.  Other processes receive the text and compile it again.
"""

import linecache
import math
import reprlib
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, wraps
from inspect import CO_GENERATOR, unwrap
from traceback import format_exception_only, walk_tb
from typing import Any

from pendu_tui.engine.methods.method import Measured, Method, Phases
from pendu_tui.engine.models.model import Force, Offer, Phase

MAX_SOURCE = 30_000  # characters, some ten pages; recordings keep the text
MAX_TIME = 3.0  # s, for a step
FORM = "write `while True:` with the formulas and `yield theta, omega`"


class OwnMethodError(Exception):
    """A user's method is wrong; the text is a sentence for the user."""


class TooLongError(BaseException):
    """A user's code takes too long.  It is no Exception, which that code might catch."""

    def __str__(self) -> str:
        return f"takes more than {MAX_TIME:g} s"


class _UserCode:
    """A context in which a user's code runs, and writes to stderr, since stdout is for results.

    Contexts within another are part of it.
    """

    def __init__(self) -> None:
        self.depth = 0
        self.count = 0  # of contexts begun
        self._stdout = sys.stdout

    def __enter__(self) -> None:
        if self.depth == 0:
            self.count += 1
            self._stdout = sys.stdout
            sys.stdout = sys.stderr
        self.depth += 1

    def __exit__(self, *_: object) -> None:
        self.depth -= 1
        if self.depth == 0:
            sys.stdout = self._stdout


USER_CODE = _UserCode()


@dataclass(frozen=True, repr=False)
class OwnMethod(Method):
    """A user's method.  Its fields are measured."""

    measured: Measured
    source: str  # the text of the file
    file: str  # its name

    @property
    def sha256(self) -> str:
        """The digest of the source in UTF-8, in hexadecimal."""
        import hashlib  # slow

        return hashlib.sha256(self.source.encode()).hexdigest()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the text, because executed functions have no module."""
        return own_method, (self.source, self.key, self.letter, self.file, self.measured)


@cache
def own_method(source: str, key: str, letter: str, file: str, measured: Measured) -> OwnMethod:
    """Return the method of a measured text, the same for equal texts."""
    function = own_function(source, key, file)
    others: dict[Offer, Phases] = {}
    if takes_rates(function):
        others["rates"] = function
    name = key.replace("_", " ").strip()
    return OwnMethod(
        key=key,
        label=name[:1].upper() + name[1:],
        letter=letter,
        phases=on_force(function),
        others=others,
        models=(*Method.models, "damped") if others else Method.models,
        formula=(function.__doc__ or "").strip().partition("\n")[0],
        order=max(0, round(measured.order or 0)),
        force_evaluations=max(1, math.ceil(measured.force_evaluations)),
        first_same_as_last=measured.more_at_the_start > 0,
        symplectic=measured.symplectic,
        reversible=measured.reversible,
        linear_limit=measured.linear_limit,
        reference=f"{file}:{key}",
        measured=measured,
        source=source,
        file=file,
    )


def takes_rates(function: Phases) -> bool:
    """Return whether a user's function takes the rates of a phase in place of the force.

    It calls its first parameter `rates`; `rates(phase)` are the derivatives of theta and omega.
    """
    first: tuple[str, ...] = unwrap(function).__code__.co_varnames[:1]
    return first == ("rates",)


def on_force(function: Phases) -> Phases:
    """Return a user's function for a force, theta'' = force(theta)."""
    if not takes_rates(function):
        return function

    def phases(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        def rates(phase: Phase) -> Phase:
            theta, omega = phase
            return omega, force(theta)

        return function(rates, phase, h)

    return phases


def own_function(source: str, name: str, file: str) -> Phases:
    """Return the guarded generator function of this name in a text.  Raises OwnMethodError."""
    if len(source) > MAX_SOURCE:
        raise OwnMethodError(
            f"{file} is too long; use a file of at most {MAX_SOURCE:,} characters."
        )
    linecache.cache[file] = (len(source), None, source.splitlines(), file)
    namespace: dict[str, Any] = {"__name__": "own_method", "__file__": file}
    try:
        with USER_CODE:
            exec(compile(source, file, "exec"), namespace)
    except SyntaxError as error:
        raise OwnMethodError(f"{file}, line {error.lineno or 1}: {error.msg}.") from None
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise OwnMethodError(_sentence(error, file, file)) from None
    function = namespace.get(name)
    if not callable(function):
        others = [key for key, value in namespace.items() if callable(value) and key[0] != "_"]
        has = ""
        if others:
            has = f"; it has {', '.join(others)}"
        raise OwnMethodError(f"{file} has no function {name!r}{has}.")
    return guarded(function, file)


def guarded(function: Phases, file: str) -> Phases:
    """Return the function wrapped to raise OwnMethodError for errors and for wrong values.

    `file` is the name that it is compiled with.  Raises OwnMethodError.
    """
    inner = unwrap(function)
    name = getattr(inner, "__name__", "it")
    code = getattr(inner, "__code__", None)
    if code is None or not code.co_flags & CO_GENERATOR:
        what = f"{file}: {name} is not a generator function"
        raise OwnMethodError(f"{what}; make it one that takes (force, phase, h): {FORM}.")
    where = f"{file}, line {code.co_firstlineno}"

    @wraps(function)
    def phases(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        try:
            with USER_CODE:
                following = function(force, phase, h)
            while True:
                with USER_CODE:
                    value = next(following)
                yield _phase(value, phase[0], f"{where}: {name}")
        except StopIteration:
            raise OwnMethodError(f"{where}: {name} ends while the run continues; {FORM}.") from None
        except (OwnMethodError, OverflowError, KeyboardInterrupt, GeneratorExit):
            raise
        except BaseException as error:
            if _is_of_force(error, force):
                raise
            raise OwnMethodError(_sentence(error, file, where)) from None

    return phases


def _phase(value: Any, like: Any, who: str) -> Phase:
    """Return the yielded value as a phase, in the kind of numbers of the initial phase."""
    try:
        theta, omega = value
        if isinstance(like, float | complex):
            return type(like)(theta), type(like)(omega)
        if theta.shape == omega.shape == like.shape:
            return theta, omega
    except (TypeError, ValueError, AttributeError):
        pass
    raise OwnMethodError(f"{who} yields {_line(reprlib.repr(value))}; {FORM}.")


def _line(text: str) -> str:
    """Return a text in one line, without control characters."""
    return "".join(filter(str.isprintable, " ".join(text.split())))


def _is_of_force(error: BaseException, force: Force) -> bool:
    """Return whether the force raised it, as the sine of infinity does: the run has diverged."""
    if not isinstance(error, ValueError | ArithmeticError):
        return False
    codes = [frame.f_code for frame, _ in walk_tb(error.__traceback__)]
    return getattr(force, "__code__", None) in codes


def place(file: str, line: int) -> str:
    """Return where something happens in a user's file, with the text of the line."""
    return f"{file}, line {line}: `{_line(linecache.getline(file, line))}`"


def _sentence(error: BaseException, file: str, where: str) -> str:
    """Return the error with the user's line in its traceback, or else with `where`."""
    for frame, line in walk_tb(error.__traceback__):
        if frame.f_code.co_filename == file:
            where = place(file, line)
    if isinstance(error, TooLongError):
        return f"{where} {error}."
    raised = _line(format_exception_only(error)[-1])[:250]
    return f"{where} raises {raised.removesuffix('.')}."
