"""Run a case and write its result; interrupted runs keep what they have and can be continued."""

from __future__ import annotations

import json
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

from threadpoolctl import threadpool_limits

from wheelrail.case import Case
from wheelrail.errors import WheelrailError
from wheelrail.interaction.build import build_model
from wheelrail.interaction.simulate import BLOCK, Simulation, Statistics, step_count
from wheelrail.interaction.state import State
from wheelrail.results import (
    Checkpoint,
    ResultFileError,
    ResultWriter,
    case_differences,
    check_target,
    read_checkpoint,
)
from wheelrail.version import __version__

__all__ = ["RunSummary", "run_case"]

_MOST_DIFFERENCES = 8


@dataclass(frozen=True)
class RunSummary:
    """What a run has done.

    Attributes
    ----------
    path : Path
        The result.
    complete : bool
        The run got to its end.
    interrupted_by : int or None
        Number of the signal that stopped it.
    steps, planned : int
        Internal steps that the result holds, and that the whole run has.
    resumed_from : int
        Of ``steps``, how many were there before.
    dt : float
        s.
    wall_time : float
        s, for the steps alone.
    statistics : Statistics
        Over the whole result.
    """

    path: Path
    complete: bool
    interrupted_by: int | None
    steps: int
    planned: int
    resumed_from: int
    dt: float
    wall_time: float
    statistics: Statistics


def run_case(
    case: Case,
    path: str | os.PathLike[str],
    *,
    resume: bool = False,
    build_progress: Callable[[float], None] | None = None,
    progress: Callable[[float], None] | None = None,
    block: int = BLOCK,
) -> RunSummary:
    """Build the model of a case, run it and write the result.

    SIGINT (Ctrl-C) and SIGTERM end the run after the present block, and a KeyboardInterrupt from ``progress`` at once:
    the result then holds what there is, is marked as incomplete, and can be continued to the same numbers as without
    the interruption.

    Parameters
    ----------
    case : Case
    path : path-like
        The result; an older one is replaced when the new one is ready.
    resume : bool
        Continue the run whose result is at ``path``, up to the duration of ``case``.
    build_progress : callable, optional
        Called with the share of the Green's functions done.
    progress : callable, optional
        Called with the number of steps done, after each block.
    block : int
        Steps per block.

    Returns
    -------
    RunSummary

    Raises
    ------
    ResultFileError
        If the result can't be written or continued.
    WheelrailError
        If the model can't be built or a step can't be done; what was computed before is then in the result, and a note
        of the error says so.
    """
    path = Path(path)
    check_target(path)
    checkpoint = None
    if resume:
        checkpoint = read_checkpoint(path)
        _check_same_case(checkpoint, case)
    model = build_model(case, progress=build_progress)
    fingerprint = model.fingerprint.hex()
    duration = case.simulation.duration
    planned = step_count(duration=duration, dt=model.dt)
    state, statistics = None, None
    if checkpoint is not None:
        if checkpoint.fingerprint != fingerprint:
            raise ResultFileError(
                f"{path}: can't be continued to the same numbers, the model of the same case has changed: a data "
                "file, or numpy and scipy; run without --resume"
            )
        state = State.from_bytes(model, checkpoint.state)
        statistics = checkpoint.statistics
        if state.step != checkpoint.samples - 1:
            raise ResultFileError(f"{path}: can't be continued, its state and its rows don't belong together")
        if state.step > planned:
            raise ResultFileError(
                f"{path}: holds {state.step * model.dt:g} s already, more than the {duration:g} s asked for"
            )
        if state.step == planned and checkpoint.complete:
            return RunSummary(path, True, None, planned, planned, planned, model.dt, 0.0, checkpoint.statistics)
    simulation = Simulation(
        model, duration=duration, record=case.output.record, state=state, block=block, statistics=statistics
    )
    attributes = {
        "title": model.title,
        "case": model.case,
        "model_report": json.dumps(model.report),
        "model_fingerprint": fingerprint,
        "data_folder": _from_there(path.parent, case.folder),
    }
    begun = simulation.state.step
    with (
        _stop_signals() as received,
        threadpool_limits(1),
        ResultWriter(
            path, attributes=attributes, record=case.output.record, continued=checkpoint is not None
        ) as writer,
    ):

        def finish(complete: bool) -> None:
            state = simulation.state
            writer.finish(
                state=state.to_bytes(),
                digest=state.digest(),
                statistics=simulation.statistics,
                complete=complete,
            )

        clock = time.perf_counter()
        try:
            for rows in simulation:
                writer.append(rows)
                if progress is not None:
                    progress(simulation.state.step)
                if received and simulation.state.step < planned:
                    break
        except KeyboardInterrupt:
            received.append(signal.SIGINT)
        except WheelrailError as error:
            if not isinstance(error, ResultFileError) and writer.samples:
                finish(False)
                error.add_note(f"what was computed before, up to {(writer.samples - 1) * model.dt:.6g} s, is in {path}")
            raise
        wall_time = time.perf_counter() - clock
        complete = simulation.state.step == planned
        finish(complete)
    return RunSummary(
        path=path,
        complete=complete,
        interrupted_by=None if complete else received[0],
        steps=simulation.state.step,
        planned=planned,
        resumed_from=0 if checkpoint is None else begun,
        dt=model.dt,
        wall_time=wall_time,
        statistics=simulation.statistics,
    )


def _from_there(start: Path, folder: Path) -> str:
    """Write a folder as seen from another one, so that both can be moved together."""
    try:
        return Path(os.path.relpath(folder.absolute(), start.absolute())).as_posix()
    except ValueError:  # on another drive
        return folder.absolute().as_posix()


def _check_same_case(checkpoint: Checkpoint, case: Case) -> None:
    path = checkpoint.path
    differences = case_differences(checkpoint.case, case.to_dict())
    if differences:
        shown = differences[:_MOST_DIFFERENCES]
        if len(shown) < len(differences):
            shown.append(f"and {len(differences) - len(shown)} more")
        lines = "\n".join(f"  - {line}" for line in shown)
        raise ResultFileError(
            f"{path}: can't be continued, it belongs to another case; run without --resume or choose another --output\n"
            f"{lines}"
        )
    if checkpoint.version != __version__:
        raise ResultFileError(
            f"{path}: can't be continued, it was written by wheelrail {checkpoint.version} and this is {__version__}; "
            "run without --resume"
        )


@contextmanager
def _stop_signals() -> Iterator[list[int]]:
    """Collect SIGINT and SIGTERM instead of dying from them, so that no step and no write is cut in two."""
    received: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        received.append(number)

    previous = {}
    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) is not signal.SIG_IGN:  # nohup and the like want it ignored
                previous[number] = signal.signal(number, note)
    try:
        yield received
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
