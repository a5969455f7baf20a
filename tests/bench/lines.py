"""How large the house is: lines of each package, entries of tui, files of the fullest folder; one JSON object."""

import json
import subprocess
from collections import Counter
from pathlib import Path

LIMIT = 12_500  # lines of product code for what the program did on 21 November 2026


def main() -> None:
    listed = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split()
    code = [Path(name) for name in listed if name.endswith((".py", ".tcss"))]
    lines = Counter[str]()
    for path in code:
        lines[path.parts[0]] += len(path.read_text(encoding="utf-8").splitlines())
    packages = ("engine", "recordings", "tui")
    folders = Counter(str(path.parent) for path in map(Path, listed) if path.parts[0] in packages)
    (fullest, files), *_ = folders.most_common(1)
    report = {
        "lines": {name: lines[name] for name in (*packages, "tests")},
        "product": sum(lines[name] for name in packages),
        "limit": LIMIT,
        "entries_of_tui": len({path.parts[1] for path in map(Path, listed) if path.parts[0] == "tui"}),
        "fullest_folder": {fullest: files},
    }
    print(json.dumps(report, indent=2))


if __name__ == "__main__":
    main()
