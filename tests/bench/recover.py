"""How long it takes to verify an hour of recording, and to recover it damaged: one JSON object."""

import json
import random
import resource
import time
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from engine.scenes import DEFAULT_SCENE
from recordings.headless import simulate
from recordings.recorder import Recorder
from recordings.recording import Recording
from recordings.recovery import recover
from recordings.verification import verify

HOUR = 3600.0  # s
DAMAGES = 20


def main() -> None:
    """Measure and print."""
    with TemporaryDirectory() as folder:
        path, damaged, saved = (Path(folder) / name for name in ("hour.mcap", "damaged.mcap", "saved.mcap"))
        with Recorder(path, wall=None) as recorder:
            for _ in simulate(replace(DEFAULT_SCENE, h=1 / 60), HOUR, recorder):
                pass
        began = time.perf_counter()
        verification = verify(path)
        verifying = time.perf_counter() - began
        assert verification.identical
        began = time.perf_counter()
        Recording.open(path, check=True).close()
        checking = time.perf_counter() - began
        chance = random.Random(1)
        data = bytearray(path.read_bytes())
        for _ in range(DAMAGES):
            data[chance.randrange(len(data) // 20, len(data) * 9 // 10)] ^= 0xFF
        damaged.write_bytes(data)
        began = time.perf_counter()
        recovery = recover(damaged, saved)
        recovering = time.perf_counter() - began
        assert recovery.samples_kept + recovery.samples_lost == verification.samples
        assert verify(saved).identical
    print(
        json.dumps(
            {
                "benchmark": "recover",
                "megabytes": round(len(data) / 1e6, 1),
                "samples": verification.samples,
                "verify_seconds": round(verifying, 2),
                "check_seconds": round(checking, 2),
                "recover_seconds": round(recovering, 2),
                "damaged_bytes": DAMAGES,
                "samples_lost": recovery.samples_lost,
                "seconds_lost": round(recovery.seconds_lost, 2),
                "memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000,
            }
        )
    )


if __name__ == "__main__":
    main()
