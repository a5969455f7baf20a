"""Reports of `run`, `accuracy`, `stability`, its `section` and judged `energies`.

`figures` draws them for paper and slide.
"""
