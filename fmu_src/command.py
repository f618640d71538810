"""The command that builds an FMU."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from wheelrail.case import default_case_text, load_case, parse_case
from wheelrail.errors import WheelrailError
from wheelrail.progress import progress_bar

from .build import build_fmu, describe_fmu
from .errors import SlaveError

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Build an FMU and say in one line what was built.

    Parameters
    ----------
    arguments : sequence of str, optional
        Command line; left out: that of the process.

    Returns
    -------
    int
        0, or 2 after an error, which is one message on stderr.
    """
    parser = argparse.ArgumentParser(prog="build_fmu.py", description="Build WheelRail.fmu from a case file.")
    parser.add_argument("case", nargs="?", help="case file (TOML); left out: the case that comes with the program")
    parser.add_argument("--output", default=".", metavar="DIR", help="folder of the FMU; default: the current one")
    options = parser.parse_args(arguments)
    try:
        case = load_case(options.case) if options.case else parse_case(default_case_text(), source="default case")
        with progress_bar("moving Green's functions") as reached:
            path = build_fmu(case, options.output, reached)
        built = describe_fmu(path)
    except (WheelrailError, SlaveError) as error:
        print(f"error: {error}", file=sys.stderr)  # noqa: T201
        return 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)  # noqa: T201
        return 130
    print(f"{built.path}: {built.size / 1e3:.0f} kB, {built.ports} ports")  # noqa: T201
    return 0
