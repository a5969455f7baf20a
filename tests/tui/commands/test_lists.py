"""`pendu-tui methods`."""

import pytest

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.run.loops import available
from pendu_tui.tui.commands.lists import CLAIMS
from tests.tui.command_line import pendu


def test_methods_that_are_named_are_listed_alone():
    listed = pendu("methods", "rk4", "verlet", "--json").json["methods"]
    assert [method["key"] for method in listed] == ["rk4", "velocity_verlet"]
    six = [method.key for method in METHODS[:6]]
    assert "\nVerlet " not in pendu("methods", *six).out
    answer = pendu("methods", "--json").json
    assert [method["key"] for method in answer["methods"]] == [method.key for method in METHODS]
    assert answer["compiled"] == available()


BROKEN = """
def broken(force, phase, h):
    theta, omega = phase
    while True:
        omega = omega + 0.5001 * h * force(theta)
        theta = theta + h * omega
        omega = omega + 0.5 * h * force(theta)
        yield theta, omega
"""


def test_a_gate_compares_what_is_measured_of_ones_own_method_alone(tmp_path):
    (tmp_path / "mine.py").write_text(BROKEN)
    own = ("methods", "--method", f"{tmp_path}/mine.py:broken", "--fail-if")
    failed = pendu(*own, "order < 1.9 or reversible != yes or force_evaluations > 1.9")
    assert failed.code == 1
    for words in ("order is", "reversible is no", "force_evaluations is 2", "does not fall with h"):
        assert words in failed.err
    passed = pendu(*own, "order < 0 or symplectic != yes or force_evaluations > 2")
    assert (passed.code, passed.err) == (0, "")
    assert "does not fall with h" in passed.out
    (line,) = (line for line in passed.out.splitlines() if line.startswith("broken "))
    assert line.split() == ["broken", "-", "0.008", "2", "yes", "no", "2.000"]
    (fields,) = pendu(*own[:-1], "--json").json["methods"]
    claims = [name for name in CLAIMS if fields[name] is not None]
    assert claims == ["key", "label", "letter", "other_names"]


@pytest.mark.parametrize(
    ("method", "gate", "code"),
    [
        ("velocity_verlet", "order < 1.9 or symplectic != yes", 0),
        ("halving_verlet", "symplectic == yes", 1),  # which is not measured, like its order
    ],
)
def test_the_gate_of_a_right_method_passes(method, gate, code):
    assert pendu("methods", method, "--fail-if", gate).code == code
