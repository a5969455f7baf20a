"""Measure every field of METHODS, on every model that a method is for."""

import math
import re
import zlib
from itertools import islice

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import (
    GENERAL,
    METHODS,
    USUAL_CAST,
    VELOCITY_VERLET,
    all_named,
    family_of,
    learned,
    matching,
    measure,
)
from pendu_tui.engine.methods.implicit import BACKWARD_EULER, IMPLICIT_MIDPOINT
from pendu_tui.engine.methods.method import compilable, no_order
from pendu_tui.engine.methods.runge_kutta import EXPLICIT_MIDPOINT, HEUN
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.run.loops import PlainLoops, count_evaluations
from pendu_tui.recordings.events import fingerprint
from tests.models import EQUATIONS, EXAMPLES

PENDULUM = Pendulum(9.81)
FORCE = PENDULUM.force()
each_method = pytest.mark.parametrize("method", GENERAL, ids=str)
# The others, which measure.measured does not reach
PAIRS = [
    (method, model)
    for model in EQUATIONS
    for method in METHODS
    if model.key in method.models
    if model.without_force or (model.key == "pendulum" and not method.general)
]
each_pair = pytest.mark.parametrize(
    ("method", "model"), PAIRS, ids=[f"{method.key}-{model.key}" for method, model in PAIRS]
)


@each_method
def test_the_measured_properties_are_the_claimed_ones(method):
    found = measure.measured(method.phases)
    assert found.order == pytest.approx(method.order, abs=0.1)
    assert found.linear_limit == pytest.approx(method.linear_limit, abs=2e-9)  # to 1e-9 each
    assert (found.symplectic, found.reversible) == (method.symplectic, method.reversible)
    if method.varies:
        assert round(found.force_evaluations) == method.force_evaluations
    else:
        cost = (method.force_evaluations, int(method.first_same_as_last))
        assert (found.force_evaluations, found.more_at_the_start) == cost


BITS = {  # checksums of 20 steps
    "explicit_euler": 0x1355656D,
    "symplectic_euler": 0x8A9789B7,
    "velocity_verlet": 0xB7A7DE8F,
    "position_verlet": 0x5B7D5E30,
    "rk4": 0x4ED50D2F,
    "heun": 0xA2510F42,
    "explicit_midpoint": 0x10894CF3,
    "forest_ruth": 0xC993FDD5,
    "yoshida_6": 0xE181E78D,
    "blanes_moan_4": 0x9E191DE9,
    "blanes_moan_6": 0xD8541C39,
    "backward_euler": 0xF66336BC,
    "implicit_midpoint": 0xCAB74901,
    "lagged_verlet": 0x7304AB24,
    "conformal_verlet": 0x9C448EB8,
    "halving_verlet": 0x514BC455,
    "halving_richardson": 0xC03502BF,
    "verlet_float32": 0xE02E11A0,
    "verlet_compensated": 0xEDB1F3C1,
    "respa": 0xF47290BC,
    "imex_euler": 0xCD65094F,
    "mean_field_splitting": 0xCEC0701C,
    "rk4_learned_field": 0xA6A82F40,
    "rk4_learned_hamiltonian": 0x12039CF9,
    "learned_map": 0xA9200A71,
    "learned_symplectic_map": 0xF742F848,
}


def cubic(q):
    """A force that has the same bits everywhere."""
    return q * q * q / 6 - q


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_every_bit_of_a_step_is_as_recordings_know_it(method):
    model = EXAMPLES[method.models[0]].equations
    takes, phases = method.phases_for(model)
    taken = cubic
    if takes == "parts":
        if fingerprint("sin") != "977b70889c532ffc":
            pytest.skip("this machine has another sine")
        taken = model.parts()
    for each in (phases, compilable(phases)):
        path = list(islice(each(taken, model.start(1.0, 0.5), 0.1), 20))
        assert zlib.crc32(repr(path).encode()) == BITS.get(method.key)


STEPS = {1: (8000, 16_000), 2: (100, 141, 200, 283), 3: (80, 113, 160), 4: (100, 140, 200)}


@each_pair
def test_it_has_the_claimed_order(method, model):
    time = min(2.0, 10 / model.fastest)

    def end(n):
        phase = PlainLoops(method, model).propagate(model.start(1.0, 0.0), time / n, n)
        return float(model.observe(phase).theta)

    steps, exact = STEPS[method.order], model.exact(1.0, 0.0).at(time).theta
    if method in learned.FAMILY:  # of the learned motion
        steps, exact = (80, 113, 160), end(1600)
    errors = [abs(end(n) - exact) for n in steps]
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(method.order, abs=0.15)


@each_pair
def test_a_run_evaluates_the_force_as_often_as_claimed(method, model):
    offer, _ = method.phases_for(model)
    if method.varies or (offer == "parts" and not hasattr(model.parts(), "_replace")):
        return  # there is nothing to count
    for steps in (1, 2, 10):
        start = model.start(1.0, 0.5)
        assert count_evaluations(method, model, start, 0.05, steps) == method.evaluations(steps)


@each_pair
def test_time_turned_round_leads_back_to_the_start_where_claimed(method, model):
    start, h = model.start(2.0, 0.3), 0.6 / model.fastest
    propagate = PlainLoops(method, model).propagate
    turned = np.array([1, -1, 1, -1, 1])[: len(start)]
    back = propagate(tuple((propagate(start, h, 50) * turned).tolist()), h, 50)
    assert (np.abs(back * turned - start).max() < 1e-9) == method.reversible


@each_pair
def test_a_step_keeps_volume_where_claimed(method, model):
    if method.varies and not model.without_force:
        return  # a step that is not divided does
    start, columns = np.array(model.start(1.0, 0.5)), []
    for nudge in 1e-6 * np.eye(len(start.view(float))):
        off = nudge.view(start.dtype)
        starts = [tuple(each.tolist()) for each in (start + off, start - off)]
        ends = [next(method.on(model)(each, 0.6 / model.fastest)) for each in starts]
        columns.append(np.subtract(*(np.array(end).view(float) for end in ends)) / 2e-6)
    assert (abs(np.linalg.det(columns) - 1) < 1e-6) == method.symplectic


def stepping(first, second):
    """Symplectic Euler with two wrong coefficients of its kick."""

    def phases(force, phase, h):
        theta, omega = phase
        while True:
            omega = omega + first * h * force(theta)
            theta = theta + h * omega
            omega = omega + second * h * force(theta)
            yield theta, omega

    return phases


@pytest.mark.parametrize(
    ("coefficients", "why"), [((0.5001, 0.5), "does not fall with h"), ((-0.5, -0.5), "above 0.1")]
)
def test_a_method_of_another_equation_has_no_order(coefficients, why):
    order = measure.order(stepping(*coefficients))
    assert order is None or abs(order) < 0.1
    assert why in no_order(order)
    assert [bool(no_order(order)) for order in (0.4, 0.6)] == [True, False]


@pytest.mark.parametrize(("parts", "limit"), [(0.04, 0), (0.1, 0.2), (7, 14), (8.1, math.inf)])
def test_a_limit_is_found_from_a_tenth_up_to_sixteen(parts, limit):
    def slower(force, phase, h):
        return VELOCITY_VERLET.phases(force, phase, h / parts)

    assert measure.linear_limit(slower) == pytest.approx(limit)


@pytest.mark.filterwarnings("error")
def test_a_step_without_a_solution_fails_and_others_of_an_array_do_not():
    far, near = np.array([3.0, 0.1]), np.zeros(2)
    step = IMPLICIT_MIDPOINT.step
    theta, omega = step(PENDULUM.force(np.sin), (far, near), 2.2 / PENDULUM.w0)
    assert np.isnan([theta[0], omega[0]]).all()
    assert math.isnan(step(FORCE, (3.0, 0.0), 2.2 / PENDULUM.w0)[0])
    assert np.isfinite([theta[1], omega[1]]).all()


def test_a_solution_depends_on_no_other_and_is_found_after_many_turns():
    step, h = BACKWARD_EULER.step, 0.9 / PENDULUM.w0
    starts = np.append(3.0, np.linspace(0.05, 1.5, 50))
    together, _ = step(PENDULUM.force(np.sin), (starts, 0.0), h)
    alone = [step(PENDULUM.force(np.sin), (one, 0.0), h)[0] for one in starts[:, None]]
    assert np.array_equal(together, np.concatenate(alone))
    assert all(math.isfinite(step(FORCE, (1e6 + n, 1.0 + n), h)[0]) for n in range(50))
    coarse = BACKWARD_EULER.phases(FORCE, (2.0, 0.0), 1.5 / PENDULUM.w0)
    assert all(math.isfinite(theta) for theta, _ in islice(coarse, 2000))


@given(z=st.floats(0.001, 5.0))
def test_the_energy_of_small_swings_changes_as_the_cards_say(z):
    gain, loss = 1 + z**4 / 4, 1 / (1 + z**2)
    factors = {HEUN: gain, EXPLICIT_MIDPOINT: gain, IMPLICIT_MIDPOINT: 1, BACKWARD_EULER: loss}
    for method, factor in factors.items():
        theta, omega = method.step(lambda angle: -angle, (0.6, 0.8), z)
        assert theta**2 + omega**2 == pytest.approx(factor, rel=1e-7)  # Newton's rounding


@each_method
@pytest.mark.parametrize(("kind", "sin"), [(lambda x: np.full(3, x), np.sin), (mp.mpf, mp.sin)])
def test_one_definition_serves_floats_arrays_and_mpmath(method, kind, sin):
    def propagate(kind, sin):
        phases = method.phases(Pendulum(kind(9.81)).force(sin), (kind(0.8), kind(-1.1)), 0.05)
        return [complex(np.ravel(value)[0]) for value in next(islice(phases, 19, None))]

    # 20 steps' rounding; their sines may differ in the last bit
    assert propagate(kind, sin) == pytest.approx(propagate(float, math.sin), abs=1e-13)


def wobbles(method, h):
    """How far the energy and the modified energy go from their starts and back, within 20 s."""
    phases = list(islice(method.on(PENDULUM)((1.0, 0.0), h), round(20 / h)))
    return (
        np.ptp([PENDULUM.energy()(phase) for phase in phases]),
        np.ptp([method.modified_energy(PENDULUM, phase, h) for phase in phases]),
    )


@pytest.mark.parametrize("method", [each for each in METHODS if each.modified_energy], ids=str)
def test_the_energy_wobbles_by_the_order_and_the_modified_energy_by_h4(method):
    (plain, modified), (finer, finer_modified) = (wobbles(method, h) for h in (0.05, 0.025))
    assert method.symplectic
    assert modified < plain / 100
    # the sampled extremes of a wobble are a few per cent off the true ones
    assert math.log2(plain / finer) == pytest.approx(method.order, abs=0.1)
    assert math.log2(modified / finer_modified) == pytest.approx(4, abs=0.1)


OURS = "esvorwqfybmdilchankpuxjgzt"  # more may be added


def marks(of):
    return "".join(each.letter for each in METHODS if each.letter in OURS and of(each))


def test_a_family_is_listed_by_its_name():
    first = {"Euler": "es", "Verlet": "vo", "Runge-Kutta": "rwq", "splitting": "fybm"}
    special = {"implicit": "di", "friction": "lc", "step doubling": "ha", "precision": "nk"}
    known = {**first, **special, "fast and slow parts": "pux", "learned": "jgzt"}
    for name, letters in known.items():
        assert marks(lambda method, name=name: family_of(method.key) == name) == letters


def test_a_method_says_what_it_is_for():
    known = {"pendulum": "esvorwqfybmdihankjgzt", "linear": "esvorwqfybmdiha"}
    known |= {"damped": "erlc", "spring": "evoripu", "mean_field": "erx"}
    for model, letters in known.items():
        assert marks(lambda method, model=model: model in method.models) == letters
    assert marks(GENERAL.__contains__) == "esvorwqfybmdi"
    without = {"any_numbers": "hankjgzt", "note": "esvor", "used": "lchakxjzt", "other_names": ""}
    without |= {"varies": "esvorwqfybmlcnkpuxjgzt", "first_same_as_last": "esorwqdihapuxjgz"}
    for field, letters in without.items():
        assert marks(lambda method, field=field: not getattr(method, field)) == letters
    assert marks(lambda method: method.hue is not None) == "esvr"
    assert [method.hue for method in USUAL_CAST] == [0, 1, 2, 3]
    assert [method.force_evaluations for method in learned.FAMILY] == [4, 4, 1, 1]
    assert IMPLICIT_MIDPOINT.phases_for(EXAMPLES["spring"].equations)[0] == "parts"


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_every_method_has_its_names_a_reference_and_a_use_with_its_source(method):
    assert all(matching(name) == [method] for name in method.names)
    assert re.search(r"\(\d{4}\)", method.reference)
    if method.used is None:
        assert not method.general
    else:
        assert re.fullmatch(r"[^\[\]]+ \[[a-z0-9-]+(\.[a-z0-9-]+)+, [^\[\]]+\]", method.used)


OTHERS = {
    "velocity_verlet": "Störmer, stormer, Störmer Verlet, leapfrog, kick-drift-kick",
    "symplectic_euler": "semi-implicit Euler, Euler-Cromer",
    "heun": "RK2, improved Euler, explicit trapezoidal rule",
    "forest_ruth": "Yoshida 4, triple jump",
    "respa": "impulse method, IVI",
}


@pytest.mark.parametrize(
    ("typed", "keys"),
    [
        *((name, [key]) for key, names in OTHERS.items() for name in names.split(", ")),
        ("rk", ["rk4"]),  # those for one scene match only if no general one does
        ("BM4", ["blanes_moan_4"]),
        ("single", []),  # a label is matched whole
        ("uler", []),  # not from the middle of a word
        ("verlet", ["velocity_verlet"]),  # another name
        ("moan", ["blanes_moan_4", "blanes_moan_6"]),  # a later word
        ("learned", ["learned_map", "learned_symplectic_map"]),
        ("", []),
    ],
)
def test_a_method_is_found_by_its_names_or_the_start_of_a_word_of_its_key(typed, keys):
    assert [method.key for method in matching(typed)] == keys


@pytest.mark.parametrize(
    ("share", "above", "kept"),
    # rad/s; ten swings lose a hundred times the share
    [(1e-16, 0, True), (1e-12, 0, False), (1e-10, 2.5, False), (1e-10, 7.5, False)],
)
def test_a_tiny_loss_is_seen_also_where_only_fast_motion_has_one(share, above, kept):
    def losing(force, phase, h):
        while True:
            theta, omega = VELOCITY_VERLET.step(force, phase, h)
            phase = theta, omega * (1 - share * (abs(omega) > above))
            yield phase

    assert measure.is_reversible(losing) == kept
    assert above > 4 or measure.is_symplectic(losing) == kept


@pytest.mark.parametrize(
    ("names", "why"),
    [
        ("moan", "may be blanes_moan_4 or blanes_moan_6"),
        ("verlt", "choose from explicit_euler, rk4, lagged_verlet, conformal_verlet"),
        ("rk4 verlet RK4", "rk4 is given twice"),
        ("taylor", "see it with pendu-tui accuracy --cost seconds"),
        ("", "for example rk4"),
        ("forward-eulr", "did you mean explicit_euler?"),
    ],
)
def test_a_name_of_no_or_of_several_methods_is_refused(names, why):
    with pytest.raises(InputError, match=why):
        all_named(names.split(), model="damped")
    with pytest.raises(InputError, match=", ".join(method.key for method in METHODS)):
        all_named(["xyzzy"])


def test_what_was_measured_is_told_in_words():
    found = measure.measured(IMPLICIT_MIDPOINT.phases)
    told = str(found._replace(order=1.9876, force_evaluations=6.54, reversible=False))
    assert told.splitlines() == [
        "order             1.988",
        "force evaluations 6.54 per step",
        "symplectic        yes",
        "reversible        no",
        "stable            at any h (small swings)",
    ]
    assert "\nstable            at no h (" in str(found._replace(linear_limit=0.0))
    assert "\nstable            up to z = h·w0 = 2.345 (" in str(found._replace(linear_limit=2.345))
