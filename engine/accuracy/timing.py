"""How long a piece of work takes, by a clock that is passed in."""

from collections.abc import Callable

Clock = Callable[[], float]
REPEATS = 5


def shortest(work: Callable[[], object], runs: int, clock: Clock) -> tuple[float, float]:
    """Seconds of one piece of work, the shortest of REPEATS; and by how much the longest took longer, relative."""
    work()  # may have to be compiled
    lengths = []
    for _ in range(REPEATS):
        began = clock()
        for _ in range(runs):
            work()
        lengths.append((clock() - began) / runs)
    return min(lengths), max(lengths) / min(lengths) - 1
