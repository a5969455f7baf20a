"""The laboratory without a screen: methods, pendulum, exact reference and studies.

Pure: no clock, no file, no thread, no randomness.  Imports the standard library, and NumPy
only where ensembles need it.
"""
