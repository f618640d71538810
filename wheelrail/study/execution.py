"""Computing the points of a study on Dask."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from distributed import Client, KilledWorker, as_completed
from distributed.protocol.pickle import dumps

from wheelrail.errors import ParameterError
from wheelrail.study.definition import Point, Study
from wheelrail.study.measures import Measure, ResultSettings
from wheelrail.study.point import Outcome, build_shared, run_point
from wheelrail.study.sharing import groups_of

__all__ = ["check_picklable", "outcomes_on"]

_DIED = "its worker process died twice, for lack of memory or by a crash"


def outcomes_on(client: Client, study: Study, points: Sequence[Point], measure: Measure | None) -> Iterator[Outcome]:
    """Compute points on a Dask cluster; they come in any order.

    The model of a group is a task of its own, which its points depend on. Groups with the same Green's functions wait
    for the first of them, whose functions are in the cache on disk then, so nothing heavy is computed twice.

    Parameters
    ----------
    client : distributed.Client
    study : Study
    points : sequence of Point
        The ones to compute.
    measure : callable, optional
        A measure of one's own.

    Yields
    ------
    Outcome
    """
    waiting: dict[Any, Point] = {}
    first_of: dict[str, Any] = {}
    for order, group in enumerate(groups_of(points)):
        task = {"pure": False, "priority": -order}
        before = first_of.get(group.structure)
        model = client.submit(_build, group.points[0].case, before, **task)
        if before is None:
            first_of[group.structure] = client.submit(_built, model, **task)
        for point in group.points:
            waiting[client.submit(run_point, model, point, study.results, measure, **task)] = point
        del model  # the scheduler forgets it with the last point that needs it
    suspects = []
    for future in as_completed(list(waiting), loop=client.loop):
        point, error = waiting.pop(future), future.exception()
        if error is None:
            yield future.result()
        elif isinstance(error, KilledWorker):
            suspects.append(point)
        else:
            yield Outcome(point.index, reason=f"{type(error).__name__}: {error}")
        future.release()
    # With a worker goes all that it had before it. One at a time shows which point it was, and gives it all the memory.
    for point in sorted(suspects, key=lambda point: point.index):
        future = client.submit(_run_alone, point, study.results, measure, pure=False)
        error = future.exception()
        if error is None:
            yield future.result()
        else:
            killed = isinstance(error, KilledWorker)
            reason = _DIED if killed else f"{type(error).__name__}: {error}"
            yield Outcome(point.index, reason=reason)


def _build(case: Any, before: object) -> Any:  # noqa: ARG001
    """Build a model after another one."""
    return build_shared(case)


def _built(model: object) -> bool:  # noqa: ARG001
    """Tell that a model is there without carrying it about."""
    return True


def _run_alone(point: Point, settings: ResultSettings, measure: Measure | None) -> Outcome:
    """Run a point without anything that it shares."""
    return run_point(build_shared(point.case), point, settings, measure)


def check_picklable(measure: Measure | None) -> None:
    """Refuse a measure that can't be sent to worker processes.

    Raises
    ------
    ParameterError
    """
    try:
        dumps(measure)
    except Exception as error:
        raise ParameterError(
            "measure", measure, f"can't be sent to worker processes, make it a function of a module ({error})"
        ) from None
