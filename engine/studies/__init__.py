"""Studies: what speed costs, where methods fail, and what a step does to neighbouring points."""

BAND = 0.5
"""The fraction by which energy may leave its range on the linear oscillator, which is
engine.studies.stability.wobble."""

LOST = f"""\
A swing is lost if it goes over the top, if it is chaotic and at least 10 % wider than on the linear
oscillator, or, unless the method is symplectic, if its energy goes {100 * BAND:.0f} % above or
below its range on that oscillator. Above its linear limit a symplectic method may hold a small
swing about two other points, with many times its energy; that is not a loss."""
