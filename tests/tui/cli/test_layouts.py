"""Each layout reads its case: a few lines as its program writes them, and what is found in them."""

import io

import pytest

from pendu_tui.tui.cli.layouts import LAYOUTS
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Series, Wanted

CASES = {
    "LAMMPS, all thermo styles": (
        "2 rows, Step, TotEng",
        """\
------------ Step              0 ----- CPU =            0 (sec) -------------
TotEng   =      -344.9992 KinEng   =        20.1852 Temp     =       302.7782
------------ Step             50 ----- CPU =         0.08 (sec) -------------
TotEng   =      -345.0040 KinEng   =        20.1280 Temp     =       301.9194
Loop time of 0.8 on 1 procs for 50 steps with 400 atoms
""",
    ),
    "LAMMPS, units metal": (
        "2 rows, Time [ps], TotEng [eV]",
        """\
units metal
   Step  Time  TotEng
      0  0.00  -344.9992
     50  0.05  -345.0040
Loop time of 0.8 on 1 procs for 50 steps with 400 atoms
""",
    ),
    "LAMMPS, units real": (
        "2 rows, Time [fs], TotEng [kcal/mol]",
        """\
  Unit style    : real
   Step  Time  TotEng
      0  0.0  -344.9992
     50  50.  -345.0040
Loop time of 0.8 on 1 procs for 50 steps with 400 atoms
""",
    ),
    "GROMACS .xvg, xmgrace": (
        "2 rows, Time [ps], Total Energy [kJ/mol]",
        """\
@    xaxis  label "Time (ps)"
@    yaxis  label "(kJ/mol), (K)"
@ s0 legend "Total Energy"
@ s1 legend "Temperature"
0.0 -344.9991 302.7
0.5 -345.0040 301.9
""",
    ),
    "GROMACS md.log": (
        "2 rows, Time [ps], Conserved En. [kJ/mol]",
        """\
           Step           Time
              0        0.00000

   Energies (kJ/mol)
    Kinetic En.   Total Energy  Conserved En.    Temperature Pressure (bar)
    2.38143e+05   -8.81729e+05   -8.81729e+05    2.84002e+02    2.97762e+03
           Step           Time
            500        1.00000

    Kinetic En.   Total Energy  Conserved En.    Temperature Pressure (bar)
    2.38143e+05   -8.81728e+05   -8.81728e+05    2.84002e+02    2.97762e+03
""",
    ),
    "NAMD": (
        "2 rows, TS, TOTAL [kcal/mol]",
        """\
ETITLE:      TS           BOND         TOTAL          TEMP
ENERGY:       0       1.5             -344.9991       302.7
Info: a remark with 1 number
ENERGY:      50       1.5             -345.0040       301.9
""",
    ),
    "CHARMM": (
        "2 rows, Time [ps], TOTEner [kcal/mol]",
        """\
DYNA DYN: Step         Time      TOTEner        TOTKe       ENERgy
DYNA PROP:             GRMS      HFCTote        HFCKe       EHFCor
DYNA>        0      0.00000-61671.83101    283.74974-61955.58076
DYNA PROP>         12.00000  -61671.83101    283.74974    0.00000
DYNA>      100      0.10000-61671.83102    283.74974-61955.58076
""",
    ),
    "Amber mden": (
        "2 rows, time [ps], Etot [kcal/mol]",
        """\
L0  Nsteps           time(ps)         Etot             EKinetic
L1  Temp             T_solute         T_solv           Pres_scal_solu
L0         0   0.0000000000E+00  -3.4499917506E+02   2.0185211324E+01
L1    3.0277816985E+02   0.0000000000E+00   0.0000000000E+00   1.0000000000E+00
L0       100   5.0000000000E-01  -3.4500404117E+02   2.0127962207E+01
""",
    ),
    "Amber mdout": (
        "2 rows, TIME [ps], Etot [kcal/mol]",
        """\
 NSTEP =        0   TIME(PS) =       0.000  TEMP(K) =   300.00  PRESS =     0.0
 Etot   =     -344.9992  EKtot   =       20.0000  EPtot      =     -365.0000
 NSTEP =      100   TIME(PS) =       0.200  TEMP(K) =   300.00  PRESS =     0.0
 Etot   =     -344.9993  EKtot   =       20.0000  EPtot      =     -365.0000
""",
    ),
    "CP2K's output": (
        "2 rows, Time [fs], Conserved quantity [hartree]",
        """\
 MD| Step number                                                               1
 MD| Time [fs]                                                          0.500000
 MD| Conserved quantity [hartree]                            -0.343232465525E+02
 MD| Step number                                                               2
 MD| Time [fs]                                                          1.000000
 MD| Conserved quantity [hartree]                            -0.343232465526E+02
""",
    ),
    "Quantum ESPRESSO .evp": (
        "2 rows, time [ps], econt [hartree]",
        """\
#   nfi  time(ps)        ekinc        Tcell(K)     Tion(K)          etot          econt
      1  0.000121        0.000001      0.0          300.0        -17.16           -17.15
      2  0.000242        0.000002      0.0          300.0        -17.17           -17.15
""",
    ),
    "i-PI, heads of a line for each column": (
        "2 rows, time [ps], conserved [eV]",
        """\
# column   1     --> step : The current simulation time step.
# column   2     --> time{picosecond} : The elapsed simulation time.
# column   3     --> conserved{electronvolt} : The conserved quantity.
  0.00000000e+00  0.00000000e+00 -3.4499917506e+02
  1.00000000e+00  5.00000000e-04 -3.4500404117e+02
""",
    ),
    "xtb": (
        "2 rows, time [ps], Etot [hartree]",
        """\
         time (ps)    <Epot>      Ekin   <T>   T     Etot
      0    0.00   -364.99918  20.0000   300   301  -344.99918
est. speed in wall clock h for 100 ps :  0.07
    200    0.20   -365.00404  20.0000   300   301  -345.00404
""",
    ),
    "VASP OSZICAR": (
        "2 rows, Step, E [eV]",
        """\
DAV:   1     0.132E+02    0.132E+02   -0.234E+03   96   0.342E+02
      1 T=   305. E= -.23418414E+03 F= -.2347E+03 E0= -.2347E+03  EK= 0.586E+00 SP= 0.00E+00
      2 T=   302. E= -.23418412E+03 F= -.2347E+03 E0= -.2347E+03  EK= 0.580E+00 SP= 0.00E+00
""",
    ),
    "Tinker": (
        "2 rows, Current Time [ps], Current Kinetic+Current Potential [kcal/mol]",
        """\
 Current Time               0.1000 Picosecond
 Current Potential       -365.1844 Kcal/mole
 Current Kinetic           20.1852 Kcal/mole
 Current Time               0.2000 Picosecond
 Current Potential       -365.1320 Kcal/mole
 Current Kinetic           20.1280 Kcal/mole
""",
    ),
    "Desmond, Athena": (
        "2 rows, time [ps], E [kcal/mol]",
        """\
# 0:time (ps)  1:E (kcal/mol)  2:E_p  (kcal/mol)
0.000000  -344.99917506  -365.18438638
0.500000  -345.00404117  -365.13200338
""",
    ),
    "PLUMED": (
        "2 rows, time, energy",
        """\
#! FIELDS time energy
0.0 -344.99
0.5 -345.01
""",
    ),
    "GPUMD, which writes neither names nor times": (
        "2 rows, row, kinetic+potential [eV]",
        """\
3.0e+02  2.0185e+01  -3.6518e+02  0.1  0.1  0.1  10.0  10.0  10.0
3.0e+02  2.0128e+01  -3.6513e+02  0.1  0.1  0.1  10.0  10.0  10.0
""",
    ),
    "JSON, an object a line": (
        "2 rows, t, E",
        '{"t":0.0,"h":"a","E":-344.9}\n{"t":0.5,"h":"b","E":-345.1}\n',
    ),
    "prints of name value": (
        "2 rows, time, energy",
        """\
[1/9] step 0, time 0.000, energy -3.4
[2/9] step 5, time 0.500, energy -3.5
""",
    ),
    "prints of name = value or name: value; pw.x, DFTB+, NBODY6, CP2K before 8": (
        "2 rows, time [ps], Ekin + Etot (const) [Ry]",
        """\
     kinetic energy (Ekin) =    20.18521132 Ry
     time = 0.00000 pico-seconds
     Ekin + Etot (const)   =  -344.99917506 Ry
     kinetic energy (Ekin) =    20.12796221 Ry
     time = 0.00050 pico-seconds
     Ekin + Etot (const)   =  -345.00404117 Ry
""",
    ),
}


def described(series: Series) -> str:
    """Return how many rows a table has, and its time and energy with their units."""
    groups = (series.choice.time, series.choice.energy)
    names = [series.named(group) for group in groups]
    columns = [
        f"{name} [{unit}]" if unit else name for name, unit in zip(names, series.units, strict=True)
    ]
    return f"{series.rows} rows, {', '.join(columns)}"


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout.programs)
def test_each_layout_reads_its_case(layout):
    finds, text = CASES[layout.programs]
    stream = io.BufferedReader(io.BytesIO(text.encode()))
    sheets = read_sheets(stream, Wanted(), layout.file.replace("\\", ""))
    series = [series for sheet in sheets for series in sheet.series()][-1]
    series.finish()
    assert described(series) == finds
    assert series.choice.doubt == ""
