"""Running methods side by side: a scene becomes samples, and samples become verdicts.

`stepping` says how a run steps: h, equal cost, each method's own step. `lockstep` moves all methods with it, by
`loops`; `compiled` gives these to Numba, with the same bits. `rewindable` is a lockstep that can also go back.
`observer` reads the samples, live, replayed or without a screen, and notes milestones, of which `crossing` sees
whose error passes another's; `judging` shows one method at fixed steps to a Judge of `verdict`, whose words are in
`judgement`, which reads the `bands` of its energy error and, by `tangent`, how fast neighbouring starts part.
`energies` judges any program, by times and energies. `ensemble` runs many swings together, as arrays.
"""
