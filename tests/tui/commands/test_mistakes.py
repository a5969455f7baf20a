"""Options that make no sense are refused in one sentence, before anything is read or written."""

import shlex

import pytest

from pendu_tui.engine.methods import GENERAL
from tests.tui.command_line import pendu

MISTAKES = {
    "accuracy": {
        "--h-values 0.2:0.1": "not a list of up to 1000 step sizes … 0.2:0.001:10",
        "--methods taylor_20": "--cost seconds",
        "--all --methods rk4": "--all and --methods … choose one",
        "--target 10 --time 1": "a target of 10 … less than 1",
        "--theta 0": "at rest … no error to measure",
        "--workers 2 --cost seconds": "measured in this process",
        "--dask tcp://x:1 --cost seconds": "measured in this process",
    },
    "judge absent.csv": {
        "--temperature 0 --atoms 9": "--temperature",
        "--temperature 5": "needs --atoms",
        "--step 0.5fs --units time=ps": "--step already gives the unit of time; leave time= out",
        "again.csv --steps 1,1": "not all the same",
        "again.csv --steps 1,2,3": "one per file",
        "again.csv": "several files need --steps",
        "--steps 1": "not all the same",
        "--fail-if 'rk4.verdict == grows'": "is not understood",
        "--fail-if 'theta_error > 1'": "no field 'theta_error'",
    },
    "methods": {"rk5": "did you mean rk4?"},
    "scenes": {"crosover": "did you mean crossover?"},
    "methods --fail-if": dict.fromkeys(
        ["'verdict == grows'", "'symplectic < 1'", "'symplectic == no_'"], "--fail-if"
    ),
    "recordings": dict.fromkeys(
        ["list a", "show", "show a -o b", "recover a", "-o b"],
        "use recordings, recordings show FILE",
    ),
    "run --time 2 --methods": {
        "rk5": "no method 'rk5': did you mean rk4?",
        "nothing": "choose from explicit_euler, symplectic_euler, ",
        "nothing --scene damped": "from explicit_euler, rk4, lagged_verlet, conformal_verlet.",
        "rk4,rk4": "rk4 is given twice",
        "rk4,": "no method ''",
        "taylor_20": "--cost seconds",
        "euler": "may be explicit_euler or symplectic_euler or backward_euler",
    },
    "run --record x.mcap": {
        "--time 1 --length -1": "length",
        "--time 0.01": "shorter than one step",
        "--time 2 --h 0.05,5": "--time 2 … 5 s",
        "--time 1e9": "out of range … below 1e+09",
        "--time 1 --fail-if rk5.theta>1": "--fail-if … rk5",
        "--time 1 --fail-if energy>1": "is not understood … needs any. or a method",
        "": "--time is missing",
        "--h 0": "h = 0 s",
        "--h small": "--h: 'small' is not a time; use, for example, 0.05",
        "--theta inf": "theta = inf",
        "--theta -170": "--theta: -170 is 27.1 turns; write -170deg or -170rad",
        f"--time 1 --methods {','.join(each.key for each in GENERAL)}": "at most 6",
        "--time 1 --theta 1,2": "--record … one run",
    },
    "stability": {
        "--theta-values 4": "--theta-values … 3.14159",
        "--z-values 1,1000": "--z-values … below 1000",
        "--steps 3000000000": "--steps … 2.14748e+09",
        "--plain": "no option --plain … an option of live, tour, replay.",
        "--theta=--": "-- is not a value",
        "--thta 1": "no option --thta: did you mean --theta?",
        "--scene linear": "linear oscillator … pendu-tui methods",
    },
}


@pytest.mark.parametrize(
    ("command", "options"), [(name, each) for name, them in MISTAKES.items() for each in them]
)
def test_a_mistake_is_one_sentence_and_exit_2(command, options, here):
    words = MISTAKES[command][options].split(" … ")
    assert pendu(*shlex.split(f"{command} {options}")).refused(2, *words)
    assert not list(here.iterdir())
