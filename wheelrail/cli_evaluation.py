"""Commands that evaluate: results, tracks, contacts, measured roughness, profiles."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wheelrail.cli_shared import case_of, say

if TYPE_CHECKING:
    from wheelrail.analysis_report import AnalysisReport
    from wheelrail.roughness_command import RoughnessReport

__all__ = ["add_evaluations"]

_FOLDER_HELP = "folder of the files; left out: the current one"


def add_evaluations(commands: Any, case_help: str) -> None:
    """Add the parsers of these commands.

    Parameters
    ----------
    commands : argparse subparsers
    case_help : str
        What the argument CASE is.
    """
    analyse = commands.add_parser("analyse", help="evaluate a result: spectra, impacts, stick and slip")
    analyse.add_argument("result", metavar="RESULT", help="result file of wheelrail run")
    analyse.add_argument("--output", metavar="DIR", help="folder of tables and figures; left out: that of the result")
    analyse.add_argument("--transient", type=float, metavar="S", help="beginning in s to leave out; left out: a fifth")
    analyse.add_argument(
        "--factor", type=float, default=1.5, metavar="X", help="an impact is above X times the preload; left out: 1.5"
    )
    analyse.set_defaults(command=_analyse)

    decay = commands.add_parser("decay-rate", help="track decay rates after EN 15461, beside the limits of EN ISO 3095")
    decay.add_argument("case", nargs="?", metavar="CASE", help=case_help)
    decay.add_argument("--output", metavar="DIR", default=".", help=_FOLDER_HELP)
    decay.set_defaults(command=_decay_rate)

    contact_filter = commands.add_parser(
        "contact-filter", help="how much contact models filter the roughness of a case"
    )
    contact_filter.add_argument("case", nargs="?", metavar="CASE", help=case_help)
    contact_filter.add_argument(
        "--contact",
        action="append",
        choices=("winkler", "half-space", "hertz-average", "hertz-winkler"),
        help="may be repeated; left out: winkler",
    )
    contact_filter.add_argument(
        "--line", type=float, action="append", metavar="M", help="line beside the contact in m; repeat; left out: 0"
    )
    contact_filter.add_argument("--transient", type=float, metavar="S", help="beginning in s to leave out; a fifth")
    contact_filter.add_argument("--output", metavar="DIR", default=".", help=_FOLDER_HELP)
    contact_filter.set_defaults(command=_contact_filter)

    profiles = commands.add_parser(
        "profiles", help="where the wheels of a wheelset touch, over its lateral displacement"
    )
    profiles.add_argument("case", metavar="CASE", help="case file with profiles of wheel and rail")
    for name, value, words in (
        ("--largest", 10e-3, "largest displacement"),
        ("--gauge", 1.435, "gauge of the track"),
        ("--back-spacing", 1.36, "distance of the flanges' backs"),
        ("--back-position", -70e-3, "flange's back on the wheel's profile, lateral position"),
    ):
        profiles.add_argument(name, type=float, default=value, metavar="M", help=f"{words} in m; left out: {value:g}")
    profiles.add_argument("--output", metavar="DIR", default=".", help=_FOLDER_HELP)
    profiles.set_defaults(command=_profiles)

    roughness = commands.add_parser("roughness", help="levels of measured roughness, compared with a limit")
    roughness.add_argument("file", metavar="FILE", help="positions along and heights, one column for each line")
    roughness.add_argument("--on", choices=("rail", "wheel"), default="rail", help="left out: rail")
    roughness.add_argument("--wheel-radius", type=float, metavar="M", help="rolling radius in m; with --on wheel")
    roughness.add_argument("--limit", metavar="NAME", default="iso3095-2013-limit", help="name of a spectrum")
    roughness.add_argument("--segment", type=float, default=4.0, metavar="M", help="segment length in m; left out: 4")
    roughness.add_argument("--raw", action="store_true", help="keep spikes and pits as measured")
    roughness.add_argument("--output", metavar="DIR", default=".", help=_FOLDER_HELP)
    roughness.set_defaults(command=_roughness)


def _analyse(options: argparse.Namespace) -> int:
    from wheelrail.analyse_command import analyse_result

    folder = Path(options.result).parent if options.output is None else Path(options.output)
    return _print(analyse_result(options.result, folder, transient=options.transient, factor=options.factor))


def _decay_rate(options: argparse.Namespace) -> int:
    from wheelrail.decay_rate_command import decay_rate_report

    return _print(decay_rate_report(case_of(options), options.output, stem=_stem(options)))


def _contact_filter(options: argparse.Namespace) -> int:
    from wheelrail.contact_filter_command import contact_filter_report

    report = contact_filter_report(
        case_of(options),
        options.output,
        stem=_stem(options),
        contacts=options.contact or ["winkler"],
        lateral=options.line or [0.0],
        transient=options.transient,
        progress=lambda name: say(f"runs: {name}"),
    )
    return _print(report)


def _profiles(options: argparse.Namespace) -> int:
    from wheelrail.profiles_command import profiles_report

    report = profiles_report(
        case_of(options),
        options.output,
        stem=_stem(options),
        largest=options.largest,
        gauge=options.gauge,
        flange_back_spacing=options.back_spacing,
        flange_back_position=options.back_position,
    )
    return _print(report)


def _roughness(options: argparse.Namespace) -> int:
    from wheelrail.roughness_command import roughness_report

    report = roughness_report(
        options.file,
        options.output,
        on=options.on,
        wheel_radius=options.wheel_radius,
        limit=options.limit,
        process=not options.raw,
        segment_length=options.segment,
    )
    return _print(report)


def _stem(options: argparse.Namespace) -> str:
    """Beginning of the names of the files."""
    return "default" if options.case is None else Path(options.case).stem


def _print(report: AnalysisReport | RoughnessReport) -> int:
    print(report.text)
    for note in report.notes:
        say(note)
    for path in report.files:
        print(path)
    return 0
