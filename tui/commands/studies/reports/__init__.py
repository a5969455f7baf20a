"""Reports of `run`, `accuracy`, `stability` and its --section, and of `energies` judged; they load NumPy and Rich.

`figures` draws them for paper and slide.
"""
