"""Each layout reads its case: the lines of a head and a row, as its program writes them."""

import gzip

import pytest

from pendu_tui.tui.cli import reader
from pendu_tui.tui.cli.layouts import LAYOUTS, role
from tests.tui.cli.test_reader import ENERGIES, columns, rows, tables

LOOP = "Loop time of 0.8 on 1 procs for 50 steps with 400 atoms\n"

CASES = {
    "LAMMPS, all thermo styles": (
        "Step, TotEng",
        "",
        "------------ Step {s:14} ----- CPU = {t:12} (sec) -------------\n"
        "TotEng   = {e:14.4f} KinEng   = {k:14.4f} Temp     =       302.7782",
        LOOP,
    ),
    "LAMMPS, units metal": (
        "t ps, TotEng eV",
        "units\t\tmetal # eV\nt TotEng\n",
        "{t} {e:12.4f}",
        LOOP,
    ),
    "LAMMPS, units real": (
        "Time fs, TotEng kcal/mol",
        "  Unit style    : real\n   Step  Time  TotEng\n",
        "{s:6} {t:6} {e:12.4f}",
        LOOP,
    ),
    "GROMACS .xvg, xmgrace": (
        "Time ps, Total Energy kJ/mol",
        '@    xaxis  label "Time (ps)"\n@    yaxis  label "(kJ/mol), (K)"\n'
        '@ s0 legend "Temperature"\n@ s10 legend "Total Energy"\n',
        "{t} 302.7 1 2 3 4 5 6 7 8 9 {e}",
    ),
    "GROMACS md.log": (
        "Time ps, Conserved En. kJ/mol",
        "Started mdrun on rank 0\n           Step           Time\n\n",
        "           Step           Time\n{s:15}{t:15.5f}\n\n"
        "   Energies (kJ/mol)\n"
        "    Kinetic En.   Total Energy  Conserved En. Pressure (bar)\n"
        "    2.38143e+05   -8.81729e+05{e:15.5e}    2.97762e+03",
        "	<====  A V E R A G E S  ====>\n           Step           Time\n              0        0.00000\n",
    ),
    "NAMD": (
        "TS, TOTAL kcal/mol",
        "ETITLE:      TS           BOND         TOTAL          TEMP\n",
        "ENERGY: {s:7}       1.5     {e:14.4f}       302.7\nInfo: {s} 1 2 3",
        "1 remark with a number\n",
    ),
    "CHARMM": (
        "Time ps, TOTEner kcal/mol",
        "DYNA DYN: Step         Time      TOTEner        TOTKe       ENERgy\n"
        "DYNA PROP:             GRMS      HFCTote\n",
        "DYNA>{n:9}{t:13.5f}{e:13.5f}    283.74974-61955.58076\n"
        "DYNA PROP>         12.00000  -61671.83101",
    ),
    "Amber mden": (
        "time ps, Etot kcal/mol",
        "L0  Nsteps           time(ps)         Etot             EKinetic\n"
        "L1  Temp             T_solute\n",
        "L0 {n:9} {t:18.10E} {e:18.10E}   2.0185211324E+01\n"
        "L1    3.0277816985E+02   0.0000000000E+00",
    ),
    "Amber mdout": (
        "TIME ps, Etot kcal/mol",
        "",
        " NSTEP ={n:9}   TIME(PS) ={t:12.3f}  TEMP(K) =   300.00  PRESS =     0.0\n"
        " Etot   ={e:14.4f}  EKtot   ={k:14.4f}  EPtot      ={p:14.4f}",
        "      A V E R A G E S   O V E R    1000 S T E P S\n Etot   =     -300.0000\n",
    ),
    "CP2K's output": (
        "Time fs, Conserved quantity hartree",
        "",
        " MD| Step number {n:60}\n MD| Time [fs] {t:62}\n MD| Conserved quantity [hartree] {e:46}\n"
        "  Step     Update method      Time    Convergence         Total energy    Change"
        + 5
        * "\n     2 OT DIIS     0.80E-01    0.6     0.00010113    {p:.10f} -1.00E-03",
    ),
    "Quantum ESPRESSO .evp": (
        "time ps, econt hartree",
        "#   nfi  time(ps)        ekinc        Tcell(K)          etot          econt\n",
        "{n:7}  {t}        0.000001      0.0          -17.16   {e}",
    ),
    "i-PI, heads of a line for each column": (
        "time ps, conserved eV",
        "# column   1     --> step : The step.\n"
        "# column   2     --> time{picosecond} : The time.\n"
        "# column   3     --> conserved{electronvolt}\n",
        "  {n:.8e}  {t:.8e} {e:.8e}",
    ),
    "xtb": (
        "time ps, Etot hartree",
        "         time (ps)    <Epot>      Ekin   <T>   T     Etot\n",
        "{s:7}  {t:6.2f}   -364.99918  20.0000   300   301  {e:.5f}\n"
        "est. speed in wall clock h for 100 ps :  0.07",
    ),
    "VASP OSZICAR": (
        "Step, E eV",
        "",
        "DAV:   1     0.132E+02    0.132E+02  \n{n:7} T=   305. E= {e:.8E} F= -.2347E+03",
    ),
    "Tinker": (
        "Current Time ps, Current Kinetic+Current Potential kcal/mol",
        "",
        " Current Time      {t:16.4f} Picosecond\n Current Potential {p:16.4f} Kcal/mole\n"
        " Current Kinetic   {k:16.4f} Kcal/mole",
    ),
    "Desmond, Athena": (
        "time ps, E kcal/mol",
        "# 0:time (ps)  1:E (kcal/mol)  2:E_p  (kcal/mol)\n",
        "{t:.6f}  {e:.8f}  {p:.8f}",
    ),
    "PLUMED": ("time, energy", "#! FIELDS time energy\n", "{t} {e}"),
    "GPUMD, which writes neither names nor times": (
        "row, kinetic+potential eV",
        "",
        "3.0e+02  {k:.8e}  {p:.8e}  0.1  10.0",
    ),
    "JSON, an object a line": ("t, E", "", '{{"t":{t},"h":"a","E":{e}}}'),
    "prints of name value": (
        "time, total energy",
        "",
        "[{n}/90] step {s}, time {t}, total energy {e} kinetic energy {k}",
    ),
    "LAMMPS, GROMACS, NAMD and others that end with an error": (
        "t, E",
        "",
        "t = {t}, E = {e}\nError: {k}",
        "ERROR: Lost atoms: original 648 current 612\n",
    ),
    "prints of name = value or name: value; pw.x, DFTB+, NBODY6, CP2K before 8": (
        "time ps, Ekin + Etot (const) Ry",
        "",
        "     kinetic energy (Ekin) =    {k} Ry\n     time = {t:.5f} pico-seconds\n"
        "     Ekin + Etot (const)   =  {e} Ry",
    ),
}


NAMES = """\
time: SimTime, simulation time, simulated time, Model Time, MD time, Current Time, tsim, time (sim)
time: Time (ps), t
step: Step, MD step, timestep, nsteps, Step Nr., step number, nfi, TS, iter, iteration, frame, \
cycle, row
conserved: Econt, EConserve, EConserved, Cons Qty, Conserved quantity, Total MD Energy, Ekin + \
Etot (const)
conserved: Conserved, Conserved En., conserved energy
conserved: ECons
total: TotE, E_TotE, TotEng, TOTEner, totEnergy, Total E, ETotalE, Total Ene, Total Energy, Etot, \
Energy tot, E_total, Etot/N, Etot per atom
energy: E, Ener, energy, tot, total, mechanical, mechanical energy
kinetic: KE, v_ke, K, Ek, Kin., Ekin, KinEng, kinetic, EKinetic, Kinetic E, Kinetic En., Kinetic \
Ene, Kinetic Energy, Energy kinetic, EKtot, TOTKe, MD kinetic, Current Kinetic
potential: PE, c_pe, f_ep, U, Pot., Epot, PotEng, potential, EPotential, Potential E, Potential \
En., Potential Ene, md.Potential_Energy, Energy potential, EPtot, Current Potential
error: dE/E, |dE/E0|, delta E/E0, rel dE/E, relative dE/E, (E-E0)/E0, |E(t)-E0|/E0, E err, energy \
error, energy drift, rel. E error, relative energy error
error: rel err, relative error
mark: method, integrator, solver, scheme, seed, unit, units
other: Temp, Temperature, Pres, Press, Pressure, Vol, Volume, Density, E_pair
: strain energy, wall time, E2, run, run_id
"""


def test_each_role_has_many_names_and_the_best_comes_first():
    for rank, line in enumerate(NAMES.splitlines()):
        kind, _, names = line.partition(": ")
        assert {role(name) for name in names.split(", ")} == {(kind, rank)}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_each_layout_reads_its_case(layout):
    found, head, row, *foot = CASES[layout.programs]
    text = "".join([head, rows(row), *foot])
    series = tables(gzip.compress(text.encode()), layout.file and f"{layout.file}.gz")[-1]
    assert columns(series) == found
    assert list(series.energies) == pytest.approx(ENERGIES, abs=0.006)
    assert (len(series.times), series.skipped) == (90, 0)


def test_columns_without_names_of_their_own_are_named_in_their_order():
    (series,) = tables(rows("3e2 {t} {e} 0.1 10.0"), "thermo.out", energy="potential (eV)")
    assert series.energies == pytest.approx(ENERGIES, abs=0.006)


def test_names_above_a_line_of_values_are_not_those_of_the_next_line():
    _, head, frame, _ = CASES["GROMACS md.log"]
    (series,) = tables(head + rows(f"{frame}\n1 2 3 4"))
    assert list(series.energies) == pytest.approx(ENERGIES, abs=0.006)


@pytest.mark.parametrize("first", ["ERROR on proc 12: Lost atoms", "Fatal error:"])
def test_of_the_errors_that_end_a_log_the_first_is_told(first):
    form = "t = {t}, E = {e}"
    text = (
        rows(form, 0, 40)
        + "ERROR: a retry\n"
        + rows(form, 40)
        + f"Error: nan \n{first}\nERROR: MPI abort follows\n"
    )
    (series,) = tables(text)
    assert series.sheet.error == first


MORE = [
    ("", "Start\n" + LOOP, "t = {t}, E = {e}"),
    ("", "t,E\n", "{t},{e}\n{t}1,\n{t}2,"),
    ("", "", "t = {t}, E = {e}\n1 O {t} {e}\n2 H {e} {t}"),
    ("", "t,E\n", "t,E\n{t},{e}\n{t}1,{e}\n{t}2,{e}"),
    ("", "t,E\n", "{t},{e}\nsaved as file"),
]


@pytest.mark.parametrize("case", [*CASES.values(), *MORE])
def test_few_lines_of_a_long_log_are_read_one_by_one(case, monkeypatch):
    read = []
    new = reader._Text._read_new
    monkeypatch.setattr(reader._Text, "_read_new", lambda *line: (read.append(line), new(*line)))
    text = (case[1] + rows(case[2])) * 30
    monkeypatch.setattr(reader, "MAX_LINES_BEFORE", 200)
    tables(text + LOOP + text)
    assert len(read) < text.count("\n") / 4
