"""A user's own method: what is accepted, what is refused with a sentence, and how it runs."""

import hashlib
import math
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context

import numpy as np
import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import TAYLOR_20, VELOCITY_VERLET, family_of, method_of
from pendu_tui.engine.methods.own import MAX_SOURCE, USER_CODE, OwnMethodError, TooLongError
from pendu_tui.engine.models import STUDIED
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.scenes import SCENES
from tests.own_methods import VERLET, load

EULER = "theta, omega = theta + h * omega, omega + h * force(theta)"


def euler(step="", before="pass", yields="theta, omega"):
    """Explicit Euler's text with something more in it; the line `step` is the seventh."""
    return f"""
def mine(force, phase, h):
    theta, omega = phase
    {before}
    while True:
        {EULER}
        {step or "pass"}
        yield {yields}
"""


def refusal(source):
    with pytest.raises(OwnMethodError) as refused:
        load(source)
    text = str(refused.value)
    assert text.startswith("mine.py")
    assert text.count("mine.py") == 1
    assert text.endswith(".")
    assert not text.endswith("..")
    assert text.isprintable()
    assert len(text) < 400
    return text


def test_verlet_written_again_is_measured_to_be_verlet():
    mine, verlet = load(VERLET), VELOCITY_VERLET
    assert mine.sha256 == hashlib.sha256(VERLET.encode()).hexdigest()
    assert mine.order == 2
    assert mine.measured.order == pytest.approx(2, abs=0.01)
    assert mine.linear_limit == pytest.approx(2, abs=1e-9)
    for field in ("force_evaluations", "first_same_as_last", "symplectic", "reversible"):
        assert getattr(mine, field) == getattr(verlet, field)
    assert family_of("mine") == "your own"
    assert (mine.key, mine.label, mine.letter) == ("mine", "Mine", "m")
    assert repr(mine) == "OwnMethod(mine)"
    assert (mine.formula, mine.reference) == ("Half a kick, a drift, half a kick.", "mine.py:mine")


RATES = """
def mine(rates, phase, h):
    theta, omega = phase
    while True:
        velocity, acceleration = rates((theta, omega))
        theta = theta + h * velocity
        omega = omega + h * acceleration
        yield theta, omega
"""


def test_a_method_that_takes_rates_integrates_friction_too():
    mine = load(RATES)
    assert (mine.order, mine.force_evaluations, mine.first_same_as_last) == (1, 1, False)
    assert mine.models == (*STUDIED, "damped")
    assert all(pickle.loads(pickle.dumps(each)) is each for each in (mine, TAYLOR_20))
    with pytest.raises(OwnMethodError, match=r"file of the method mine: .* --method FILE\.py:mine"):
        pickle.dumps(replace(VELOCITY_VERLET, key="mine"))
    for name in ("damped", "drift"):
        lockstep = Lockstep(SCENES[name].with_cast((mine, method_of("explicit_euler"))))
        lockstep.advance(300)
        own, listed = lockstep.sample().readings
        assert (own.theta, own.omega) == (listed.theta, listed.omega)
    with pytest.raises(InputError, match="is for pendulum or linear"):
        SCENES["damped"].with_cast((load(VERLET),))


def test_it_has_the_same_bits_in_another_process():
    step = load(VERLET).step, math.sin, (2.0, 0.5), 0.1
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        there = executor.submit(*step).result()
    assert there == VELOCITY_VERLET.step(*step[1:])


WRONG = {
    "a step instead of a generator": (
        f"def mine(force, phase, h):\n    theta, omega = phase\n    {EULER}\n    return theta, omega",
        "mine is not a generator function; make it one that takes (force, phase, h)",
    ),
    "another signature": ("def mine(phase):\n    yield phase", "line 1 raises TypeError: mine() takes 1 positional"),
    "one step and no more": (euler("yield theta, omega; return"), "line 2: mine ends while the run continues; write `while True:`"),
    "half a phase": (euler(yields="theta"), "line 2: mine yields 1.015;"),
    "more than a phase": (euler(yields="1, 2, *range(9)"), "mine yields (1, 2, 0, 1, 2, 3, ...); write `while True:`"),
    "no numbers of its start": (euler(yields="0.5, 0.5"), "mine yields (0.5, 0.5); write"),
    "an exception later": (euler("n = n + 1; assert n < 30", "n = 0"), "line 7: `n = n + 1; assert n < 30` raises A"),
    "an array changed in place": (
        "def mine(force, phase, h):\n    theta, omega = phase\n    while True:\n        theta += h * omega\n"
        "        omega += h * force(theta)\n        yield theta, omega",
        "with NumPy arrays, which stability needs: use only +, -, * and / on theta and omega, and theta =",
    ),
    "one number of an array": (
        euler(yields="np.mean(theta), np.mean(omega)", before="import numpy as np"),
        "`yield theta, omega`; this was with NumPy arrays, which stability needs",
    ),
    "one omega of an array": (euler(yields="theta, sum(omega) / 3 if hasattr(omega, 'shape') else omega"), "`yield theta, omega`; this was"),
    "other numbers for arrays": (
        euler("theta = theta + 1e-10 * hasattr(theta, 'shape')"),
        "mine gives different numbers from those with floats; this was with NumPy arrays",
    ),
    "an infinite force": (euler("force(float('inf'))"), "mine overflows on an ordinary swing ("),
    "an exception with a full stop": (
        euler("odd()", "def odd(): raise ValueError('It is odd.')"),
        "`def odd(): raise ValueError('It is odd.')` raises ValueError: It is odd.",
    ),
    "a long exception": (euler("raise ValueError('long ' * 99)"), f"raises {('ValueError: ' + 99 * 'long ')[:250]}."),
    "not a number": (euler("omega = omega * float('nan')"), "mine does not stay finite"),
    "a memory": (
        euler("omega = omega + h * (force(theta) - a) / 2; a = force(theta)", "a = 0.0"),
        "mine gives different numbers when restarted after 37 of 80 steps",
    ),
    "a count to ten": (euler("n = n + 1; omega = omega + 1e-5 * (n % 10 == 0)", "n = 0"), "numbers when restarted"),
    "a modulus, which no derivative passes": (euler("theta = abs(theta)"), "different numbers from those with floats; this was with complex numbers"),
    "a control character": ("A#\x1b", "line 1: `A#` raises NameError: name 'A' is not defined."),
    "a character that ends a text": ("\0", "source code string cannot contain null bytes."),
    "no Python": ("\ndef mine(:", "line 2: invalid syntax."),
    "another name": ("import math\ndef yours(): pass\ndef _hidden(): pass\ndef hers(): pass", "has no function 'mine'; it has yours, hers."),
    "another function": ("mine = print", "print is not a generator function"),
    "just enough text": ("#" * MAX_SOURCE, "mine.py has no function 'mine'."),
    "too much text": ("#" * (MAX_SOURCE + 1), "use a file of at most 30,000 characters."),
}  # fmt: skip


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_method_gets_one_sentence_that_says_where(wrong):
    source, said = WRONG[wrong]
    assert said in refusal(source)


def test_it_may_yield_a_list_and_what_it_prints_goes_to_stderr(capsys):
    source = euler(
        before="import numpy as np",
        step="print('here')",
        yields="[*np.multiply((theta, omega), 1)]",
    )
    mine = load(source)
    assert mine.order == 1
    assert [type(number) for number in mine.step(np.sin, (1.0, 0.0), 0.1)] == [float, float]
    more = euler("np.max(np.abs(theta)) < 0.5 and force(theta)", "import numpy as np")
    assert load(more).force_evaluations == 2
    wrong = load(euler(before="force = lambda theta: 0 * theta"))
    assert (wrong.order, wrong.force_evaluations) == (0, 1)
    braked = load(euler("omega *= 0.9999"))
    assert braked.measured.order < -1 < braked.order == 0
    printed = capsys.readouterr()
    assert not printed.out
    assert printed.err.startswith("here\n")
    begun = USER_CODE.count
    with USER_CODE:
        with USER_CODE:
            pass
        print("still there")
    print("here again")
    assert capsys.readouterr() == ("here again\n", "still there\n")
    assert USER_CODE.count == begun + 1


NAMED = '''
import functools
print(__name__, __file__)

def spoken(function):
    @functools.wraps(function)
    def wrapped(*given):
        print("called")
        return function(*given)
    return wrapped

@spoken
def my_old_METHOD_(force, phase, h):
    """
    The first line.

    The second.
    """
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega
'''


def test_it_is_named_after_its_function_and_told_by_its_first_line(capsys):
    mine = load(NAMED, "my_old_METHOD_")
    assert (mine.label, mine.formula) == ("My old METHOD", "The first line.")
    assert (mine.symplectic, mine.reversible) == (True, False)
    printed = capsys.readouterr()
    assert not printed.out
    assert printed.err.startswith("own_method mine.py\ncalled\n")


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (KeyboardInterrupt, KeyboardInterrupt),
        (OverflowError, OverflowError),
        (ValueError, ValueError),
        (ZeroDivisionError, ZeroDivisionError),
        (TypeError, OwnMethodError),
        (TooLongError, OwnMethodError),
    ],
)
def test_an_interrupt_and_a_divergence_are_no_faults(error, told):
    def force(_):
        raise error

    mine = load(euler())
    with pytest.raises(told) as raised:
        mine.step(force, (1.0, 0.0), 0.1)
    if told is OwnMethodError:
        what = {TypeError: "raises TypeError", TooLongError: "takes more than 3 s"}[error]
        assert str(raised.value) == f"mine.py, line 6: `{EULER}` {what}."
    with pytest.raises(OverflowError):
        load(euler("omega ** 4")).step(float, (1.0, 1e99), 0.1)
    with pytest.raises(KeyboardInterrupt):
        load("raise KeyboardInterrupt")
    begun = mine.phases(np.sin, (1.0, 0.0), 0.1)
    next(begun)
    begun.close()
