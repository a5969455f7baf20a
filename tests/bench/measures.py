"""Print how large and how dense the code is, beside the ceilings that CI keeps; one JSON object.

python tests/bench/measures.py          # the measures and their ceilings
python tests/bench/measures.py --check  # exit 1 where a measure is above its ceiling
"""

import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
ROOMS = ("engine", "recordings", "tui")
MAX_COLUMNS = 100
MAX_FUNCTION_LINES = 40  # without the docstring

CEILINGS = {
    "characters": 1_081_701,
    "characters_of_engine": 319_939,
    "characters_of_recordings": 78_685,
    "characters_of_tui": 683_077,
    "characters_of_tests": 998_516,
    "files": 219,
    "long_lines": 18,
    "parallel_assignments": 25,
    "conditional_expressions_per_1000_lines": 26,
    "long_functions": 0,
    "numeric_constants": 313,
}
"""What each measure may be at the most.  Lower a ceiling whenever its measure has fallen; never raise one."""


@dataclass
class Measures:
    """Sums over the files of the product."""

    files: int = 0
    lines: int = 0  # that are not blank
    long_lines: int = 0
    parallel_assignments: int = 0  # a, b = x, y
    conditional_expressions: int = 0
    numeric_constants: int = 0  # assigned at the level of a module
    long_functions: list[str] = field(default_factory=list)

    def add(self, path: Path) -> None:
        text = path.read_text(encoding="utf-8")
        lines = [line for line in text.splitlines() if line.strip()]
        self.files += 1
        self.lines += len(lines)
        self.long_lines += sum(len(line) > MAX_COLUMNS for line in lines)
        if path.suffix != ".py":
            return
        tree = ast.parse(text)
        self.numeric_constants += sum(map(_is_numeric_constant, tree.body))
        for node in ast.walk(tree):
            self.parallel_assignments += _is_parallel_assignment(node)
            self.conditional_expressions += isinstance(node, ast.IfExp)
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                length = _length(node)
                if length > MAX_FUNCTION_LINES:
                    where = path.relative_to(ROOT)
                    self.long_functions.append(f"{where}:{node.lineno} {node.name}: {length} lines")


def _is_parallel_assignment(node: ast.AST) -> bool:
    if not isinstance(node, ast.Assign):
        return False
    return isinstance(node.targets[0], ast.Tuple) and isinstance(node.value, ast.Tuple)


def _is_numeric_constant(node: ast.stmt) -> bool:
    """Return whether a statement gives an upper-case name a value made of numbers alone."""
    if not isinstance(node, ast.Assign) or not isinstance(node.targets[0], ast.Name):
        return False
    if not re.fullmatch(r"_?[A-Z][A-Z0-9_]*", node.targets[0].id):
        return False
    values = [part for part in ast.walk(node.value) if isinstance(part, ast.Constant | ast.Name)]
    numbers = [
        isinstance(part, ast.Constant) and type(part.value) in (int, float) for part in values
    ]
    return bool(numbers) and all(numbers)


def _length(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Return the lines of a function without its docstring."""
    docstring = ast.get_docstring(function, clean=False)
    documented = len(docstring.splitlines()) if docstring else 0
    assert function.end_lineno is not None
    return function.end_lineno - function.lineno + 1 - documented


def code_files() -> Iterator[Path]:
    """Yield the Python and style files that git tracks."""
    command = ["git", "ls-files", "*.py", "*.tcss"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.splitlines():
        path = ROOT / name
        if path.exists():
            yield path


def measured() -> tuple[dict[str, int], list[str]]:
    """Return the measures by the names of their ceilings, and the functions that are too long."""
    product = Measures()
    characters = dict.fromkeys((*ROOMS, "tests"), 0)
    for path in code_files():
        room = path.relative_to(ROOT).parts[0]
        if room in characters:
            characters[room] += len(path.read_text(encoding="utf-8"))
        if room in ROOMS:
            product.add(path)
    values = {
        "characters": sum(characters[room] for room in ROOMS),
        **{f"characters_of_{room}": count for room, count in characters.items()},
        "files": product.files,
        "long_lines": product.long_lines,
        "parallel_assignments": product.parallel_assignments,
        "conditional_expressions_per_1000_lines": round(
            1000 * product.conditional_expressions / product.lines
        ),
        "long_functions": len(product.long_functions),
        "numeric_constants": product.numeric_constants,
    }
    return values, product.long_functions


def main() -> int:
    values, long_functions = measured()
    measures = {name: {"now": value, "ceiling": CEILINGS[name]} for name, value in values.items()}
    print(json.dumps({"measures": measures, "long_functions": long_functions}, indent=2))
    above = [name for name, value in values.items() if value > CEILINGS[name]]
    for name in above:
        print(f"{name}: {values[name]} is above {CEILINGS[name]}", file=sys.stderr)
    return int("--check" in sys.argv and bool(above))


if __name__ == "__main__":
    sys.exit(main())
