"""Commands without a screen.

`run` judges methods, in `lists` of runs too, and `judge` another program's energies; `accuracy` and
`stability` study methods.  `reports` prints what they found.
"""
