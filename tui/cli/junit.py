"""Checks as JUnit XML, which CI systems show as tests."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import escape, quoteattr

from recordings.errors import printable
from tui.cli.files import text_file


class Check(NamedTuple):
    """A check that passed, or failed with a sentence."""

    name: str
    said: str  # what was found
    failure: str | None


def write_junit(path: Path, suite: str, checks: Sequence[Check]) -> None:
    """Write a file with one test a check; an earlier report is replaced."""
    failures = sum(check.failure is not None for check in checks)
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f'<testsuite name={_attribute(suite)} tests="{len(checks)}" failures="{failures}" errors="0" skipped="0">',
    ]
    for check in checks:
        lines.append(f"  <testcase classname={_attribute(suite)} name={_attribute(check.name)}>")
        if check.failure is not None:
            lines.append(f"    <failure message={_attribute(check.failure)}/>")
        lines.append(f"    <system-out>{escape(printable(check.said, 1000))}</system-out>")
        lines.append("  </testcase>")
    with text_file(path, force=True) as out:
        out.write("\n".join([*lines, "</testsuite>", ""]))


def _attribute(text: str) -> str:
    return quoteattr(printable(text, 1000))
