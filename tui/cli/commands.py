"""The commands: what each does, the names of its options, and examples.

The names are those of OPTIONS, or in capitals of GROUPS, in tui/commands/options.py; what differs
for one command stands there under `COMMAND NAME`.  This module imports nothing of ours, because
`pendu-tui --help` prints it.  The options put the verdicts in place of {verdicts}.
"""

from collections.abc import Mapping
from typing import NamedTuple


class Command(NamedTuple):
    """A command, which `run` of the module of its name in tui/commands does."""

    about: str  # in pendu-tui --help, and the first sentence above its options
    options: str  # names, with blanks between them
    examples: str
    more: str = ""  # above its options
    place: str = ""  # MODULE:FUNCTION in tui/commands, if it is another
    defaults: Mapping[str, str] = {}  # other than those of its options


STILL = {"theme": "dark", "pixels": "braille"}
COMMANDS = {
    "live": Command(
        "the lab: methods and their errors side by side, recorded",
        "SCENE --speed --equal-cost RECORDING TERMINAL",
        """\
  pendu-tui
  pendu-tui live --theta 170deg --h 0.02 --record swing.mcap
  pendu-tui live --scene crossover --equal-cost
""",
        place="lab:live",
    ),
    "tour": Command(
        "a tour of the lab: nine short pages, with questions and their answers",
        "--no-record TERMINAL",
        """\
  pendu-tui tour

Enter continues, 1 and 2 answer, Backspace goes back, Esc leaves; T in the lab resumes the tour.
""",
        place="lab:tour",
    ),
    "replay": Command(
        "play a recording on the lab's screen",
        "file --start-at --method --speed --loop --paused --no-record TERMINAL",
        """\
  pendu-tui replay latest
  pendu-tui replay drift
  pendu-tui replay swing.mcap --start-at 12 --speed 0.5 --loop
""",
        more="Pause, step, seek, loop, play backwards, or continue live.",
        place="lab:replay",
    ),
    "snapshot": Command(
        "save the lab as an SVG image, byte-identical each time",
        "SCENE --time --size PICTURE -o --force",
        """\
  pendu-tui snapshot --time 12 -o lab.svg
  pendu-tui snapshot --scene crossover --time 40 --size 200x60 --theme light -o crossover.svg
""",
        place="lab:snapshot",
        defaults=STILL,
    ),
    "serve": Command(
        "the lab in a browser, for a class without terminals; each tab gets its own",
        "--port --host --at-most --record SCENE PICTURE",
        """\
  pendu-tui serve --port 8080 --scene crossover
  pendu-tui serve --at-most 30 --record recorded/

From another computer: ssh -L 8000:127.0.0.1:8000 HOST, then open http://127.0.0.1:8000 there.
Ctrl+C ends it.
""",
        defaults=STILL,
    ),
    "accuracy": Command(
        "speed against accuracy: which method, which h, at what cost",
        "SCENE --all --time --h-values --error --cost --target WORKERS FORM --force",
        """\
  pendu-tui accuracy --target 1e-6 --time 100
  pendu-tui accuracy --cost seconds --methods taylor_20,rk4
  pendu-tui accuracy --json | jq '.points[] | select(.method == "rk4" and .valid)'

Exit code 1: no method reaches the target.
""",
    ),
    "stability": Command(
        "where each method becomes unstable, in theory and as measured",
        "SCENE --theta-values --z-values --steps FORM --force WORKERS",
        """\
  pendu-tui stability --theta 120deg --h 0.3
  pendu-tui stability --steps 1000 -o limits.svg
  pendu-tui stability --z-values 0.005:3:600 --theta-values 1deg:179deg:300 --workers 8 -o map.csv

The CSV has every point of the map; a figure shows the limits against amplitude.
""",
    ),
    "run": Command(
        "run a scene without a screen and judge each method; for CI",
        "SCENE --time --record --sample-every --fail-if FORM --force WORKERS",
        """\
  pendu-tui run --time 100
  pendu-tui run --theta 170deg --time 60 --json | jq '.methods[] | {method, verdict}'
  pendu-tui run --time 60 --fail-if 'rk4.max_energy_error > 1% or any.verdict == grows'
  pendu-tui run --theta 10deg:170deg:17 --h 0.01:0.5:50 --time 10min --workers 4 -o runs.csv

slope: of the relative energy error, per second; |slope| is below `bound` with 99 % confidence;
share: what the slope adds up to over the run, in band widths; drift_per_second: the slope, or null
if no trend is evident

verdicts:
{verdicts}
""",
    ),
    "judge": Command(
        "judge the energies of another program, from a file or stdin; for CI",
        "files --time --energy --table --step --units --from --to --scale --atoms "
        "--temperature --steps --fail-if --json",
        """\
  pendu-tui judge energy.xvg
  pendu-tui judge md.log.gz --fail-if 'verdict != bounded' --atoms 648 --temperature 300
  pendu-tui judge log.lammps --energy KinEng+PotEng --step 1fs --units energy=kcal/mol
  pendu-tui judge a.csv b.csv --steps 1,2 --fail-if 'fluctuation_order < 1.8'
  ./game --headless | pendu-tui judge - --time 1 --energy 4 --fail-if 'max_energy_error > 1e-2'

verdicts:
{verdicts}
""",
        more="""\
FILE is a log or table from any program: CSV, LAMMPS, GROMACS, OpenMM, ASE, NAMD, Amber, CP2K, JSON,
.npz, …, compressed or not.  Without options its tables and columns are listed, and the energy is
judged if it is clear which column holds it.  Results have the units of the file's headers.
The exit code is 1 if the verdict is `failed`.
""",
    ),
    "verify": Command(
        "re-simulate recordings and compare every bit",
        "files --methods --method --max-steps --json",
        """\
  pendu-tui verify latest
  pendu-tui verify tests/recordings/ crossover.mcap
  pendu-tui verify golden

A folder means all .mcap files below it; golden, the bundled ones.
Exit codes: 0 all are identical; 1 one differs or, unless a .part, is incomplete; 3 one
is unreadable.
""",
    ),
    "export": Command(
        "write a recording as CSV, one row per sample and method",
        "file -o --force",
        """\
  pendu-tui export latest -o latest.csv
  pendu-tui export killed.mcap.part -o killed.csv
""",
    ),
    "recordings": Command(
        "list the recordings, show or recover one",
        "verb file --json RECOVER",
        """\
  pendu-tui recordings show latest
  pendu-tui recordings recover swing.mcap.part -o saved.mcap
""",
    ),
    "scenes": Command(
        "list the scenes, with what to watch",
        "name --json",
        """\
  pendu-tui scenes crossover
  pendu-tui scenes --json | jq -r '.scenes[].name'
""",
        place="lists:scenes",
    ),
    "methods": Command(
        "list the methods with claimed and measured properties",
        "names --method --fail-if --json",
        """\
  pendu-tui methods rk4 verlet
  pendu-tui methods --method mine.py:step --fail-if 'order < 1.9 or symplectic != yes'
""",
        more="A method of your own has measured properties only.",
        place="lists:methods",
    ),
    "doctor": Command(
        "check the terminal, its colours, the recordings folder and versions; suggest fixes",
        "--json",
        """\
  pendu-tui doctor --json | jq '.findings[] | select(.advice != "")'
""",
    ),
}
"""The commands by name, in the order of pendu-tui --help."""

IN_LAB = "pendu-tui live, and there F3 and the key x"
EXIT_CODE = "the exit code, or the pytest plugin and pytest --junit-xml"
WORKERS = "--workers N, or --dask ADDRESS for other machines"
COMPILED = "nothing, because compiled loops give bitwise identical results"
DROPPED = {
    "methods --methods": "the names alone",
    "replay --methods": "the keys 1 to 6, which show and hide methods",
    **dict.fromkeys(("stability --section", "stability --starts"), IN_LAB),
    "stability --map": "-o map.csv; pendu-tui live draws it with F5",
    **dict.fromkeys(("run --junit", "judge --junit"), EXIT_CODE),
    **{f"{name} --no-compiled": COMPILED for name in ("run", "accuracy")},
    "run --resume": "several lists that are shorter",
    **{f"{name} --executor": WORKERS for name in ("run", "stability", "accuracy")},
    "accuracy --budget": "--target, whose table has the cost of each method",
    "accuracy --safety": "a smaller --target",
    "export --format": "CSV, which DuckDB, polars and pandas read",
    "recordings prune": "rm; pendu-tui recordings lists the files, newest first",
    "diff": "pendu-tui verify, which names the first difference; or export both and compare",
    "live --ghost": "pendu-tui replay FILE; in the lab r keeps the run before it, dimmed",
}
"""What to use instead of a COMMAND, a `COMMAND SUBCOMMAND` or a `COMMAND --option` of before."""
