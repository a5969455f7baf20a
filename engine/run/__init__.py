"""Running methods side by side: a scene becomes samples, and look points become verdicts.

    Scene, stepping --lockstep--> samples
                        |
                        +--look points--> judges --> judgements, milestones

- Running: `stepping` holds h and each method's own step; `lockstep` advances all methods, in
  `loops`, which `compiled` compiles by Numba to the same bits; `rewindable` is a lockstep that can
  also go back; `ensemble` runs many swings at once, as arrays.
- Judging: the lockstep stops at look points and shows each method to its `judge`, which uses the
  `bands` of its energy error and the separation of neighbouring starts (`tangent`); `judgement`
  defines verdicts and thresholds.  `energies` judges the record of any program.
"""

NUMERICS = 3
"""The version of the numbers: a run recorded with another one may differ in the last digits."""
