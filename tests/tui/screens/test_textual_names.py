"""No class of ours takes a private name that Textual uses: it would not notice, and break."""

import inspect
import pkgutil
import re
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib import import_module

import pytest
from textual.message_pump import MessagePump

import pendu_tui.tui
from pendu_tui.tui.cli.errors import UserError

MEANT = {"PenduApp": {"_handle_exception"}}
"""What replaces Textual's own, by class."""

for module in pkgutil.walk_packages(pendu_tui.tui.__path__, "pendu_tui.tui."):
    with suppress(UserError):  # serve needs an extra
        import_module(module.name)


def below(kind: type) -> Iterator[type]:
    for each in kind.__subclasses__():
        yield each
        yield from below(each)


OURS = sorted(
    {each for each in below(MessagePump) if each.__module__.startswith("pendu_tui.tui.")},
    key=lambda each: str(each),
)


@cache
def written(kind: type) -> set[str]:
    """The private names that a class's text defines in its body or assigns on self."""
    defined = r"^    (?:async def |def |)(_[a-z]\w*)(?=\(|: | = )|\bself\.(_[a-z]\w*)(?:: .+)? = "
    return {"".join(names) for names in re.findall(defined, inspect.getsource(kind), re.M)}


def textuals(kind: type) -> set[str]:
    """The private names of all its bases that are not ours."""
    bases = [base for base in kind.__mro__ if base.__module__.startswith(("textual.", "rich."))]
    return set().union(*map(written, bases))


@pytest.mark.parametrize("kind", OURS, ids=lambda kind: kind.__name__)
def test_a_class_takes_no_private_name_of_textuals(kind):
    assert {"_closing", "_timers"} <= textuals(kind)
    assert written(kind) & textuals(kind) == MEANT.get(kind.__name__, set())
