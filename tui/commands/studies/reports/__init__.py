"""Reports of `run`, `accuracy`, `stability` and judged `energies`; they load NumPy, Rich.

`figures` draws them for paper and slide.
"""
