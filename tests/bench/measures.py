"""Print how large and how dense the code is, beside the ceilings that CI keeps; one JSON object.

python tests/bench/measures.py          # the measures and their ceilings
python tests/bench/measures.py --check  # exit 1 where a measure is above its ceiling
"""

import ast
import json
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
ROOMS = ("engine", "recordings", "tui")
KINDS = (".py", ".tcss", ".toml", ".json")
DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
MAX_FUNCTION_LINES = 40  # without the docstring

CEILINGS = {
    "characters": 844_000,
    "characters_of_engine": 256_000,
    "characters_of_recordings": 68_500,
    "characters_of_tui": 519_700,
    "characters_of_tests": 794_600,
    "characters_of_bench": 60_000,
    "files": 127,
    "parallel_assignments": 8,
    "conditional_expressions_per_1000_lines": 10,
    "long_functions": 0,
    "long_lines": 0,
    "numeric_constants": 220,
}
"""Two per cent above the measures, so that what CONTRIBUTING invites passes.

Characters are those of Python without docstrings, and of data as text; in tests, all of Python.
Lower a ceiling when its measure falls; raise one only with the reason in the commit."""


def is_parallel_assignment(node: ast.AST) -> bool:
    """Return whether a statement has the form a, b = x, y."""
    if not isinstance(node, ast.Assign):
        return False
    return isinstance(node.targets[0], ast.Tuple) and isinstance(node.value, ast.Tuple)


def is_long_function(node: ast.AST) -> bool:
    if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        return False
    documented = len((ast.get_docstring(node, clean=False) or "").splitlines())
    return node.end_lineno - node.lineno + 1 - documented > MAX_FUNCTION_LINES


def docstrings(nodes: list[ast.AST], text: str) -> Iterator[str]:
    """Yield the docstrings of a module, its classes and its functions as they are written."""
    for node in nodes:
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False):
            yield ast.get_source_segment(text, node.body[0]) or ""


def tracked(*patterns: str) -> Iterator[tuple[str, str]]:
    """Yield the names and the texts of the project's files."""
    command = ["git", "ls-files", *patterns]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    for name in filter(lambda name: (ROOT / name).exists(), listed.stdout.splitlines()):
        yield name, (ROOT / name).read_text(encoding="utf-8")


def measured() -> tuple[Counter[str], list[str]]:
    """Return the measures by the names of their ceilings, and the functions that are too long."""
    found: Counter[str] = Counter()
    long_functions = []
    for name, text in tracked("tests/*.py"):
        folder = "bench" if name.startswith("tests/bench/") else "tests"
        found[f"characters_of_{folder}"] += len(text)
    for name, text in tracked(*(f"{room}/*{kind}" for room in ROOMS for kind in KINDS)):
        nodes = list(ast.walk(ast.parse(text if name.endswith(".py") else "")))
        characters = len(text) - sum(map(len, docstrings(nodes, text)))
        found["characters"] += characters
        found[f"characters_of_{name.partition('/')[0]}"] += characters
        found["files"] += name.endswith(".py")
        found["long_lines"] += len(re.findall(r"^.{101}", text, re.M))
        found["numeric_constants"] += len(re.findall(r"^[A-Z_0-9]+ = -?[\d.]", text, re.M))
        found["lines"] += sum(bool(line.strip()) for line in text.splitlines())
        found["parallel_assignments"] += sum(map(is_parallel_assignment, nodes))
        found["conditional_expressions"] += sum(isinstance(node, ast.IfExp) for node in nodes)
        functions = filter(is_long_function, nodes)
        long_functions += [f"{name}:{each.lineno} {each.name}" for each in functions]
    found["long_functions"] = len(long_functions)
    share = found["conditional_expressions"] / found["lines"]
    found["conditional_expressions_per_1000_lines"] = round(1000 * share)
    return found, long_functions


def main() -> int:
    found, long_functions = measured()
    measures = {name: {"now": found[name], "ceiling": most} for name, most in CEILINGS.items()}
    print(json.dumps({"measures": measures, "long_functions": long_functions}, indent=2))
    above = [name for name, most in CEILINGS.items() if found[name] > most]
    for name in above:
        print(f"{name}: {found[name]} is above {CEILINGS[name]}", file=sys.stderr)
    return int("--check" in sys.argv and bool(above))


if __name__ == "__main__":
    sys.exit(main())
