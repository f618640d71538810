"""The work of a study: building a model and running a point. Neither raises: what went wrong is in what they return."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from wheelrail.case import Case
from wheelrail.errors import WheelrailError
from wheelrail.interaction.build import build_model
from wheelrail.interaction.model import Model
from wheelrail.interaction.simulate import Simulation
from wheelrail.study.definition import Point, Study
from wheelrail.study.measures import Measure, PointRun, ResultSettings, measured
from wheelrail.study.sharing import groups_of, model_for

__all__ = ["Failure", "Outcome", "build_shared", "outcomes_here", "run_point"]

_REACHED = 1e-6  # of a step


@dataclass(frozen=True)
class Failure:
    """Stands for a model that could not be built.

    Attributes
    ----------
    reason : str
    """

    reason: str


@dataclass(frozen=True)
class Outcome:
    """What came of a point.

    Attributes
    ----------
    index : int
        Of the point.
    reason : str
        Why it failed; empty for one that got to its end.
    remarks : str
        Warnings of the run, one a line.
    values : dict of str to ndarray
        What `wheelrail.study.measures.measured` gives; empty after a failure.
    """

    index: int
    reason: str = ""
    remarks: str = ""
    values: dict[str, NDArray] = field(default_factory=dict)


def _reason(error: Exception) -> str:
    # A message of ours is complete; any other needs its type ("KeyError: 'x'").
    return str(error) if isinstance(error, WheelrailError) else f"{type(error).__name__}: {error}"


def build_shared(case: Case) -> Model | Failure:
    """Build the model that the points of a group share."""
    try:
        return build_model(case)
    except Exception as error:
        return Failure(_reason(error))


def run_point(model: Model | Failure, point: Point, settings: ResultSettings, measure: Measure | None) -> Outcome:
    """Run a point and measure it.

    Parameters
    ----------
    model : Model or Failure
        Of the point's group.
    point : Point
    settings : ResultSettings
    measure : callable, optional
        A measure of one's own.

    Returns
    -------
    Outcome
    """
    if isinstance(model, Failure):
        return Outcome(point.index, reason=model.reason)
    with threadpool_limits(1), _warnings() as remarks:
        try:
            values = _measure(model_for(model, point.case), point.case, settings, measure)
        except Exception as error:
            return Outcome(point.index, reason=_reason(error), remarks="\n".join(remarks))
    return Outcome(point.index, remarks="\n".join(remarks), values=values)


def _measure(model: Model, case: Case, settings: ResultSettings, measure: Measure | None) -> dict[str, NDArray]:
    record = tuple(dict.fromkeys((*settings.record, *case.output.record)))
    run = Simulation(model, duration=case.simulation.duration, record=record)
    outputs = run.collect()
    first = int(np.ceil(settings.settle / model.dt - _REACHED))
    return measured(PointRun(case, model.dt, outputs, slice(first, None)), settings, run.statistics, measure)


@contextmanager
def _warnings() -> Iterator[list[str]]:
    """Collect the warnings of the package; a worker process would print them where nobody looks for them."""
    collected: list[str] = []

    class Collector(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            if record.thread == threading.get_ident():  # a worker may run several points at once
                collected.append(record.getMessage())

    logger, handler = logging.getLogger("wheelrail"), Collector(logging.WARNING)
    logger.addHandler(handler)
    try:
        yield collected
    finally:
        logger.removeHandler(handler)


def outcomes_here(study: Study, points: Sequence[Point], measure: Measure | None) -> Iterator[Outcome]:
    """Compute points one after the other in this process; one model at a time is in memory."""
    for group in groups_of(points):
        model = build_shared(group.points[0].case)
        for point in group.points:
            yield run_point(model, point, study.results, measure)
