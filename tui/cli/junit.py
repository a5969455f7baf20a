"""Checks: --fail-if and its exit code, and as JUnit XML, which CI systems show as tests."""

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.files import text_file
from tui.cli.options import Suggestions, add_file
from tui.cli.output import warn
from tui.cli.report import MAX_CELL


class Check(NamedTuple):
    """A check that passed, or failed with a sentence."""

    name: str
    said: str  # what was found
    failure: str | None


def add_check_options(parser: argparse.ArgumentParser, names: Iterable[str], meaning: str) -> None:
    """Add --fail-if, whose comparisons have these names, and --junit, for `conclude`."""
    parser.add_argument("--fail-if", metavar="EXPR", choices=Suggestions(names), help=meaning)
    add_file(parser, "--junit", metavar="FILE", type=Path, help="also write the check as JUnit XML")


def conclude(options: argparse.Namespace, suite: str, checks: Sequence[Check]) -> Exit:
    """Report checks that failed, write the XML where it is asked for, and return the exit code."""
    failed = [check for check in checks if check.failure is not None]
    if failed:
        where = ""
        if len(checks) > 1:
            where = f" in {len(failed)} of {len(checks)} runs, first at {failed[0].name}"
        warn(f"the check failed{where}: {options.fail_if} ({failed[0].failure})")
    if options.junit:
        write_junit(options.junit, suite, checks)
    return Exit.CHECK_FAILED if failed else Exit.FINE


def write_junit(path: Path, suite: str, checks: Sequence[Check]) -> None:
    """Write a file with one test a check; an earlier report is replaced."""
    name = printable(suite, MAX_CELL)
    failures = sum(check.failure is not None for check in checks)
    counts = {"tests": str(len(checks)), "failures": str(failures), "errors": "0", "skipped": "0"}
    root = Element("testsuite", {"name": name, **counts})
    for check in checks:
        case = SubElement(root, "testcase", classname=name, name=printable(check.name, MAX_CELL))
        if check.failure is not None:
            SubElement(case, "failure", message=printable(check.failure, MAX_CELL))
        SubElement(case, "system-out").text = printable(check.said, MAX_CELL)
    indent(root)
    with text_file(path, force=True) as out:
        ElementTree(root).write(out, encoding="unicode", xml_declaration=True)
