"""Without a screen: `run` judges methods, and `judge` another program's energies; `accuracy` and `stability` study.

`section` draws the phase portrait of a method's own map.  `reports` prints what the last three found.
"""
