"""The levels of every judge, and the reasons of `undecided`.

A level is a probability of error, or a size that a person sees in a plot of the energies; none is
fitted to our own examples.  tests/bench/foreign.py and tests/bench/judging.py measure the errors.
"""

# Levels of significance:
MOVES = 1e-3  # of a trend by chance, times the share of the record that shows it
MOVES_BY_RANK = 1e-5  # likewise, of ranks: growth that is ever faster or slower
SUSPECT = 0.05  # a material trend that is so unlikely by chance is not called bounded
EVIDENT = 3e-3  # of a slope by chance: three sigmas
UNLIKE = 1e-3  # of an end as unlike the rest
UNLIKE_START = 1e-4
CERTAIN = 0.99  # of a bound, and that a trend is smaller than the band
# Sizes:
LARGE = 1.0  # standard deviations: a move that is not bounded, however likely it is by chance
MATERIAL = 0.5  # standard deviations of the fluctuation: what a person sees in a plot
NEW = 0.25  # of its move: so far the end lies where the energy had not been
GONE = 5.0  # widths of the present band: no walk goes so far from its start
WIDENING = 3.0  # a band at the end over that at the start
WAVE = 0.95  # of what a line leaves, explained by a wave that is then subtracted
MIN_CYCLES = 2.0  # of the wave
AHEAD = 10.0  # times its length for which a bounded run must stay in its band
# Numbers:
MAX_BINS = 64
MIN_SAMPLES = 64
UNEVEN = 3.0  # times the shortest block; even samples: 2 at most
MIN_JUMPS = 3  # of energies that repeat: there and back is no digit
WINDOWS = (1.0, 0.5, 0.25, 0.125)  # shares of the bins, up to the end, in which it may move
RESTS = (0.75, 0.625, 0.5, 0.375, 0.25)  # shares up to the end in which it may rest
ENDS = (8, 16, 32)  # parts of the bins of which the last must be like the others

FEW = "{need} samples are needed"
OPEN = "a trend cannot be excluded; {longer}"
WALKS = "the energy cannot be distinguished from a random walk; a longer record may not help"
UNLIKE_END = "the end of the record differs from the rest"
WIDENS = "the energy's band widens"
TURNED = "the energy has turned back"
RETURNS = "a symplectic method's energy should return, but has not yet"
BEATS = "with so few steps per turn the error shows beats"
NEAR = "the energy's band has shifted by less than half its width"
SHORT = "a slow drift takes longer to show"
LONGER = "a record {factor:.2g} times as long would settle it"
UNKNOWN = "a longer record may help"

# Only in a run.  z is h·w0 times the longest substep; errors are relative energy errors.
# Theorems:
# z: chaos is thinner than exp(-pi²/z): Gelfreich & Lazutkin, Russ. Math. Surv. 56 (2001)
REGULAR_Z = 0.25
FENCED_Z = 0.9  # invariant curves fence orbits in; the last breaks at 0.9857: Greene (1979)
NEAR_TOP = 11.0  # w0·period: longer swings come within 30° of upright, where fences break first
MIN_STEPS_A_TURN = 4  # Nyquist: the error oscillates twice a turn, and beats with fewer steps
ESCAPED_ERROR = 1e6  # no force brings the bob back from there, if the model has no way over the top
# Rounding:
WALK = 32.0  # roundings: eight standard deviations of a random walk of sixteen a step
REFERENCE_ERROR = 1e-9  # of ln(E/E_true): ten times the error of the true motion
MIN_AMPLITUDE = 1e5  # roundings of theta: a smaller damped amplitude is rounded by more than 1e-5
ROUNDING = 1e-12  # of an energy: a million roundings, or a random walk of 1e7
# When it is judged:
LOOKS = 8  # a period: twice the Nyquist rate of the error's second harmonic
MIN_SWINGS = 4
MIN_BINS = 8
MIN_PERIODS = 8  # before a theorem is applied: the orbit has then shown its band
LONGER_BY = 9 / 8  # from one judgement to the next
MIN_ONE_WAY = 0.9  # share of moves from bin to bin that makes a straight course of one that beats
LONG = 4096  # steps that show regularity: chaos separates by e^15 with a Lyapunov number of 0.004
CHAOTIC_SEPARATION = 15.0  # ln, beyond that of regular neighbours
REGULAR_SEPARATION = 5.0  # ln, beyond proportion to time
LYAPUNOV_STEPS = 100_000  # neighbours are followed for so long: tenths of a second in plain Python
LEFT = 0.5  # of a band: one that is so far from the start has left it
AWAY = 0.25  # of a band: one that reaches no farther beyond the start has not come back
