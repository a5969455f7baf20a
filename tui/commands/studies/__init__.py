"""Without a screen: `run` judges methods, and `judge` another program's energies; `accuracy` and `stability` study.

`reports` prints what the last two found.
"""
