"""The laboratory without a screen: methods, pendulum, exact reference and studies.

Pure: no clock, no file, no thread, no randomness.  Imports the standard library, and NumPy
only where ensembles need it.

- What is simulated: `state`, `pendulum`, `scenes`, and `methods`, the one list; `shadow` for its shadow energies.
- Simulating it: `lockstep` moves all methods side by side, by `loops`, which `inline` writes out in Python
  and `compiled` gives to Numba.
- What it is held against: `exact`, the closed form; `rounding`, what no step size can mend; `verdict`, which
  judges an energy error while it comes in.
- Speed against accuracy: `accuracy` measures, `recommend` searches.
- Where methods fail: `tangent` differentiates a step, `linear` (small swings), `area` and `chaos` read the
  derivative, `stability` watches whole swings, `stability_map` all of them.
"""
