"""Running a study: finished points are kept at once, so that it can be stopped and continued at any time."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

from wheelrail.errors import ParameterError
from wheelrail.results import ResultFileError
from wheelrail.study.dataset import check_study_target, complete_digest, dataset_of, write_dataset
from wheelrail.study.definition import Point, Study
from wheelrail.study.measures import Measure
from wheelrail.study.point import Outcome, outcomes_here
from wheelrail.study.sharing import groups_of
from wheelrail.study.store import PointStore, digest_of, identity_of, parts_path

__all__ = ["StudySummary", "is_unfinished", "run_study"]


@dataclass(frozen=True)
class StudySummary:
    """What the run of a study has done.

    Attributes
    ----------
    path : Path
        The data set; written if the study was not interrupted.
    points : int
        Points of the study.
    finished : int
        Points that have been computed or have failed.
    resumed_from : int
        Of ``finished``, how many were there before.
    failures : tuple of (Point, str)
        Points that failed, with the reasons.
    models : int
        Models that were built.
    workers : int
        Local worker processes that were started.
    wall_time : float
        s.
    interrupted_by : int or None
        Number of the signal that stopped it.
    """

    path: Path
    points: int
    finished: int
    resumed_from: int
    failures: tuple[tuple[Point, str], ...]
    models: int
    workers: int
    wall_time: float
    interrupted_by: int | None

    @property
    def complete(self) -> bool:
        """Whether every point was reached, failed ones included."""
        return self.finished == self.points

    def __str__(self) -> str:
        failed, now = len(self.failures), self.finished - self.resumed_from
        points = f"{self.finished - failed} done, {failed} failed"
        if self.resumed_from:
            points += f"; {self.resumed_from} were there before"
        lines = [f"points           {points}"]
        if now:
            built = f"{self.models} model{'' if self.models == 1 else 's'}"
            lines.append(f"computing time   {self.wall_time:.3g} s for {now} points with {built}")
        lines.append(f"result           {self.path}")
        return "\n".join(lines)


def is_unfinished(path: Path) -> bool:
    """Tell whether there are points of a study that is not complete."""
    return parts_path(path).is_dir()


def run_study(
    study: Study,
    path: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    resume: bool = False,
    retry_failed: bool = False,
    measure: Measure | None = None,
    progress: Callable[[Outcome | None, int], None] | None = None,
) -> StudySummary:
    """Compute all points of a study and write the data set.

    The numbers do not depend on the number of workers, nor on where the study was interrupted. SIGINT (Ctrl-C) and
    SIGTERM end it at once; the points in progress are lost, the others are kept beside ``path`` and used with
    ``resume``. A point that fails does not stop the others.

    Parameters
    ----------
    study : Study
    path : path-like
        The data set; an older one is replaced when the new one is ready.
    workers : int, optional
        Local worker processes; 0 for none, in this process. Left out: what the study says, else one for each core that
        this process may use. A script that starts workers has to guard its main part by
        ``if __name__ == "__main__"``.
    scheduler : str, optional
        Address of an existing Dask cluster to use instead.
    resume : bool
        Continue the study whose points are kept beside ``path``.
    retry_failed : bool
        Continue it, and compute failed points again.
    measure : callable, optional
        A measure of one's own: takes a `wheelrail.study.PointRun` and returns numbers or arrays by name. It has to be
        a function that worker processes can import, at the top of a module or of the script.
    progress : callable, optional
        Called with each outcome (at first None) and the number of finished points.

    Returns
    -------
    StudySummary

    Raises
    ------
    ResultFileError
        If the data set or the points can't be written, or the study can't be continued.
    ParameterError
        If the number of workers, the scheduler or the measure can't be used.
    """
    path = Path(path)
    processes = 0 if scheduler is not None else _worker_count(study, workers)
    check_study_target(path)
    identity = identity_of(study, measure)
    store, digest = PointStore(path, identity), digest_of(identity)
    count = len(study.points)
    failures: dict[int, str] = {}
    finished: set[int] = set()
    clock = time.perf_counter()

    def summary(*, resumed_from: int, models: int, interrupted_by: int | None) -> StudySummary:
        return StudySummary(
            path=path,
            points=count,
            finished=len(finished),
            resumed_from=resumed_from,
            failures=tuple((study.points[index], failures[index]) for index in sorted(failures)),
            models=models,
            workers=processes,
            wall_time=time.perf_counter() - clock,
            interrupted_by=interrupted_by,
        )

    if resume or retry_failed:
        if not store.exists:
            if complete_digest(path) == digest:
                finished.update(range(count))
                return summary(resumed_from=count, models=0, interrupted_by=None)
            raise ResultFileError(f"{path}: there is no interrupted study to continue; run without --resume")
        store.check_same()
        for point in study.points:
            outcome = store.load(point.index)
            if outcome is None or (outcome.reason and retry_failed):
                continue
            finished.add(point.index)
            if outcome.reason:
                failures[point.index] = outcome.reason
    else:
        store.begin()
    before = len(finished)
    remaining = [point for point in study.points if point.index not in finished]
    models = len(groups_of(remaining))
    processes = min(processes, len(remaining))
    if progress is not None:
        progress(None, before)
    with _stop_signals() as received:
        try:
            with closing(_outcomes(study, remaining, measure, processes, scheduler)) as outcomes:
                for outcome in outcomes:
                    store.keep(outcome)
                    finished.add(outcome.index)
                    if outcome.reason:
                        failures[outcome.index] = outcome.reason
                    if progress is not None:
                        progress(outcome, len(finished))
            write_dataset(dataset_of(study, lambda index: _kept(store, index), digest=digest), path)
        except KeyboardInterrupt:
            number = received[0] if received else signal.SIGINT
            return summary(resumed_from=before, models=models, interrupted_by=number)
    if not failures:
        store.remove()
    return summary(resumed_from=before, models=models, interrupted_by=None)


def _kept(store: PointStore, index: int) -> Outcome:
    outcome = store.load(index)
    if outcome is None:
        raise ResultFileError(f"{store.folder}: point {index + 1} is missing or damaged; use --resume to compute it")
    return outcome


def _worker_count(study: Study, workers: int | None) -> int:
    if workers is None:
        workers = study.workers
    if workers is None:
        usable = getattr(os, "sched_getaffinity", None)
        workers = len(usable(0)) if usable is not None else os.cpu_count() or 1
    if workers < 0:
        raise ParameterError("workers", workers, "must be a whole number >= 0")
    return workers


def _outcomes(
    study: Study, points: Sequence[Point], measure: Measure | None, workers: int, scheduler: str | None
) -> Generator[Outcome, None, None]:
    if not points:
        return
    if scheduler is None and workers == 0:
        yield from outcomes_here(study, points, measure)
        return
    # Dask is imported when it is needed only: it takes long.
    from wheelrail.study.cluster import existing_cluster, local_workers
    from wheelrail.study.execution import check_picklable, outcomes_on

    check_picklable(measure)
    with local_workers(workers) if scheduler is None else existing_cluster(scheduler) as client:
        yield from outcomes_on(client, study, points, measure)


@contextmanager
def _stop_signals() -> Iterator[list[int]]:
    """Let the first SIGINT or SIGTERM raise KeyboardInterrupt, and ignore further ones while things are put away."""
    received: list[int] = []
    previous = {}

    def stop(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        if not received:
            received.append(number)
            raise KeyboardInterrupt

    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) is not signal.SIG_IGN:  # nohup and the like want it ignored
                previous[number] = signal.signal(number, stop)
    try:
        yield received
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
