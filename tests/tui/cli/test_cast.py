"""The options --methods and --method."""

import json
import string
import subprocess
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import METHODS, RK4, TAYLOR_20, USUAL_CAST, Cast, named
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.tui.cli.cast import _try, cast_of, own_method_at
from pendu_tui.tui.cli.scene import scene_of
from pendu_tui.tui.commands.options import parser_of
from tests.tui.command_line import EULER, PENDU, ROOT, pendu

SOURCE = EULER.format(name="kick_drift") + EULER.format(name="rk4")


@pytest.fixture
def mine(here):
    (here / "mine.py").write_text(SOURCE, encoding="utf-8-sig")
    (here / "kick.py").write_text(EULER.format(name="kick"))
    (here / "long.py").write_text(SOURCE + "#" * 30_000)
    (here / "binary.py").write_bytes(b"\xff")
    (here / "once.py").write_text("def once(force, phase, h):\n    yield phase")


def cast_from(*arguments: str) -> Cast:
    return scene_of(parser_of("snapshot").parse_args(arguments)).cast


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("symp,vel,explicit_e", "symplectic_euler velocity_verlet explicit_euler"),
        ("Leapfrog,symplectic-euler", "velocity_verlet symplectic_euler"),
        ("stormer verlet,RK2", "velocity_verlet heun"),
        ("yoshida,implicit euler", "yoshida_6 backward_euler"),
    ],
)
def test_the_start_of_a_name_is_enough_and_the_order_is_the_one_given(text, keys):
    assert [method.key for method in cast_from("--methods", text)] == keys.split()


def test_a_name_as_the_tables_print_it_will_do_in_any_case():
    for method in METHODS:
        assert named(method.label.upper()) is named(method.key.upper()) is method
    options = parser_of("accuracy").parse_args(["--cost=seconds", "--methods=TAYLOR 20"])
    assert cast_of(options, ()) == (TAYLOR_20,)


def test_a_method_of_ones_own_stands_where_methods_names_it_or_last(mine):
    own = ("--method", "mine.py:kick_drift")
    last = cast_from(*own, "--methods", "rk4")[-1]
    assert isinstance(last, OwnMethod)
    assert (last.key, last.symplectic, last.source) == ("kick_drift", True, SOURCE)
    assert cast_from(*own, "--methods", "kick,rk4") == (last, RK4)
    assert cast_from(*own) == (*USUAL_CAST, last)
    assert [each.letter for each in cast_from(*own, "--method", "kick.py")[-2:]] == ["K", "I"]
    others = [replace(RK4, key=letter, letter=letter) for letter in string.ascii_uppercase]
    with pytest.raises(InputError, match="no letter is left for kick_drift"):
        own_method_at("mine.py:kick_drift", others)


@pytest.mark.other_process
@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("mine.py", 3, "mine.py has no function 'mine'; it has kick_drift, rk4"),
        ("mine", 2, "--method: 'mine' is not FILE.py:FUNCTION"),
        *((f"mine.py:{key}", 2, f"'{key}' cannot be") for key in ("größer", "1st", "a" * 31)),
        (f"mine.py:{'a' * 30}", 3, "has no function"),
        ("binary.py", 3, "it is not text in UTF-8"),
        ("mine.py:rk4", 2, "there is a method rk4 already"),
        ("kick.py --method kick.py", 2, "there is a method kick already"),
        ("no:absent.py:kick_drift", 3, "no:absent.py cannot be read: No such file"),
        ("once.py", 3, "once ends while the run continues"),
        ("long.py:kick_drift", 3, "too long; use a file of at most 30,000 characters"),
    ],
)
def test_a_wrong_method_option_is_one_sentence(mine, text, code, words):
    assert pendu("run", "--time", "2", "--method", *text.split()).refused(code, words)


@pytest.mark.slow
@pytest.mark.other_process
@pytest.mark.parametrize(
    ("work", "seconds", "why"),
    [
        ("while True: pass", 100.0, "line 3: `while True: pass` takes more than 3 s"),
        ("pow(7, 10**9)", 2.0, "takes more than 2 s for a trial"),
        ("os._exit(0)", 100.0, "ends the process in which it is tried"),
    ],
)
def test_a_method_that_cannot_be_tried_is_refused_with_a_sentence(
    mine, monkeypatch, work, seconds, why
):
    monkeypatch.setattr("pendu_tui.tui.cli.cast.MAX_SECONDS", seconds)
    Path("hostile.py").write_text(
        f"import os\ndef hostile(force, phase, h):\n    {work}\n    yield"
    )
    assert pendu("run", "--time", "2", "--method", "hostile.py").refused(3, "hostile.py", why)


def test_a_trial_ends_in_silence_if_the_command_has_ended(monkeypatch):
    for name in ("signal.signal", "pendu_tui.tui.cli.watchdog.watchdog"):
        monkeypatch.setattr(name, Mock())
    results = Mock(send=Mock(side_effect=BrokenPipeError))
    _try(results, "", "mine", "mine.py")
    results.send.assert_called_once_with(None)  # and no error came out


def test_what_a_method_prints_is_not_among_the_results_and_its_threads_end_with_the_command(
    tmp_path,
):
    head = """import os, sys, threading, time
threading.Thread(target=time.sleep, args=(60,)).start()
print("C")
"""
    loud = EULER.format(name="loud").replace(
        "yield", "sys.stdout.write('A'); os.write(1, b'B'); yield"
    )
    (tmp_path / "loud.py").write_text(head + loud)
    command = [*PENDU, "run", "--time", "1", "--json", "--method", f"{tmp_path / 'loud.py'}:loud"]
    ended = subprocess.run(command, capture_output=True, timeout=30, check=False, cwd=ROOT)
    assert ended.returncode == 0, ended.stderr
    assert json.loads(ended.stdout)["schema"].startswith("pendu.run/")
    assert b"\r" not in ended.stdout  # also on Windows
    assert all(letter in ended.stderr for letter in (b"A", b"B", b"C"))


def test_more_than_six_run_but_fit_no_screen_and_no_recording():
    keys = [method.key for method in METHODS if method.general][:7]
    methods = ("--methods", ",".join(keys))
    rows = pendu("run", "--time", "2", *methods, "--json").json["methods"]
    assert [row["method"] for row in rows] == keys
    assert pendu("live", *methods).refused(2, "7 methods are too many", "at most 6")
    assert len(cast_from("--methods", ",".join(keys[:6]))) == 6
