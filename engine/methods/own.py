"""A user's own method: a generator function from a file, measured, its numbers checked in use.

Its code is executed like any Python.  Other processes receive the text and compile it again.
"""

import copyreg
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, wraps
from inspect import CO_GENERATOR
from numbers import Complex, Real
from typing import TYPE_CHECKING, Any

from pendu_tui.engine.methods.method import Method, Phases
from pendu_tui.engine.models.model import Force, Phase

if TYPE_CHECKING:  # it brings NumPy
    from pendu_tui.engine.methods.measure import Measured

MAX_SOURCE = 30_000  # characters, some ten pages; recordings keep the text


class OwnMethodError(Exception):
    """A user's method is wrong; the text is a sentence for the user."""


class TooLongError(BaseException):
    """A user's code takes too long.  It is no Exception, which that code might catch."""

    why = ""  # continues a sentence: takes more than 3 s for a step

    def __str__(self) -> str:
        return self.why


class _UserCode:
    """A context in which a user's code runs, and writes to stderr, since stdout is for results."""

    def __init__(self) -> None:
        self.is_running = False
        self.steps = 0  # begun
        self._stdout = sys.stdout

    def __enter__(self) -> None:
        self._stdout = sys.stdout
        sys.stdout = sys.stderr
        self.steps += 1
        self.is_running = True

    def __exit__(self, *_: object) -> None:
        self.is_running = False
        sys.stdout = self._stdout


USER_CODE = _UserCode()


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class OwnMethod(Method):
    """A user's method.  Its fields are measured."""

    measured: "Measured"
    source: str  # the text of the file
    file: str  # its name

    @property
    def sha256(self) -> str:
        """The digest of the source in UTF-8, in hexadecimal."""
        import hashlib  # slow

        return hashlib.sha256(self.source.encode()).hexdigest()


@cache
def own_method(source: str, key: str, letter: str, file: str, measured: "Measured") -> OwnMethod:
    """Return the method of a measured text, the same for equal texts."""
    function = own_function(source, key, file)
    rates = function if takes_rates(function) else None
    name = key.replace("_", " ").strip()
    return OwnMethod(
        key=key,
        label=name[:1].upper() + name[1:],
        letter=letter,
        phases=on_force(function),
        on_rates=rates,
        models=("pendulum", "linear", "damped") if rates else ("pendulum", "linear"),
        formula=(function.__doc__ or "").strip().partition("\n")[0],
        order=max(0, round(measured.order or 0)),
        force_evaluations=max(1, math.ceil(measured.force_evaluations)),
        first_same_as_last=measured.more_at_the_start > 0,
        symplectic=measured.symplectic,
        reversible=measured.reversible,
        linear_limit=measured.linear_limit,
        reference=f"{file}:{key}",
        used=None,
        measured=measured,
        source=source,
        file=file,
    )


# Methods are pickled as text, because executed functions have no module.
copyreg.pickle(
    OwnMethod, lambda own: (own_method, (own.source, own.key, own.letter, own.file, own.measured))
)


def takes_rates(function: Phases) -> bool:
    """Return whether a user's function takes the rates of a phase in place of the force.

    It calls its first parameter `rates`; `rates(phase)` are the derivatives of theta and omega.
    """
    wrapped = getattr(function, "__wrapped__", function)
    code = getattr(wrapped, "__code__", None)
    return code is not None and code.co_varnames[:1] == ("rates",)


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


@cache
def own_function(source: str, name: str, file: str) -> Phases:
    """Return the guarded generator function of this name in a text.  Raises OwnMethodError."""
    namespace: dict[str, Any] = {"__name__": "own_method", "__file__": file}
    try:
        with USER_CODE:
            exec(compile(source, file, "exec", dont_inherit=True), namespace)
    except SyntaxError as error:
        raise OwnMethodError(f"{file}, line {error.lineno or 1}: {error.msg}.") from None
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise OwnMethodError(_sentence(error, source, file, file)) from None
    function = namespace.get(name)
    if not callable(function) or isinstance(function, type):
        why = f"{file} has no function {name!r}"
        others = (key for key, value in namespace.items() if callable(value))
        if functions := [key for key in others if key[:1] != "_"]:
            why += f"; it has {', '.join(functions[:6])}"
        raise OwnMethodError(f"{why}.")
    return guarded(function, name, source, file)


def guarded(function: Callable[..., Any], name: str, source: str, file: str) -> Phases:
    """Return the function wrapped to raise OwnMethodError for errors and for wrong values."""
    where = file
    form = _FORM
    if code := getattr(function, "__code__", None):
        where = f"{file}, line {code.co_firstlineno}"
        if not code.co_flags & CO_GENERATOR:
            taken = ", ".join(code.co_varnames[: code.co_argcount])
            form = f"it takes ({taken}); make it a generator function (force, phase, h): {_FORM}"

    @wraps(function)
    def phases(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        floats = type(phase[0]) is float
        following: Any = None
        while True:
            try:
                with USER_CODE:
                    if following is None:
                        following = function(force, phase, h)
                        if not hasattr(following, "__next__"):
                            what = f"{where}: {name} returns {_short(following)}"
                            raise OwnMethodError(f"{what}; {form}.")
                    value = next(following)
            except StopIteration:
                break
            except (OwnMethodError, OverflowError, KeyboardInterrupt):
                raise
            except BaseException as error:
                if _is_of_force(error, force):
                    raise
                what = _sentence(error, source, file, where)
                if following is None and form != _FORM:
                    what = f"{what.rstrip('.')}; {form}."
                raise OwnMethodError(what) from None
            if floats and type(value) is tuple and [*map(type, value)] == FLOATS:
                yield value
            else:
                yield _phase(value, phase, f"{where}: {name}")
        raise OwnMethodError(f"{where}: {name} ends while the run goes on; {_FORM}.")

    return phases


FLOATS = [float, float]
_FORM = "write `while True:` with the formulas and `yield theta, omega`"


def _phase(value: Any, start: Phase, who: str) -> Phase:
    """Return the yielded value as a phase, in the kind of numbers of the start."""
    try:
        theta, omega = (_number(number, like) for number, like in zip(value, start, strict=True))
    except Exception:  # also of the user's __iter__ or __float__
        raise OwnMethodError(f"{who} yields {_short(value)}; {_FORM}.") from None
    return theta, omega


def _number(value: Any, like: Any) -> Any:
    kinds: tuple[tuple[Any, Any], ...] = ((Real, float), (Complex, complex))
    for kind, make in kinds:
        if isinstance(like, kind) and not hasattr(value, "shape"):
            if not isinstance(value, kind):
                raise TypeError
            return make(value)
    if getattr(value, "shape", ()) != getattr(like, "shape", ()):
        raise TypeError
    return value


def _short(value: object) -> str:
    try:
        text = _line(repr(value))
    except Exception:  # the user's __repr__
        text = f"a {type(value).__name__}"
    if len(text) > 40:
        return f"a {type(value).__name__}"
    return text


def _line(text: str) -> str:
    """Return a text in one line, without control characters."""
    return "".join(filter(str.isprintable, " ".join(text.split())))


def _is_of_force(error: BaseException, force: Force) -> bool:
    """Return whether the force raised it, as the sine of infinity does: the run has diverged."""
    if not isinstance(error, ValueError | ArithmeticError):
        return False
    return any(frame.f_code is getattr(force, "__code__", None) for frame, _ in _frames(error))


def _frames(error: BaseException) -> Iterator[tuple[Any, int]]:
    trace = error.__traceback__
    while trace:
        yield trace.tb_frame, trace.tb_lineno
        trace = trace.tb_next


def _sentence(error: BaseException, source: str, file: str, where: str) -> str:
    """Return the error with the user's line in its traceback, or else with `where`."""
    lines = [line for frame, line in _frames(error) if frame.f_code.co_filename == file]
    if lines:
        where = f"{file}, line {lines[-1]}: `{_line(source.splitlines()[lines[-1] - 1])[:60]}`"
    if isinstance(error, TooLongError):
        return f"{where} {error}."
    what = ""
    with suppress(Exception):  # of the user's __str__
        what = _line(str(error))[:200]
    return f"{where} raises {type(error).__name__}{what and f': {what}'}."
