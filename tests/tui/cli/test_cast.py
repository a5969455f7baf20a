"""The options --methods and --method."""

import os
import subprocess
from pathlib import Path

import pytest
from hypothesis import strategies as st

from engine.methods import (
    EXPLICIT_EULER,
    GENERAL,
    METHODS,
    RK4,
    SYMPLECTIC_EULER,
    USUAL_CAST,
    VELOCITY_VERLET,
    Cast,
    method_of,
)
from engine.methods.own import OwnMethod
from engine.scenes import DEFAULT_SCENE, MOST_METHODS, Scene
from tests.tui.command_line import pendu
from tests.tui.pty_lab import PENDU
from tui.cli import cast as cast_options
from tui.cli.errors import UserError
from tui.cli.options import Parser
from tui.cli.scene import add_scene_options, scene_of

MINE = """
def kick_drift(force, phase, h):
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega

def {name}(force, phase, h):
    theta, omega = phase
    while True:
        theta, omega = theta + h * omega, omega + h * force(theta)
        yield theta, omega

def endless(force, phase, h):
    while True:
        try:
            while True:
                pass
        except Exception:
            pass
    yield phase
"""


@pytest.fixture
def mine(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(MINE.format(name="rk4"))
    return "mine.py"


def scene_from(*arguments: str) -> Scene:
    parser = Parser(prog="pendu-tui test")
    add_scene_options(parser)
    return scene_of(parser.parse_args(list(arguments)))


def cast_from(*arguments: str) -> Cast:
    return scene_from(*arguments).cast


def test_without_options_the_cast_is_the_scenes():
    assert cast_from() == DEFAULT_SCENE.cast == USUAL_CAST


@pytest.mark.parametrize(
    ("text", "cast"),
    [
        ("rk4", (RK4,)),
        ("rk4,explicit_euler", (RK4, EXPLICIT_EULER)),
        ("s,vel,explicit_e", (SYMPLECTIC_EULER, VELOCITY_VERLET, EXPLICIT_EULER)),
        ("velocity, rk4", (VELOCITY_VERLET, RK4)),
        ("Leapfrog,symplectic-euler", (VELOCITY_VERLET, SYMPLECTIC_EULER)),
        ("stormer verlet,RK2", (VELOCITY_VERLET, method_of("heun"))),
        ("yoshida,implicit euler", (method_of("yoshida_6"), method_of("backward_euler"))),
    ],
)
def test_the_start_of_a_name_is_enough_and_the_order_is_the_one_given(text, cast):
    assert cast_from("--methods", text) == cast


def test_a_name_as_the_tables_print_it_will_do_in_any_case():
    for method in METHODS:
        assert cast_options.find(method.label, METHODS) is method
        assert cast_options.find(method.label.upper(), METHODS) is method
        assert cast_options.find(method.key.upper(), METHODS) is method


def test_the_start_of_a_later_word_will_do_where_it_is_the_only_one():
    assert cast_options.find("verlet", USUAL_CAST) is VELOCITY_VERLET
    with pytest.raises(
        UserError, match="'euler' may be explicit_euler or symplectic_euler; write more of it"
    ):
        cast_options.find("euler", USUAL_CAST)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("rk5", "no method 'rk5': did you mean rk4?"),
        ("nothing", "choose from Euler: explicit_euler, symplectic_euler; "),
        ("rk4,rk4", "rk4 is there twice"),
        ("rk4,", "no method ''"),
        ("euler", "may be explicit_euler or symplectic_euler or backward_euler"),
    ],
)
def test_a_wrong_list_is_one_sentence_and_exit_2(text, words):
    assert pendu("run", "--time", "2", "--methods", text).refused(2, "--methods: ", words)


def test_a_method_of_ones_own_comes_last_in_the_scenes_cast(mine):
    *usual, own = cast_from("--method", f"{mine}:kick_drift")
    assert tuple(usual) == USUAL_CAST
    assert isinstance(own, OwnMethod)
    assert (own.key, own.symplectic, own.source) == ("kick_drift", True, MINE.format(name="rk4"))


def test_a_method_of_ones_own_stands_where_methods_names_it_or_last(mine):
    for named, keys in (("kick,rk4", ["kick_drift", "rk4"]), ("rk4", ["rk4", "kick_drift"])):
        assert [
            method.key for method in cast_from("--method", f"{mine}:kick_drift", "--methods", named)
        ] == keys


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("mine.py", 2, "mine.py has no function 'mine'; it has kick_drift"),
        ("mine.py:kick_drift,x", 2, "is not FILE.py:FUNCTION"),
        ("mine.py:kick_drift,letter=xy", 2, "'xy' is not a letter"),
        ("mine.py:kick_drift,letter=r", 2, "r is the letter of rk4"),
        ("mine.py:rk4", 2, "there is a method rk4 already"),
        ("mine.py:größer", 2, "cannot be a method's name"),
        (f"mine.py:{'a' * 31}", 2, "cannot be a method's name"),
        ("mine.py:kick", 2, "mine.py has no function 'kick'; it has kick_drift, rk4"),
        ("absent.py:kick_drift", 3, "absent.py cannot be read: No such file"),
        (".:kick_drift", 3, "cannot be read: Is a directory"),
        ("/dev/zero:kick_drift", 2, "too long; use a file of at most 30,000 characters"),
    ],
)
def test_a_wrong_method_option_is_one_sentence(mine, text, code, words):
    assert pendu("run", "--time", "2", "--method", text).refused(code, words)


def test_a_method_that_never_yields_is_interrupted(mine, monkeypatch):
    monkeypatch.setattr(cast_options, "MAX_SECONDS", 0.2)
    assert pendu("run", "--time", "2", "--method", f"{mine}:endless").refused(
        2, "more than 0.2 s", "while True"
    )


@pytest.mark.slow
def test_a_thread_of_a_method_does_not_outlive_the_command(tmp_path):
    thread = "import threading, time\nthreading.Thread(target=time.sleep, args=(60,)).start()\n"
    (tmp_path / "mine.py").write_text(thread + MINE.format(name="other"))
    options = ["run", "--time", "1", "--method", f"{tmp_path / 'mine.py'}:other"]
    assert subprocess.run([*PENDU, *options], capture_output=True, timeout=30).returncode == 0


def test_more_than_six_are_too_many_for_a_stage(mine):
    names = [f"m{n}" for n in range(MOST_METHODS)]
    Path("six.py").write_text("".join(MINE.format(name=name) for name in names))
    each = [word for name in names for word in ("--method", f"six.py:{name}")]
    assert pendu("run", "--time", "2", *each).refused(2, "10 methods are too many", "at most 6")
    rows = pendu("run", "--time", "2", *each, "--methods", "m5,m4,m3,m2,m1,m0", "--json").json[
        "methods"
    ]
    assert [row["method"] for row in rows] == names[::-1]


casts = st.lists(st.sampled_from(GENERAL), min_size=1, max_size=6, unique=True).map(tuple)


def test_ones_own_method_has_null_claims_and_what_is_measured(mine):
    *_, told = pendu("methods", "--method", f"{mine}:kick_drift", "--json").json["methods"]
    assert (told["key"], told["label"]) == ("kick_drift", "Kick drift")
    for claim in (
        "order",
        "force_evaluations",
        "symplectic",
        "reversible",
        "linear_limit",
        "reference",
        "used",
    ):
        assert told[claim] is None
    assert told["measured_order"] == pytest.approx(1, abs=0.05)
    assert told["measured_linear_limit"] == pytest.approx(2, abs=1e-8)
    assert (told["measured_symplectic"], told["measured_reversible"]) == (True, False)
    assert told["measured_force_evaluations"] == 1
    table = pendu(
        "methods", "--methods", "kick_drift,rk4", "--method", f"{mine}:kick_drift"
    ).out.splitlines()
    assert [line.split()[0] for line in table[1:3]] == ["kick_drift", "rk4"]


@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="one processor")
def test_workers_and_this_process_agree_about_ones_own_method(mine):
    command = (
        "stability",
        "--steps",
        "30",
        "--z-values",
        "0.5,2.5",
        "--theta-values",
        "1,2",
        "--csv",
    )
    own = ("--method", f"{mine}:kick_drift", "--methods", "kick_drift")
    assert pendu(*command, *own).out == pendu(*command, *own, "--workers", "2").out


def test_a_replay_shows_only_the_methods_asked_for(monkeypatch):
    screens = []
    monkeypatch.setattr("tui.terminal.check.check_terminal", lambda: None)
    monkeypatch.setattr(
        "tui.screens.launch.show", lambda screen, options: screens.append(screen) or 0
    )
    for words, places in ((("--methods", "rk4,verlet"), [2, 3]), ((), [0, 1, 2, 3])):
        assert pendu("replay", "drift", *words).code == 0
        assert screens[-1].shown.places(USUAL_CAST) == places
        screens[-1].source.close()
    assert pendu("replay", "drift", "--methods", "rk5").refused(2, "did you mean rk4?")
