"""pendu-tui: find the command, run it, return the exit code.

Only what the command needs is imported.
"""

import errno
import gc
import io
import os
import sys
import threading
from _thread import interrupt_main
from argparse import Namespace
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from pendu_tui.engine.inputs import did_you_mean
from pendu_tui.tui.cli.commands import COMMANDS, DROPPED
from pendu_tui.tui.cli.errors import Exit, UserError, explained, warn

ROOM = "pendu_tui.tui.commands"

USAGE = """\
usage: pendu-tui [COMMAND | SCENE | FILE] [OPTIONS]

Integrators simulate the same pendulum side by side in your terminal, live: see whose
energy grows, stays bounded or falls.

commands (pendu-tui COMMAND --help shows details):
{commands}

Without a command: live.  Scenes and scene files open in the lab; recordings are replayed.
--version prints the version; --print-completion bash|zsh|tcsh|fish, a completion script.

exit codes: 0 fine, 1 a check failed, 2 usage error, 3 unreadable input, 4 unsuitable terminal,
5 disk error, 130 interrupted.

examples:
  pendu-tui crossover
  pendu-tui replay latest
  pendu-tui run crossover --time 100
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.  Only a bug shows a traceback."""
    if arguments is not None:
        return _main(arguments)
    repeat_swallowed_interrupts()
    gc.disable()  # until all is imported, which leaves nothing to collect
    code = _main(sys.argv[1:])
    others = set(threading.enumerate()) - {threading.main_thread()}
    if not all(thread.daemon for thread in others):
        os._exit(code)  # the interpreter would wait for threads of a user's method
    return code


def _main(arguments: Sequence[str]) -> int:
    if sys.stderr is None:  # the shell has closed it
        sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115  # until the exit
    if sys.stdout is None:
        warn("output: it is closed; redirect it to a file or to /dev/null.")
        return Exit.DISK
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            if not stream.isatty():  # the same bytes on every system
                encoding = os.environ.get("PYTHONIOENCODING", "utf-8").partition(":")[0]
                stream.reconfigure(encoding=encoding, newline="\n")
            stream.reconfigure(errors="replace")  # terminals without θ show a ?
    try:
        code = _dispatch(list(arguments))
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        return _drop_output()
    except (KeyboardInterrupt, Exception) as error:
        if isinstance(error, OSError) and error.errno == errno.EINVAL and not error.filename:
            return _drop_output()  # a closed pipe on Windows
        refusal = explained(error)
        warn(str(refusal))
        try:
            sys.stdout.flush()
        except OSError:
            _drop_output()
        return refusal.code


def _drop_output() -> Exit:
    """Discard the rest of stdout, which the interpreter would try to write at its exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return Exit.PIPE_CLOSED


def _dispatch(arguments: list[str]) -> int:
    match arguments:
        case ["-h" | "--help", *_]:
            commands = "\n".join(f"  {name:<12}{each.about}" for name, each in COMMANDS.items())
            print(USAGE.format(commands=commands), end="")
            return Exit.FINE
        case ["--version", *_]:
            from importlib.metadata import version

            print(f"pendu-tui {version('pendu-tui')}")
            return Exit.FINE
    try:
        if arguments and arguments[0].startswith("--print-completion"):
            import_module(f"{ROOM}.options").completion_parser().parse_known_args(arguments)
        name, arguments = split(arguments)
        refuse_dropped(name, arguments)
        options = import_module(f"{ROOM}.options").parser_of(name).parse_args(arguments)
    except SystemExit:  # after --help or --print-completion
        return Exit.FINE
    module, _, function = COMMANDS[name].place.partition(":")
    run = getattr(import_module(f"{ROOM}.{module or name}"), function or "run")
    if not gc.isenabled():
        gc.freeze()
        gc.enable()
    refuse_to_replace_inputs(options)
    if options.method:
        from pendu_tui.tui.cli.watchdog import watch_calls_in_c

        keep_results_apart()
        watch_calls_in_c()
    return int(run(options))


def split(arguments: list[str]) -> tuple[str, list[str]]:
    """Return the command and its arguments.  Raises UserError if there is none.

    If the first word is a scene or a file, the command is live or replay.
    """
    first = next(iter(arguments), "-")
    if first in COMMANDS or first in DROPPED:
        return first, arguments[1:]
    if first.endswith((".mcap", ".mcap.part")):
        return "replay", arguments
    if first.startswith("-") or first.endswith(".toml"):
        return "live", arguments
    from pendu_tui.engine.scenes import SCENES

    if first in SCENES:
        return "live", arguments
    hint = did_you_mean(first, (*COMMANDS, *SCENES)) or "; pendu-tui --help lists them."
    if os.path.isfile(first):  # noqa: PTH113  # False for a name that is too long
        hint = f"; for the energies in this file use pendu-tui judge {first}."
        if first.endswith(".py"):
            hint = f"; to add the method in this file use pendu-tui --method {first}."
    raise UserError(f"there is no command or scene {first!r}{hint}")


def refuse_dropped(command: str, arguments: Sequence[str]) -> None:
    """Raise UserError if a command, or one of the words after it, has been dropped."""
    for name in (command, *(f"{command} {word.partition('=')[0]}" for word in arguments)):
        if name in DROPPED:
            raise UserError(f"{name} has been dropped; use instead: {DROPPED[name]}.")


def refuse_to_replace_inputs(options: Namespace) -> None:
    """Raise UserError if an output is a file that is read, even with --force."""
    inputs = [vars(options).get(name) for name in ("file", "scene", "scene_option")]
    for text in options.method:
        inputs += [text, text.rpartition(":")[0]]  # FILE.py:FUNCTION
    for output in filter(None, (options.output, options.record)):
        if any(_is_same(output, each) for each in filter(None, inputs)):
            raise UserError(f"{output} is an input of this command; choose another output.")


def _is_same(path: Path, other: str) -> bool:
    try:
        return path.samefile(other)
    except (OSError, ValueError):  # an argument may be no name of a file
        return False


def repeat_swallowed_interrupts() -> None:
    """Send Ctrl+C again if a destructor or a callback of Numba's compiler swallowed it."""
    report = sys.unraisablehook

    def hook(swallowed: "sys.UnraisableHookArgs") -> None:
        if not issubclass(swallowed.exc_type, KeyboardInterrupt):
            report(swallowed)
            return
        threading.Timer(0.05, interrupt_main).start()  # s; by then the callback has returned

    sys.unraisablehook = hook


def keep_results_apart() -> None:
    """Point the descriptor of stdout to stderr from now on, for a user's code; sys.stdout stays."""
    stdout = sys.stdout
    if sys.stdout is not sys.__stdout__:  # a test's
        return
    results = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = os.fdopen(results, "w", encoding=stdout.encoding, errors="replace", newline="\n")
