"""Layouts of the energy logs of other programs, and the names of times and energies in them.

A table that begins below its names needs no entry, whatever separates its columns: CSV, OpenMM,
ASE, CP2K's .ener, SIESTA's .MDE, Tinker's tables, GENESIS.
"""

import re
from dataclasses import dataclass
from functools import cached_property, lru_cache

from pendu_tui.tui.cli.units import UNIT, split_unit

_DECIMALS = r"\d+,\d+(?:[eE][-+]?\d+)?(?![\d.]|,\d)"  # of many languages
_DIGITS = r"(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
_SPACED = r"[-+]?\d{1,3}[^\S\t]\d{3}\b"  # 42 001
NUMBER = rf"[-+]?(?:\d*\.\d+[-+]\d{{3}}(?!\d)|{_DECIMALS}|{_DIGITS})"
"""-4.52-107 is Fortran's -4.52e-107."""
FAILED = (
    r"[-+]?(?:nan|inf(?:inity)?)(?:\([^)\s]*\)?)?|[-+]?1\.?#\w+|\*{2,}"
    r"|#¡?[A-Z/0]+[!?]|#N/?[AV]\b|Err:5\d\d"
)
"""How programs write a number that has ended: C, Microsoft C, Fortran, spreadsheets."""
VALUE = rf"(?P<value>{FAILED}|{NUMBER})"


@dataclass(frozen=True)
class Layout:
    """The look of a program's lines, for each that is not a plain row of the table before it.

    `line` is searched in the line, in any case.  Its groups say what they hold: `names` of the
    columns below; a `row`, which may begin with words; a `value`, its `name`, which is Step if
    there is none, and perhaps its `unit`; `over`, names above a line of numbers; the `place` of a
    column, from 1, or the `set` of xmgrace, from 0, and its `label`; the `units` of its other axis;
    the beginning of a new run (`part`); the `end` of the data, until they begin `again`; the
    `error` with which a program ended, if no row follows it.
    """

    programs: str
    line: str = r"(?!)"
    units: tuple[str, str] = ("", "")  # of times and energies without one
    file: str = ""  # the end of the name of a file whose first columns are `columns`
    columns: tuple[str, ...] = ()
    cells: str = ""  # finds each of the names, if neither blanks nor commas part them

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        return re.compile(self.line, re.IGNORECASE)


LAYOUTS = (
    Layout(
        programs="LAMMPS, all thermo styles",
        line=r"^(?P<part>Loop time of)|^-+ Step +(?P<value>\d+) -"
        r"|^keywords: *\[(?P<names>.*)\]|^ *- *\[ *(?P<row>.*)\]",
    ),
    Layout(
        programs="LAMMPS, units metal",
        line=r"^(?:units|  Unit style +:)\s+metal\b",
        units=("ps", "eV"),
    ),
    Layout(
        programs="LAMMPS, units real",
        line=r"^(?:units|  Unit style +:)\s+real\b",
        units=("fs", "kcal/mol"),
    ),
    Layout(
        programs="GROMACS .xvg, xmgrace",
        line=r'^@ *(?:xaxis|s(?P<set>\d+)) +(?:label|legend) +"(?P<label>[^"]*)"|^(?P<part>&)'
        r'|^@ *yaxis +label +"(?P<units>[^"]*)"',
    ),
    Layout(
        programs="GROMACS md.log",
        line=r"^(?P<over> {11}Step {11}Time\b.*"
        r"|(?= .*(?:Kinetic|Total|Conserved) En)(?: .{13}\S)+)$"
        r"|(?P<end><=+  A V E R A G E S)|^(?P<again>Started mdrun)",
        cells=".{15}",
        units=("ps", "kJ/mol"),
    ),
    Layout(
        programs="NAMD",
        line=r"^(?P<names>ETITLE:.*)|^(?P<row>ENERGY: +\S+ +[-+.\dn*].*)"
        r"|^TCL: (?P<part>Running|Minimizing) for",
        units=("", "kcal/mol"),
    ),
    Layout(
        programs="CHARMM",
        line=r"^DYNA (?P<names>DYN: .*)|^(?P<row>DYNA> .*)",
        units=("ps", "kcal/mol"),
    ),
    Layout(
        programs="Amber mden",
        line=r"^(?P<names>L0 +[A-Z].*)|^(?P<row>L0 .*)",
        units=("ps", "kcal/mol"),
    ),
    Layout(
        programs="Amber mdout",
        line=r"^ (?=NSTEP +=)|(?P<end>A V E R A G E S   O V E R)",
        units=("ps", "kcal/mol"),
    ),
    Layout(
        programs="CP2K's output",  # the head of its iterations begins no table
        line=rf"^ *MD\| +(?P<name>[A-Z].*?) {{2,}}{VALUE}|^ *(?P<again>Step +Update method)",
    ),
    Layout(
        programs="Quantum ESPRESSO .evp",
        line=r"^# *(?P<names>nfi .*)",
        units=("", "hartree"),
    ),
    Layout(
        programs="xtb",
        line=r"^ +(?P<names>time \(ps\) +<Epot>.*)",
        units=("", "hartree"),
    ),
    Layout(
        programs="VASP OSZICAR",
        line=r"^ *(?P<value>\d+) +T= ",
        units=("", "eV"),
    ),
    Layout(
        programs="Tinker",
        line=rf"^ (?P<name>[A-Z]\w+ [A-Z]\w+) {{2,}}{VALUE} +(?P<unit>{UNIT})\b",
    ),
    Layout(
        programs="Desmond, Athena",
        line=r"^# *(?P<names>(?:\[1\] *=|0:).*)",
        cells=r"(?:\[\d+\] *=|\b\d+:) *(.*?) *(?=\[\d+\] *=|\b\d+:|$)",
    ),
    Layout(
        programs="i-PI, heads of a line for each column",
        line=r"^# *(?:col(?:umn|s)?\.?)? *(?P<place>\d+)[-\d]* *(?:-->|[:=])"
        r" *(?P<label>.+?) *(?: : .*)?$",
    ),
    Layout(
        programs="PLUMED",
        line=r"^#! FIELDS +(?P<names>.*)",
    ),
    Layout(
        programs="GPUMD, which writes neither names nor times",
        file="thermo.out",
        columns=("temperature (K)", "kinetic (eV)", "potential (eV)"),
    ),
    Layout(
        programs="LAMMPS, GROMACS, NAMD and others that end with an error",
        line=rf"^(?P<error>(?:fatal )?error(?: on proc \d+)?:(?! *(?:{FAILED}|{NUMBER})\s*$).*)",
    ),
    Layout(
        programs="JSON, an object a line",
        line=rf'"(?P<name>(?!\d+")[^"]+)" *: *"?{VALUE}"?(?=\s*[,}}])',
    ),
    Layout(
        programs="prints of name value",
        line=rf"(?<!\S)(?!{FAILED}(?!\S))(?:(?:INFO|DEBUG|and|has|with) +)?"
        rf"(?P<name>[A-Z]\w{{,40}}(?: [A-Z]\w{{,40}}){{,2}}) +{VALUE}[,:]?"
        r"(?=\s*$| +(?:(?:[A-Z]\w* +){1,3}(?=(?:e|energy|quantity|time|step) ))?[A-Z]\w*"
        rf" +{NUMBER},?(?:\s*$| +(?![^\d=:]{{,60}}[=:])[A-Z]))",
    ),
    Layout(
        programs="prints of name = value or name: value; pw.x, DFTB+, NBODY6, CP2K before 8",
        line=r"(?<![\w.])(?!Unnamed:)(?:(?:INFO|DEBUG)[]:]? +|X {2,})?"
        r"(?P<name>(?:\|(?=\w))?[A-Z][^\s=:,;]{,40}"
        rf"(?: +(?:[A-Z]|[\[(+] ?\w)[^\s=:,;]{{,40}}){{,5}})"
        rf"(?: *= *\"?| *: +(?!{NUMBER}[^\S\n]+[-+.\d])| +(?={NUMBER}(?: ?s)?:\s))"
        rf"(?!{_SPACED}){VALUE}"
        rf" *[\[(]?(?P<unit>{UNIT}|%|ppm)?(?![\w/.']|:\S|,\d| +:| *=| ?[×x*·] ?10)",
    ),
)
"""The layouts, in the order in which they are tried on a line."""

ROLES = (
    ("time", r"(sim(ulat(ion|ed))?|model|md|current)time|t(ime)?sim"),
    ("time", r"time|t"),  # of the wall clock, beside these
    ("step", r"(md|time|n)?steps?(nr|number)?|nfi|ts|iter(ation)?|frame|cycle|row"),
    ("conserved", r"econ(t|served?)|cons(erved)?q(uanti)?ty|totalmdenergy|ekin\+etotconst"),
    ("conserved", r"conserved(en(ergy)?)?"),
    ("conserved", r"econs"),
    ("total", r"e?tot(al)?e(ng|ne(r(gy)?)?)?(etotal)?|e(nergy)?tot(al)?(n|peratom)?"),
    ("energy", r"e|ener(gy)?|tot(al)?|mechanical(energy)?"),  # or another quantity
    (
        "kinetic",
        r"(tot|md|current)?(ke|e?k(in(etic)?(e(ng?|ne|nergy)?)?)?|energykinetic|ektot)",
    ),
    (
        "potential",
        r"(current)?(pe|ep|u|e?pot(ential)?(e(ng?|ne|nergy)?)?|energypotential|eptot)",
    ),
    ("error", r".*e0e0|(rel(ative)?)?(d(elta)?ee0?|e(nergy)?(err(or)?|drift))"),
    ("error", r"rel(ative)?err(or)?"),
    ("mark", r"method|integrator|solver|scheme|seed|units?"),
    ("other", r"temp(erature)?|press?(ure)?|vol(ume)?|density|epair"),
)
"""Roles of columns and their names as `key` writes them; the best comes first."""


def key(name: str) -> str:
    """Return a name without its unit, in letters, digits and + alone, to compare it."""
    name = re.sub(r"^[\w.]+\.(?=\w{4,}$)|^[vcf]_", "", name.casefold())  # HOOMD, LAMMPS
    return re.sub(r"[^a-z0-9+%]", "", name)


@lru_cache(4096)
def role(name: str) -> tuple[str, int]:
    """Return the role of a column by its name, "" for none, and its rank."""
    keys = [key(split_unit(name)[0]), key(name)]
    for rank, (each, names) in enumerate(ROLES):
        if any(re.fullmatch(names, name) for name in keys):
            return each, rank
    return "", len(ROLES)


def is_energy(name: str) -> bool:
    return role(name)[0] in ("conserved", "total", "energy", "kinetic", "potential")
