"""Learn a pendulum from noisy measurements: as a field, a Hamiltonian, a map, a symplectic map.

python -m tests.bench.learn writes engine/methods/learned.toml.

600 states of a pendulum with w0² = 9.81 s⁻², below 0.9 of the separatrix's energy, are measured with
their derivatives, with noise of 2 % of each one's root mean square.  Field and Hamiltonian are sums
of the same 60 random features tanh(a theta + b omega/w0 + c), each fitted by one least-squares
problem.  The field has two sums, for theta' and omega'; the Hamiltonian has one, whose derivatives
are the field.

The maps learn a step of w0 t = TAU, with a measured state and its derivative as the middle of the
step.  The plain map moves (theta, omega/w0) by TAU times two sums of the 60 features of
its start.  The symplectic one is a SympNet of three gradient modules (Jin et al., Neural Networks
132 (2020) 166): half a kick by a function of theta, a drift by one of omega/w0, half a kick.  Its
coefficients are found by Gauss-Newton steps.
"""

import textwrap
from pathlib import Path

import numpy as np

FEATURES = 60
POINTS = 600
NOISE = 0.02
SEED = 1
TAU = 0.1  # w0 t of a learned map
UNITS = 20  # of each function of the symplectic map
GAUSS_NEWTON_STEPS = 4
RIDGE = 1e-3  # relative; keeps the coefficients small, so that few digits suffice
NUMBERS = Path(__file__).parents[2] / "engine/methods/learned.toml"
ABOUT = {
    "FEATURES": "a, b and c of each feature tanh(a theta + b omega/w0 + c).",
    "FIELD": "Its coefficients in theta'/w0 and in omega'/w0².",
    "HAMILTONIAN": "Its coefficient in H/w0².",
    "MAP": "Its coefficients in what a step of w0 t adds to theta and omega/w0, over w0 t.",
    "KICK": "a, c and k of each k tanh(a theta + c), of which omega/w0 is kicked by the sum.",
    "DRIFT": "b, c and k of each k tanh(b omega/w0 + c), of which theta drifts by the sum.",
}


def measurements(random, count, noise):
    """Return states (theta, omega/w0) and their derivatives with respect to w0 t, (count, 2)."""
    states = random.uniform((-np.pi, -2), (np.pi, 2), (20 * count, 2))
    energies = states[:, 1] ** 2 / 2 + 1 - np.cos(states[:, 0])
    states = states[energies < 1.8][:count]
    rates = np.stack((states[:, 1], -np.sin(states[:, 0])), 1)
    return states, rates + noise * np.sqrt((rates**2).mean(0)) * random.standard_normal(rates.shape)


def fitted(matrix, target):
    """Return the least-squares coefficients, with a ridge relative to each column's norm."""
    scale = np.sqrt((matrix**2).sum(0))
    ridge = np.vstack((matrix / scale, RIDGE * np.eye(matrix.shape[1])))
    padded = np.concatenate((target, np.zeros(matrix.shape[1])))
    return np.linalg.lstsq(ridge, padded, rcond=None)[0] / scale


def learned(seed):
    """Return the numbers of each name in ABOUT, a row for each feature or unit."""
    random = np.random.default_rng(seed)
    weights = np.round(random.normal(0, 1, (FEATURES, 2)), 3)
    biases = np.round(random.uniform(-2, 2, FEATURES), 3)
    states, rates = measurements(random, POINTS, NOISE)

    def two_sums(places):
        features = np.tanh(places @ weights.T + biases)
        return np.stack([fitted(features, rate) for rate in rates.T], 1)

    slopes = 1 - np.tanh(states @ weights.T + biases) ** 2
    energy_slopes = np.vstack((slopes * weights[:, 1], -slopes * weights[:, 0]))
    starts = states - TAU / 2 * rates
    kick, drift = symplectic_map(random, states, rates, starts)
    return {
        "FEATURES": np.column_stack((weights, biases)),
        "FIELD": two_sums(states),
        "HAMILTONIAN": fitted(energy_slopes, rates.T.ravel())[:, None],
        "MAP": two_sums(starts),
        "KICK": kick.T,
        "DRIFT": drift.T,
    }


def symplectic_map(random, states, rates, starts):
    """Return kick and drift with rows a, c, coefficient."""
    slopes = np.round(random.normal(0, 1, (2, UNITS)), 3)
    offsets = np.round(random.uniform(-2, 2, (2, UNITS)), 3)
    kick, drift = (
        fitted(np.tanh(np.multiply.outer(states[:, k], slopes[k]) + offsets[k]), rates[:, 1 - k])
        for k in (0, 1)
    )
    coefficients = np.concatenate((kick, drift))
    target = rates.T.ravel()

    def modules(numbers):
        return np.stack((slopes, offsets, numbers.reshape(2, UNITS)), 1)

    def moved(numbers):
        return ((symplectic_step(modules(numbers), starts) - starts) / TAU).T.ravel()

    units = np.eye(2 * UNITS)
    for _ in range(GAUSS_NEWTON_STEPS):
        columns = [moved(coefficients + 1e-30j * unit).imag / 1e-30 for unit in units]
        jacobian = np.stack(columns, 1)
        residual = target - moved(coefficients)
        coefficients = fitted(jacobian, residual + jacobian @ coefficients)
    return modules(coefficients)


def symplectic_step(modules, states):
    """Return states after a step; `modules` has the rows a, c, coefficients of kick and drift."""

    def module(which, x):
        a, c, coefficients = modules[which]
        return np.tanh(np.multiply.outer(x, a) + c) @ coefficients

    theta, omega = states.T
    omega = omega + TAU / 2 * module(0, theta)
    theta = theta + TAU * module(1, omega)
    omega = omega + TAU / 2 * module(0, theta)
    return np.stack((theta, omega), 1)


def main():
    parts = [
        "# Weights that tests/bench/learn.py learned from 600 noisy measurements, w0² = 9.81 s⁻²."
    ]
    for name, rows in learned(SEED).items():
        numbers = " ".join(",".join(f"{number:g}" for number in row) for row in rows)
        lines = textwrap.fill(numbers, width=100, break_on_hyphens=False)
        parts.append(f'\n# {ABOUT[name]}\n{name} = """\n{lines}\n"""')
    NUMBERS.write_text("\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
