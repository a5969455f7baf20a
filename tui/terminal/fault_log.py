"""The log of faults: what failed while the lab went on, with its traceback."""

import time
import traceback
from contextlib import suppress
from pathlib import Path


def append(path: Path, error: BaseException) -> None:
    """Write the error to the log; where that is impossible, do without."""
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("a", encoding="utf-8", errors="backslashreplace") as log:
            log.write(time.strftime("%Y-%m-%d %H:%M:%S\n") + "".join(traceback.format_exception(error)) + "\n")
