"""Models that points of a study have in common."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from wheelrail.case import Case
from wheelrail.interaction.friction import static_friction_of
from wheelrail.interaction.model import Model
from wheelrail.study.definition import Point

__all__ = ["ModelGroup", "groups_of", "model_for"]

_INPUTS = {
    ("creepage", "x"): "creepage_x",
    ("creepage", "y"): "creepage_y",
    ("creepage", "spin"): "creepage_spin",
    ("contact", "lateral_shift"): "lateral_shift",
}
"""Keys that reach the model as start inputs only."""

_FREE = (
    *_INPUTS,
    ("friction", "coefficient"),
    ("simulation", "duration"),
    ("simulation", "start_position"),
    ("load", "coupling"),
)
"""Keys that shape nothing that is precomputed. The preload is not one of them: it calibrates contact models."""


@dataclass(frozen=True)
class ModelGroup:
    """Points that share one model.

    Attributes
    ----------
    points : tuple of Point
    structure : str
        Equal for groups whose wheel and track have the same Green's functions.
    """

    points: tuple[Point, ...]
    structure: str


def groups_of(points: Sequence[Point]) -> list[ModelGroup]:
    """Sort points into groups that share a model, in the order of their first points."""
    members: dict[str, list[Point]] = {}
    for point in points:
        members.setdefault(_model_key(point.case), []).append(point)
    return [ModelGroup(tuple(group), _structure_key(group[0].case)) for group in members.values()]


def _model_key(case: Case) -> str:
    data = case.to_dict()
    for name in ("title", "output"):
        data.pop(name, None)
    for section, key in _FREE:
        table: dict[str, Any] = data.get(section, {})
        if key == "lateral_shift" and "wheel_profile" in table:
            continue  # where profiles touch decides on radii and on what height counts from
        # A law's points are given by speeds and coefficients; it has no key "coefficient".
        table.pop(key, None)
        if not table:
            data.pop(section, None)
    return json.dumps(data, sort_keys=True)


def _structure_key(case: Case) -> str:
    data = case.to_dict()
    simulation = data["simulation"]
    return json.dumps(
        [
            data["wheel"],
            data["track"],
            data["contact"].get("tangential"),
            *(simulation[key] for key in ("speed", "dx", "first_sample")),
        ],
        sort_keys=True,
    )


def model_for(shared: Model, case: Case) -> Model:
    """Return the model of a case that differs from that of a shared one in free keys only.

    Parameters
    ----------
    shared : Model
        Of any case in the same group.
    case : Case

    Returns
    -------
    Model
        The same as built for the case on its own, apart from the report for people.
    """
    data = case.to_dict()
    inputs = {name: data.get(section, {}).get(key, 0.0) for (section, key), name in _INPUTS.items()}
    model = replace(
        shared,
        title=case.title,
        case=case.to_toml(),
        start_inputs=replace(shared.start_inputs, **{name: float(value) for name, value in inputs.items()}),
    )
    return model.configured(
        friction_coefficient=static_friction_of(case),
        start_position=case.simulation.start_position,
        coupling=case.load.coupling,
    )
