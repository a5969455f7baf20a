"""Running methods side by side: a scene becomes samples, and look points become verdicts.

    Scene, stepping --lockstep--> samples
                        |
                        +--look points--> judges --> judgements, milestones

- Running: `stepping` holds h and each method's own step; `lockstep` advances all methods, in
  `loops`, which Numba compiles to the same bits; `rewindable` is a lockstep that can also go back.
- Judging: the lockstep stops at look points and shows each method to its `judge`, which sees its
  energy error and the separation of neighbouring starts; `verdicts` names what it may say, `levels`
  when.  `record` judges the energies of any program.
"""

NUMERICS = 4
"""The version of the numbers: a run recorded with another one may differ in the last digits."""
