"""Running methods side by side: a scene becomes samples, and look points become verdicts.

    Scene, stepping --lockstep--> samples
                        |
                        +--look points--> judges --> judgements, milestones

- Running: `stepping` holds h, equal cost and each method's own step; `lockstep` moves all methods
  by it, in `loops`, which `compiled` gives to Numba, with the same bits; `rewindable` is a lockstep
  that can also go back; `ensemble` runs many swings together, as arrays.
- Judging: the lockstep stops at look points and shows each method to its `judge`, which uses the
  `bands` of its energy error and, by `tangent`, how fast neighbouring starts separate; the lockstep
  has `Judges` of all methods, with the milestones of the run; `judgement` defines the verdicts.
- `energies` judges the record of any program, by least squares in correlated noise.
"""

NUMERICS = 2
"""The version of the numbers: a run recorded with another one may differ in the last digits."""
