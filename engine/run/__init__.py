"""Running methods side by side: a scene becomes samples, and samples become verdicts.

    Scene, stepping --lockstep--> samples --observer--> milestones, verdicts

- Running: `stepping` holds h, equal cost and each method's own step; `lockstep` moves all methods by it, in `loops`,
  which `compiled` gives to Numba, with the same bits; `rewindable` is a lockstep that can also go back; `ensemble`
  runs many swings together, as arrays.
- Judging: `observer` reads the samples, live, replayed or without a screen; `judging` shows each method at fixed
  steps to a Judge of `verdict`, which uses the `bands` of its energy error and, by `tangent`, how fast neighbouring
  starts part; `judgement` has the verdicts; `crossing` finds errors that pass each other.
- `energies` judges the record of any program, by times and energies.
"""

NUMERICS = 1
"""The version of the numbers: a run recorded with another one may differ in the last digits."""
