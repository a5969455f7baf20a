"""Learn a pendulum from noisy measurements: as a field, a Hamiltonian, a map, and a symplectic map.

Prints how good they are.

python -m tests.bench.learn writes one JSON object; with --write it also writes engine/methods/learned_numbers.py.

600 states of a pendulum with w0² = 9.81 s⁻², below 0.9 of the separatrix's energy, are measured with their
derivatives, with noise of 2 % of each one's root mean square.  Both models are a sum of the same 60 random features
tanh(a theta + b omega/w0 + c), fitted by one least-squares problem each: the field has two sums, one for theta' and
one for omega', the Hamiltonian one, whose slopes are the field.  No network, no optimiser.

The maps learn a step of w0 t = TAU.  A state and its derivative, measured, are taken as the middle of such a step.
The plain map moves (theta, omega/w0) by TAU times two sums of the 60 features of its start.  The symplectic one is a
SympNet of three gradient modules (Jin et al., Neural Networks 132 (2020) 166): half a kick by a function of theta, a
drift by one of omega/w0, half a kick.  Its coefficients are found by Gauss-Newton steps.
"""

import json
import sys
from pathlib import Path

import numpy as np

W0 = 9.81**0.5
FEATURES, POINTS, NOISE, SEED = 60, 600, 0.02, 1
TAU = 0.1  # w0 t of a learned map
UNITS = 20  # of each function of the symplectic map
GAUSS_NEWTON_STEPS = 4
RIDGE = 1e-3  # relative: keeps the coefficients small, so that few digits are enough
NUMBERS = Path(__file__).parents[2] / "engine/methods/learned_numbers.py"


def measurements(random, count, noise):
    """States (theta, omega/w0) and their derivatives with respect to w0 t."""
    states = random.uniform((-np.pi, -2), (np.pi, 2), (20 * count, 2))
    energies = states[:, 1] ** 2 / 2 + 1 - np.cos(states[:, 0])
    states = states[energies < 1.8][:count]
    rates = np.stack((states[:, 1], -np.sin(states[:, 0])), 1)
    return states, rates + noise * np.sqrt((rates**2).mean(0)) * random.standard_normal(rates.shape)


def fitted(matrix, target):
    """Least squares with a little ridge, in the columns' own scale."""
    scale = np.sqrt((matrix**2).sum(0))
    ridge = np.vstack((matrix / scale, RIDGE * np.eye(matrix.shape[1])))
    return (
        np.linalg.lstsq(ridge, np.concatenate((target, np.zeros(matrix.shape[1]))), rcond=None)[0]
        / scale
    )


def learned(seed):
    """The features (a, b, c), the two sums of the field, and the one of the Hamiltonian."""
    random = np.random.default_rng(seed)
    weights = np.round(random.normal(0, 1, (FEATURES, 2)), 3)
    biases = np.round(random.uniform(-2, 2, FEATURES), 3)
    states, rates = measurements(random, POINTS, NOISE)
    features = np.tanh(states @ weights.T + biases)
    slopes = 1 - features**2
    theta, omega = (fitted(features, rate) for rate in rates.T)
    energy = fitted(
        np.vstack((slopes * weights[:, 1], -slopes * weights[:, 0])),
        np.concatenate((rates[:, 0], rates[:, 1])),
    )
    return weights, biases, theta, omega, energy


def learned_maps(seed):
    """The plain map's two sums of the same features, and the symplectic one's (a, c, coefficient): kick and drift."""
    random = np.random.default_rng(seed)
    weights = np.round(random.normal(0, 1, (FEATURES, 2)), 3)
    biases = np.round(random.uniform(-2, 2, FEATURES), 3)
    states, rates = measurements(random, POINTS, NOISE)
    starts = states - TAU / 2 * rates
    features = np.tanh(starts @ weights.T + biases)
    plain = np.stack([fitted(features, rate) for rate in rates.T], 1)
    slopes = np.round(random.normal(0, 1, (2, UNITS)), 3)
    offsets = np.round(random.uniform(-2, 2, (2, UNITS)), 3)
    kick, drift = (
        fitted(np.tanh(np.multiply.outer(states[:, k], slopes[k]) + offsets[k]), rates[:, 1 - k])
        for k in (0, 1)
    )
    coefficients = np.concatenate((kick, drift))
    target = np.concatenate((rates[:, 0], rates[:, 1]))

    def moved(numbers):
        modules = np.stack((slopes, offsets, numbers.reshape(2, UNITS)), 1)
        return ((symplectic_step(modules, starts) - starts) / TAU).T.ravel()

    for _ in range(GAUSS_NEWTON_STEPS):
        jacobian = np.stack(
            [moved(coefficients + 1e-30j * unit).imag / 1e-30 for unit in np.eye(2 * UNITS)], 1
        )
        left = target - moved(coefficients)
        coefficients = fitted(jacobian, left + jacobian @ coefficients)
    return plain, np.stack((slopes, offsets, coefficients.reshape(2, UNITS)), 1)


def symplectic_step(modules, states):
    """A step of the symplectic map; `modules` has the rows a, c and the coefficients of kick and drift."""

    def module(which, x):
        a, c, coefficients = modules[which]
        return np.tanh(np.multiply.outer(x, a) + c) @ coefficients

    theta, omega = states.T
    omega = omega + TAU / 2 * module(0, theta)
    theta = theta + TAU * module(1, omega)
    omega = omega + TAU / 2 * module(0, theta)
    return np.stack((theta, omega), 1)


def rates_of(model, hamiltonian):
    weights, biases, theta, omega, energy = model

    def rate(states):
        features = np.tanh(states @ weights.T + biases)
        if not hamiltonian:
            return np.stack((features @ theta, features @ omega), -1)
        slopes = (1 - features**2) * energy
        return np.stack((slopes @ weights[:, 1], -slopes @ weights[:, 0]), -1)

    return rate


def energy_errors(model, hamiltonian, starts=(0.5, 1.0, 1.5, 2.0), time=100.0, h=0.05):
    """The largest relative error of the true energy in the first half of the time and in all of it, by start."""
    rate, y = rates_of(model, hamiltonian), np.array([(start, 0.0) for start in starts])
    first = 1 - np.cos(y[:, 0])
    halves = np.zeros((2, len(starts)))
    with np.errstate(all="ignore"):
        for step in range(round(time * W0 / h)):
            k1 = rate(y)
            k2 = rate(y + h / 2 * k1)
            k3 = rate(y + h / 2 * k2)
            k4 = rate(y + h * k3)
            y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            error = np.abs((y[:, 1] ** 2 / 2 + 1 - np.cos(y[:, 0])) / first - 1)
            half = int(step * h > time * W0 / 2)
            halves[half] = np.fmax(halves[half], error)
    return halves[0], np.fmax(*halves)


def field_error(model, hamiltonian):
    """The root mean square error of the field where it was measured, relative."""
    states, rates = measurements(np.random.default_rng(99), 2000, 0.0)
    found = rates_of(model, hamiltonian)(states)
    return float(np.sqrt(((found - rates) ** 2).mean() / (rates**2).mean()))


def text(model, maps):
    """The module that holds the numbers."""
    weights, biases, theta, omega, energy = model
    plain, (kick, drift) = maps
    columns = {
        "FEATURES": " ".join(
            f"{a:g},{b:g},{c:g}" for (a, b), c in zip(weights, biases, strict=True)
        ),
        "FIELD": " ".join(f"{t:.6g},{o:.6g}" for t, o in zip(theta, omega, strict=True)),
        "HAMILTONIAN": " ".join(f"{e:.6g}" for e in energy),
        "MAP": " ".join(f"{t:.6g},{o:.6g}" for t, o in plain),
        "KICK": " ".join(f"{a:g},{c:g},{k:.6g}" for a, c, k in kick.T),
        "DRIFT": " ".join(f"{b:g},{c:g},{k:.6g}" for b, c, k in drift.T),
    }
    about = {
        "FEATURES": "a, b and c of each feature tanh(a theta + b omega/w0 + c).",
        "FIELD": "Its coefficients in theta'/w0 and in omega'/w0².",
        "HAMILTONIAN": "Its coefficient in H/w0².",
        "MAP": "Its coefficients in what a step of w0 t adds to theta and omega/w0, over w0 t.",
        "KICK": "a, c and k of each k tanh(a theta + c), of which omega/w0 is kicked by the sum.",
        "DRIFT": "b, c and k of each k tanh(b omega/w0 + c), of which theta drifts by the sum.",
    }
    lines = [
        '"""What tests/bench/learn.py learned from 600 noisy measurements of a pendulum with w0² = 9.81 s⁻²."""'
    ]
    for name, numbers in columns.items():
        lines += ["", f'{name} = """']
        line = ""
        for number in numbers.split():
            if len(line) + len(number) > 110:
                lines.append(line)
                line = ""
            line = f"{line} {number}" if line else number
        lines += [line, '"""', f'"""{about[name]}"""']
    return "\n".join(lines) + "\n"


def main():
    model = learned(SEED)
    maps = learned_maps(SEED)
    if "--write" in sys.argv:
        NUMBERS.write_text(text(model, maps), encoding="utf-8")
    many = {
        h: np.array([energy_errors(learned(seed), h) for seed in range(12)]) for h in (False, True)
    }
    report = {}
    for hamiltonian, name in ((False, "field"), (True, "hamiltonian")):
        runs = many[hamiltonian]
        report[name] = {
            "field_error": field_error(model, hamiltonian),
            "energy_errors": energy_errors(model, hamiltonian)[1].tolist(),
            "median_of_seeds": float(np.median(runs[:, 1])),
            "worst_of_seeds": float(runs[:, 1].max()),
            "grows_in_the_second_half": float(np.median(runs[:, 1] / runs[:, 0])),
        }
    report["bytes"] = len(text(model, maps))
    report["largest_coefficient"] = float(max(np.abs(part).max() for part in model[2:]))
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
