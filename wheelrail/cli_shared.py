"""What the commands share: where they say things, and the case they are about."""

from __future__ import annotations

import argparse
import sys

from wheelrail.case import Case, default_case_text, load_case, parse_case

__all__ = ["case_of", "say"]

_DEFAULT_CASE = "default case"


def say(text: str) -> None:
    """Print a message for the user, beside the output."""
    print(text, file=sys.stderr)


def case_of(options: argparse.Namespace, *, quiet: bool = False) -> Case:
    """Read the case that a command names, or else the one that comes with the program."""
    if options.case is not None:
        return load_case(options.case)
    case = parse_case(default_case_text(), source=_DEFAULT_CASE)
    if not quiet:
        say(f'no case given: the default case, "{case.title}" (see wheelrail default-case)')
    return case
