"""A study as one immutable object: its axes, its points and what is kept of each."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wheelrail.case import Case
from wheelrail.case.faults import section_models, shown_value
from wheelrail.case.fields import unit_of
from wheelrail.results.layout import OUTPUTS
from wheelrail.study.measures import ResultSettings

__all__ = ["Axis", "Point", "Study"]


@dataclass(frozen=True)
class Axis:
    """A key of the case file and the values that it takes.

    Attributes
    ----------
    key : str
        As in the study file, such as ``friction.coefficient`` or ``excitation.1.amplitude``.
    values : tuple
        Values of a grid's axis; of a list, the value at each point.
    """

    key: str
    values: tuple[Any, ...]

    @property
    def name(self) -> str:
        """Name of the coordinate in the data set."""
        name = self.key.replace(".", "_")
        return f"case_{name}" if name in OUTPUTS else name  # contact.length is not the output contact_length

    @property
    def unit(self) -> str | None:
        """SI unit; None for a key that is not a number."""
        return None if self._field is None else unit_of(self._field)

    @property
    def description(self) -> str:
        """Meaning of the key."""
        return "" if self._field is None else self._field.description or ""

    @property
    def _field(self) -> Any:
        section, *_, last = self.key.split(".")
        fields = (model.model_fields.get(last) for model in section_models(section).values())
        return next((field for field in fields if field is not None), None)


@dataclass(frozen=True)
class Point:
    """One case of a study.

    Attributes
    ----------
    index : int
        From 0, in the order of the points: the last axis of a grid runs fastest.
    label : str
        Where the point is, for people.
    case : Case
    """

    index: int
    label: str
    case: Case


@dataclass(frozen=True)
class Study:
    """A parameter study; read one with `load_study` or make one with `study_from_dict`.

    Attributes
    ----------
    title, source : str
        Title, and the file (or other origin) for messages.
    text, case_text : str
        The study file and the case file that it starts from.
    base : dict
        The case file as plain values with those of ``[set]``, presets not yet resolved.
    axes : tuple of Axis
    grid : bool
        True: the points are all combinations of the axes' values; False: each axis has one value for each point.
    points : tuple of Point
    results : ResultSettings
    seed : int or None
        Where every point draws its own roughness: what its seeds are derived from.
    workers : int or None
        Number of workers that the study file asks for.
    """

    title: str
    source: str
    text: str
    case_text: str
    base: dict[str, Any]
    axes: tuple[Axis, ...]
    grid: bool
    points: tuple[Point, ...]
    results: ResultSettings
    seed: int | None
    workers: int | None

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each axis of a grid; number of points of a list."""
        return tuple(len(axis.values) for axis in self.axes) if self.grid else (len(self.points),)

    @property
    def folder(self) -> Path:
        """Folder that the data files of the cases are relative to."""
        return self.points[0].case.folder


def label_of(keys: tuple[str, ...], values: tuple[Any, ...]) -> str:
    """Say where a point is."""
    return ", ".join(f"{key} = {shown_value(value)}" for key, value in zip(keys, values, strict=True))
