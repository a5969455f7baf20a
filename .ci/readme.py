"""Run a command of the README's first table: readme.py "run it" pip [ARGUMENT ...].

It is the command for this system, with the arguments after its last word.
"""

import re
import subprocess
import sys
from pathlib import Path

README = Path(__file__).parent.parent / "README.md"


def command(what: str, tool: str) -> str:
    """Return the command in the row `what`, the column `tool`."""
    head, _, *rows = re.findall(r"^\|.*\|$", README.read_text("utf-8"), re.MULTILINE)
    column = [cell.strip() for cell in head.split("|")].index(f"with {tool}")
    cells = {row.split("|")[1].strip(): row.split("|")[column] for row in rows}
    return cells[what].strip(" `")


def main(what: str, tool: str, *arguments: str) -> int:
    """Run it in the shell that the README means; return the exit code."""
    if sys.platform == "win32":
        text = " ".join([command(f"{what} on Windows", tool), *arguments])
        # PowerShell goes on after a command that fails
        stops = text.replace(";", "; if ($LASTEXITCODE) { exit $LASTEXITCODE };")
        shell = ["powershell", "-NoProfile", "-Command", f"{stops}; exit $LASTEXITCODE"]
    else:
        text = " ".join([command(what, tool), *arguments])
        shell = ["bash", "-euo", "pipefail", "-c", text]
    print(text, flush=True)
    return subprocess.run(shell, cwd=README.parent, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
