"""What the commands print, and the help of their options, word by word."""

import json
import re
import shlex

import pytest

from pendu_tui.tui.cli.commands import COMMANDS
from pendu_tui.tui.commands.options import OPTIONS, completion_parser, parser_of
from tests.recordings.examples import record, two_runs
from tests.recordings.test_verify import altered
from tests.tui.command_line import own_method, pendu, shortened

QUICK = "--time 5 --h-values 0.2:0.02:4"
FEW = "--steps 300 --z-values 0.1:3:12 --theta-values 0.5,2"
PRINTED = """\
--help
scenes
run --time 60
run damped --time 20 --h 0.2 --fail-if 'rk4.verdict != bounded or any.theta_error > 1e-3'
run stiff-slow --time 5
run halving --time 20 --methods halving_v,verlet
run --theta 1e-150 --time 1500 --methods explicit_euler --fail-if 'explicit_euler.theta < 0'
run --theta 0.5,1.2345 --h 0.05,0.1 --length 1 --time 9 --methods rk4,verlet --fail-if 'rk4.slope < -1e-5'
accuracy {QUICK} --target 1e-4 --methods rk4,verlet,euler-cromer
accuracy --all --error energy --time 2.5 --h-values 0.2:0.05:2
stability {FEW}
stability --steps 1000 --z-values 0.01,0.02 --theta-values 1 --h 0.005 --methods rk4 --method {MINE}
methods explicit_e symplectic rk4 heun forest_ruth backward_euler halving_verlet
scenes crossover
scenes crossover --json
recordings
recordings show a
recordings show cut
recordings recover cut -o {FOLDER}/saved.mcap
verify {FOLDER}
verify b cut
verify b --max-steps 3
verify b --methods rk4,s
verify b --methods rk4,verlet
verify {FOLDER}/killed.mcap.part a absent
run stiff-slow --time 0.1 --methods rk4 --record {FOLDER}/spring.mcap
verify {FOLDER}/spring.mcap --methods s
run --time 2 --methods rk4,verlet --json
run halving --theta 1,2 --time 1 --methods halving_v --json
accuracy {QUICK} --methods rk4,explicit_euler --error energy --target 1e-3 --json
stability --steps 50 --z-values 0.1,0.5 --theta-values 1 --methods explicit_euler,rk4 --json
methods rk4 backward_euler --json
recordings show cut --json
verify b cut --json
verify a absent --json
"""
HEADS = """\
run --time 1 --csv
run --theta 1,2 --time 1 --csv
run damped --time 1 --csv
accuracy {QUICK} --csv
stability --steps 50 --z-values 0.1:3:4 --theta-values 0.5,2 --csv
run mean-field --time 1 --csv
export cut
export {FOLDER}/spring.mcap
"""


@pytest.fixture
def library(here, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    record(here / "a.mcap", two_runs())
    record(here / "b.mcap", altered(two_runs(), 3, 2, omega=-5.0))
    cut = record(here / "cut.mcap", two_runs())
    cut.write_bytes(cut.read_bytes()[:-40])
    (here / "killed.mcap.part").write_bytes(cut.read_bytes())
    return here


def test_outputs(snapshot, library):
    texts = []
    mine = shlex.quote(own_method(library))
    for lines, most in ((PRINTED, None), (HEADS, 33)):
        for line in lines.splitlines():
            filled = line.format(QUICK=QUICK, FEW=FEW, FOLDER=library.as_posix(), MINE=mine)
            outcome = pendu(*shlex.split(filled))
            shown = outcome.out.splitlines()[:most]
            texts += ["", f"$ {line}", *shown, f"[{outcome.code}] {outcome.err.strip()}"]
    text = "\n".join(each.rstrip() for each in texts)
    for folder in (json.dumps(str(library)).strip('"'), str(library)):
        text = text.replace(folder, "FOLDER").replace("FOLDER\\\\", "FOLDER/")
    text = text.replace("FOLDER\\", "FOLDER/")
    text = re.sub(r'("(wall_seconds|bytes|compiled|computed)":) .*', r"\1 N", shortened(text))
    text = re.sub(r"in \d+\.\d+ s$", "in N s", text, flags=re.MULTILINE)
    text = re.sub(r"\d+\.\d kB", "N kB", text)  # of a version's name and a library that compresses
    snapshot("outputs.txt", re.sub(r"computed .*", "computed X", text) + "\n")


def read_by(read, text):
    try:
        return re.sub(r"\w+Path", "Path", repr(read(text)))
    except ValueError:
        return ""


def test_options(snapshot):
    assert "\n  grows: " in pendu("run", "--help").out
    texts = []
    for name, each in OPTIONS.items():
        value = "|".join([each.get("metavar") or "", *each.get("choices", ())])
        read = " ".join(read_by(each.get("type", bool), text) for text in ("1", "0", "-1"))
        more = f"({each.get('default', '')}) {each.get('nargs', '')} [{read}]"
        texts.append(f"{name} {value} {more}: {each['help'] % each}")
    for name in COMMANDS:
        parser = parser_of(name)
        texts += [f"\n{name}: {parser.description}", parser.epilog, f"{parser._defaults}"]
        for group in (*parser._action_groups, *parser._mutually_exclusive_groups):
            members = group._group_actions
            names = [f"{each.dest} {getattr(each, 'complete', '')}".strip() for each in members]
            texts.append(f"{group.title} ({group.description}) {', '.join(names)}".strip())
    completed = completion_parser()
    (commands,) = completed._subparsers._group_actions
    texts += ["\ncompleted", *completed._option_string_actions]
    for each in commands._choices_actions:
        names = commands.choices[each.dest]._option_string_actions
        texts.append(f"{each.dest} ({each.help}) {' '.join(names)}")
    snapshot("options.txt", "\n".join(texts) + "\n")
