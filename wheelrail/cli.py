"""The command ``wheelrail``."""

from __future__ import annotations

import argparse
import json
import logging
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from wheelrail.case import case_from_dict, default_case_text
from wheelrail.cli_evaluation import add_evaluations
from wheelrail.cli_shared import case_of, say
from wheelrail.errors import WheelrailError
from wheelrail.progress import progress_bar
from wheelrail.version import __version__

if TYPE_CHECKING:
    from wheelrail.run import RunSummary

# What only some commands need is imported by these, so that a mistyped option is answered at once.

__all__ = ["main"]

_FAILED_POINTS, _ERROR, _INTERRUPTED, _BROKEN_PIPE = 1, 2, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments; left out: those of the process.

    Returns
    -------
    int
        0; 1 if points of a study failed; 2 after a mistake of the user, which is one message on stderr; 130 after
        Ctrl-C, 143 after SIGTERM.
    """
    options = _parser().parse_args(argv)
    logging.basicConfig(format="%(levelname)s: %(message)s", level=logging.WARNING, stream=sys.stderr, force=True)
    logging.addLevelName(logging.WARNING, "warning")
    try:
        code = options.command(options)
        sys.stdout.flush()
        return code
    except WheelrailError as error:
        return _refuse(error)
    except KeyboardInterrupt:
        say("interrupted; nothing was saved")
        return _INTERRUPTED
    except BrokenPipeError:
        # The reader of our output has left. What is still buffered has nowhere to go, not even at exit.
        devnull = os.open(os.devnull, os.O_WRONLY)
        os.dup2(devnull, sys.stdout.fileno())
        os.close(devnull)
        return _BROKEN_PIPE
    except OSError as error:
        return _refuse(error)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="wheelrail", description="Dynamic wheel/rail interaction in the time domain, and FMUs of it."
    )
    parser.add_argument("--version", action="version", version=f"wheelrail {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    case_help = "case file (TOML); left out: the case that comes with the program"

    run = commands.add_parser("run", help="run a case and write the result as netCDF")
    run.add_argument("case", nargs="?", metavar="CASE", help=case_help)
    run.add_argument("--output", metavar="FILE", help="result file; left out: output.file of the case")
    run.add_argument("--duration", type=float, metavar="S", help="simulated time in s in place of the case's")
    run.add_argument("--resume", action="store_true", help="continue the run that the result file holds")
    run.add_argument("--quiet", action="store_true", help="no progress and no summary; errors and warnings only")
    run.set_defaults(command=_run)

    study = commands.add_parser("study", help="run many cases that differ in some keys, and write one data set")
    study.add_argument("study", metavar="STUDY", help="study file (TOML)")
    study.add_argument("--output", metavar="FILE", help="data set (netCDF); left out: named after the study file")
    where = study.add_mutually_exclusive_group()
    where.add_argument("--workers", type=int, metavar="N", help="worker processes, 0 for none; left out: one per core")
    where.add_argument("--scheduler", metavar="ADDRESS", help="use the workers of an existing Dask cluster")
    study.add_argument("--resume", action="store_true", help="continue an interrupted study")
    study.add_argument("--retry-failed", action="store_true", help="continue, and compute failed points again")
    study.add_argument("--quiet", action="store_true", help="no progress and no summary; errors only")
    study.set_defaults(command=_study)

    build = commands.add_parser("build", help="build WheelRail.fmu from a case")
    build.add_argument("case", nargs="?", metavar="CASE", help=case_help)
    build.add_argument("--output", metavar="DIR", default=".", help="folder of the FMU; left out: the current one")
    build.set_defaults(command=_build)

    plot = commands.add_parser("plot", help="draw a result and the model behind it")
    plot.add_argument("result", metavar="RESULT", help="result file of wheelrail run")
    plot.add_argument("--output", metavar="DIR", help="folder of the figures; left out: that of the result")
    plot.add_argument("--format", choices=("png", "pdf", "svg"), default="png", help="left out: png")
    plot.set_defaults(command=_plot)

    contact = commands.add_parser("contact", help="draw pressure, tractions, stick and slip at steps of a run")
    contact.add_argument("case", metavar="CASE", help="case file with a half-space contact")
    contact.add_argument("--step", type=int, action="append", metavar="N", help="step, may be repeated; left out: last")
    contact.add_argument("--animate", action="store_true", help="also a GIF from the first of the steps to the last")
    contact.add_argument(
        "--output", metavar="DIR", default=".", help="folder of the figures; left out: the current one"
    )
    contact.add_argument("--format", choices=("png", "pdf", "svg"), default="png", help="left out: png")
    contact.set_defaults(command=_contact)

    explain = commands.add_parser("explain", help="say in words and numbers what a case computes")
    explain.add_argument("case", nargs="?", metavar="CASE", help=case_help)
    explain.set_defaults(command=_explain)

    stability = commands.add_parser("stability", help="say which wheel modes grow in steady sliding: what can squeal")
    stability.add_argument("case", metavar="CASE", help="case file with a flexible wheel, friction and creepage")
    stability.set_defaults(command=_stability)

    add_evaluations(commands, case_help)

    schema = commands.add_parser("schema", help="print the JSON schema of case files")
    schema.set_defaults(command=_schema)

    cache = commands.add_parser("cache", help="list or clear the cached Green's functions")
    cache.add_argument("action", nargs="?", choices=("list", "clear"), default="list", help="left out: list")
    cache.set_defaults(command=_cache)

    default_case = commands.add_parser("default-case", help="print the case that comes with the program")
    default_case.set_defaults(command=_default_case)
    return parser


def _refuse(error: Exception) -> int:
    say(f"error: {error}")
    for note in getattr(error, "__notes__", ()):
        say(note)
    return _ERROR


def _run(options: argparse.Namespace) -> int:
    from wheelrail.results import check_target, is_interrupted
    from wheelrail.run import run_case

    quiet = options.quiet
    case = case_of(options, quiet=quiet)
    if options.duration is not None:
        data = case.to_dict()
        data["simulation"]["duration"] = options.duration
        case = case_from_dict(data, source="--duration", folder=case.folder)
    path = Path(options.output if options.output is not None else case.output.file)
    check_target(path)
    if not options.resume and not quiet and is_interrupted(path):
        say(f"{path} holds an interrupted run, which will be replaced; --resume would continue it")
    planned = round(case.simulation.duration * case.simulation.speed / case.simulation.dx)
    with (
        progress_bar("Green's functions", quiet=quiet) as built,
        progress_bar("steps", total=planned, unit="steps", quiet=quiet) as stepped,
    ):
        summary = run_case(case, path, resume=options.resume, build_progress=built, progress=stepped)
    if not summary.complete:
        case_name = "" if options.case is None else f" {options.case}"
        target = "" if options.output is None else f" --output {options.output}"
        duration = "" if options.duration is None else f" --duration {options.duration:g}"
        say(
            f"interrupted at {summary.steps * summary.dt:.6g} s of {case.simulation.duration:g} s; the "
            f"{summary.steps} steps up to there are in {path}\n"
            f"to continue: wheelrail run{case_name}{target}{duration} --resume"
        )
        return 128 + (summary.interrupted_by or signal.SIGINT)
    if not quiet:
        print(_summary(summary))
    return 0


def _summary(summary: RunSummary) -> str:
    statistics = summary.statistics
    now = summary.steps - summary.resumed_from
    simulated = now * summary.dt
    lines = []
    if summary.resumed_from and not now:
        lines.append(f"{summary.path} is complete already: {summary.steps} steps, {summary.steps * summary.dt:.6g} s")
    else:
        again = f", continued after {summary.resumed_from} steps" if summary.resumed_from else ""
        lines.append(f"steps            {summary.steps} of {summary.dt * 1e6:.4g} us{again}")
        lines.append(f"simulated time   {summary.steps * summary.dt:.6g} s")
        if now:
            lines.append(
                f"computing time   {summary.wall_time:.3g} s, {summary.wall_time / simulated:.3g} times real time, "
                f"{summary.wall_time / now * 1e6:.3g} us per step"
            )
    kilo = 1e-3
    lines += [
        f"contact force    min {statistics.force_min * kilo:.3f} kN, mean {statistics.force_mean * kilo:.3f} kN, "
        f"max {statistics.force_max * kilo:.3f} kN",
        f"out of contact   {100.0 * statistics.out_of_contact / statistics.samples:.3g} % of the time",
        f"largest residual {statistics.residual_max:.2g}"
        + (f"; NOT RELIABLE in {statistics.unreliable} steps" if statistics.unreliable else ""),
        f"result           {summary.path}",
    ]
    return "\n".join(lines)


def _study(options: argparse.Namespace) -> int:
    from wheelrail.study import load_study, run_study
    from wheelrail.study.run import is_unfinished

    quiet = options.quiet
    study = load_study(options.study)
    path = Path(options.output if options.output is not None else f"{Path(options.study).stem}.nc")
    resume = options.resume or options.retry_failed
    if not resume and not quiet and is_unfinished(path):
        say(f"{path} has points of a study that is not complete, which will be replaced; --resume would continue it")
    with progress_bar("points", total=len(study.points), unit="points", quiet=quiet) as reached:
        summary = run_study(
            study,
            path,
            workers=options.workers,
            scheduler=options.scheduler,
            resume=resume,
            retry_failed=options.retry_failed,
            progress=lambda _, finished: reached(finished),
        )
    for point, reason in summary.failures:
        say(f"failed: point {point.index + 1} ({point.label}): {reason}")
    if summary.interrupted_by is not None:
        target = "" if options.output is None else f" --output {options.output}"
        say(
            f"interrupted; {summary.finished} of {summary.points} points are finished and kept\n"
            f"to continue: wheelrail study {options.study}{target} --resume"
        )
        return 128 + summary.interrupted_by
    if not quiet:
        print(summary)
    return _FAILED_POINTS if summary.failures else 0


def _build(options: argparse.Namespace) -> int:
    from fmu_src.build import build_fmu, describe_fmu
    from fmu_src.errors import SlaveError

    case = case_of(options)
    try:
        with progress_bar("Green's functions") as built:
            path = build_fmu(case, options.output, progress=built)
    except SlaveError as error:
        return _refuse(error)
    fmu = describe_fmu(path)
    print(f"{fmu.path}: {fmu.size / 1e3:.0f} kB, {fmu.ports} ports")
    return 0


def _plot(options: argparse.Namespace) -> int:
    from wheelrail.plotting.files import plot_result

    folder = Path(options.result).parent if options.output is None else Path(options.output)
    with progress_bar("Green's functions") as built:
        plots = plot_result(options.result, folder, format=options.format, progress=built)
    for path in plots.files:
        print(path)
    for reason in plots.left_out:
        say(f"left out: {reason}")
    return 0


def _contact(options: argparse.Namespace) -> int:
    from wheelrail.interaction.build import build_model
    from wheelrail.interaction.simulate import step_count
    from wheelrail.plotting.contact_run import draw_contact

    case = case_of(options)
    with progress_bar("Green's functions") as built:
        model = build_model(case, built)
    steps = options.step or [step_count(duration=case.simulation.duration, dt=model.dt)]
    if not Path(options.output).is_dir():
        return _refuse(WheelrailError(f"{options.output}: no such folder; make it first"))
    with progress_bar("run") as reached:
        files = draw_contact(
            model,
            options.output,
            steps=steps,
            animate=options.animate,
            format=options.format,
            stem=f"{Path(options.case).stem}_contact",
            progress=reached,
        )
    for path in files:
        print(path)
    return 0


def _explain(options: argparse.Namespace) -> int:
    from wheelrail.explain import explain

    print(explain(case_of(options)))
    return 0


def _stability(options: argparse.Namespace) -> int:
    from wheelrail.analysis.sliding_case import case_stability

    result = case_stability(case_of(options))
    print("wheel mode    alone        damping    in sliding contact   damping     growth")
    for mode in result.modes:
        line = f"({mode.name})".ljust(10) + f"{mode.frequency:9.1f} Hz {mode.damping_ratio:12.3e} "
        if mode.converged:
            line += f"{mode.coupled_frequency:15.1f} Hz {mode.coupled_damping_ratio:13.3e} {mode.growth_rate:9.2f} 1/s"
            line += "  grows" if mode.unstable else ""
        else:
            line += "          could not be followed into contact"
        print(line)
    count = len(result.unstable)
    names = ", ".join(f"({mode.name})" for mode in result.unstable) or "-"
    loop = result.loop
    print(
        f"\nsliding at {loop.sliding_speed:.3g} m/s: friction {loop.friction_coefficient:.3g}, slope "
        f"{loop.friction_slope:.3g} s/m, memory {1e6 * loop.memory_distance:g} um"
    )
    print(f"wheel modes that can squeal: {count}: {names}")
    if loop.contact_unstable:
        print(
            "the contact by itself is unstable: friction falls, and its memory is too short or missing; "
            f"friction.memory_distance above {1e6 * loop.critical_memory_distance:.2g} um cures that"
        )
    others = result.growing - count - loop.contact_unstable
    if others > 0:
        print(f"more growing oscillations, of wheel mass and rail (Nyquist's criterion): {others}")
    elif others < 0:
        print(f"warning: Nyquist's criterion counts {result.growing} only; the list above can't be trusted")
    if result.saturation < 0.99:
        print(
            f"warning: in steady rolling the tangential force is {result.saturation:.3f} of the friction limit; this "
            "check takes the contact as sliding fully, so it does not hold here"
        )
    return 0


def _schema(options: argparse.Namespace) -> int:  # noqa: ARG001
    from wheelrail.case import json_schema

    print(json.dumps(json_schema(), indent=2))
    return 0


def _cache(options: argparse.Namespace) -> int:
    from wheelrail.greens.cache import cache_folder, clear_cache, list_cache

    if options.action == "clear":
        count = clear_cache()
        print(f"{cache_folder()}: {count} file{'' if count == 1 else 's'} removed")
        return 0
    entries = list_cache()
    for entry in entries:
        print(f"{entry.path.name}  {entry.size / 1e6:8.1f} MB  {entry.description}")
    print(f"{cache_folder()}: {len(entries)} files, {sum(entry.size for entry in entries) / 1e6:.1f} MB")
    return 0


def _default_case(options: argparse.Namespace) -> int:  # noqa: ARG001
    print(default_case_text(), end="")
    return 0
