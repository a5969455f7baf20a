"""The options --methods and --method, which choose built-in methods and the user's own."""

import argparse
import signal
import string
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import METHODS, TAYLOR_20, Cast, Method, all_named
from pendu_tui.engine.methods.method import Measured
from pendu_tui.engine.methods.own import (
    MAX_SOURCE,
    OwnMethod,
    OwnMethodError,
    own_function,
    own_method,
)
from pendu_tui.engine.scenes import MAX_METHODS
from pendu_tui.tui.cli.errors import UserError, unreadable
from pendu_tui.tui.cli.options import given_by

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

MAX_SECONDS = 10.0  # to measure a method; 0.2 s is typical


def cast_of(
    options: argparse.Namespace,
    default: Cast,
    model: str | None = None,
) -> Cast:
    """Return the methods that the options choose, `default` without --methods.

    The user's own methods come last unless --methods names them.  With a model, only methods for
    it are suggested.  Raises UserError and OwnMethodError.
    """
    own = own_methods(options)
    cast = default
    if options.methods is not None:
        known = (*METHODS, *own)
        if options.cost == "seconds":
            known = (*known, TAYLOR_20)
        cast = all_named(options.methods.split(","), known, model)
    return (*cast, *(method for method in own if method not in cast))


def check_fits(cast: Cast) -> None:
    """Raise UserError for more methods than a screen and a recording hold."""
    if len(cast) > MAX_METHODS:
        raise UserError(
            f"{len(cast)} methods are too many for a screen or a recording; name those to show, at "
            f"most {MAX_METHODS}, with --methods."
        )


def own_methods(options: argparse.Namespace) -> tuple[OwnMethod, ...]:
    """Return the user's own methods, measured.  Raises UserError and OwnMethodError."""
    own: list[OwnMethod] = []
    with given_by("--method"):
        for text in options.method:
            own.append(own_method_at(text, own))
    return tuple(own)


def own_method_at(text: str, others: Sequence[Method]) -> OwnMethod:
    """Return the method in FILE.py:FUNCTION, with a letter that no other has."""
    if text.endswith(".py"):
        text += f":{Path(text).stem}"
    path, _, key = text.rpartition(":")
    if not path:
        raise InputError(f"{text!r} is not FILE.py:FUNCTION.")
    if not (key.isidentifier() and key.isascii() and len(key) <= 30):
        raise InputError(
            f"{key!r} cannot be a method's name; name the function in at most 30 ASCII letters."
        )
    taken = (*METHODS, *others)
    if key in [method.key for method in taken]:
        raise InputError(f"there is a method {key} already; give your function another name.")
    letters = {method.letter for method in taken}
    free = [each for each in (*key.upper(), *string.ascii_uppercase) if each not in letters]
    letter = next(filter(str.isalpha, free), None)
    if letter is None:
        raise InputError(f"no letter is left for {key}; leave one --method out.")
    try:
        with Path(path).open(encoding="utf-8-sig") as file:
            source = file.read(MAX_SOURCE + 1)
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise unreadable(f"{path} cannot be read: {why}.") from None
    return own_method(source, key, letter, path, _tried(source, key, path))


def _tried(source: str, key: str, file: str) -> Measured:
    """Return the properties of a user's method, which is tried in another process.

    Raises OwnMethodError, also if the process does not answer in time, or ends.
    """
    # multiprocessing takes 15 ms
    from pendu_tui.tui.cli.workers import received, started

    process, results = started(_try, source, key, file)
    try:
        received(results, process)  # when it has started
        found: Measured = received(results, process, MAX_SECONDS)
        return found
    except TimeoutError:
        why = f"takes more than {MAX_SECONDS:g} s for a trial"
        raise OwnMethodError(f"{file}: {key} {why}.") from None
    except EOFError:
        raise OwnMethodError(f"{file}: {key} ends the process in which it is tried.") from None
    finally:
        process.kill()
        process.join()


def _try(results: "Connection", source: str, key: str, file: str) -> None:
    """Send None, and then the properties or an OwnMethodError."""
    from pendu_tui.engine.methods.measure import examined  # NumPy
    from pendu_tui.tui.cli.watchdog import watchdog

    def tell(sentence: str) -> None:
        results.send(OwnMethodError(sentence))

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    watchdog().tell = tell
    with suppress(KeyboardInterrupt, OSError):  # a user's code raises it; nobody reads any more
        results.send(None)
        try:
            results.send(examined(own_function(source, key, file), f"{file}: {key}"))
        except OwnMethodError as error:
            results.send(error)
