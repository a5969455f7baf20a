"""The laboratory without a screen.  Pure: no clock, no file, no thread, no randomness.

A scene (`scenes`) starts the model (`models`); the methods (`methods`, the one list) carry it side by side
(`run`).  Three studies look closer: `accuracy` at what speed costs, `stability` at where methods fail, and
`phase_space` at what a step does to neighbouring starts.  Standard library only, and NumPy for ensembles.
"""
