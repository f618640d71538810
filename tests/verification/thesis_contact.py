"""The contact of Pieringer (2011), section 4.3: wheel radius 0.39 m, rail head radius 0.30 m, E 207 GPa, nu 0.3."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, NormalState, solve_normal

SHEAR_MODULUS, POISSON_RATIO = 207e9 / 2.6, 0.3
WHEEL_RADIUS, RAIL_RADIUS = 0.39, 0.30
LOAD, FRICTION = 65e3, 0.3
LIMIT = FRICTION * LOAD
DATA = Path(__file__).parents[1] / "data"


def rows(name: str) -> list[dict[str, float]]:
    with (DATA / name).open() as file:
        table = csv.DictReader(line for line in file if not line.startswith("#"))
        return [{key: float(value) for key, value in row.items()} for row in table]


def grid(dx: float, mx: int, my: int | None = None) -> HalfSpace:
    return HalfSpace(mx, mx if my is None else my, dx, dx, SHEAR_MODULUS, POISSON_RATIO)


def distance(half_space: HalfSpace, *, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    """Undeformed distance, the nominal point at (x, y)."""
    return (half_space.x - x) ** 2 / (2.0 * WHEEL_RADIUS) + (half_space.y - y) ** 2 / (2.0 * RAIL_RADIUS)


def loaded(half_space: HalfSpace, undeformed: np.ndarray | None = None, load: float = LOAD) -> NormalState:
    h = distance(half_space) if undeformed is None else undeformed
    return solve_normal(NormalProblem(half_space, h, 0.0, 1.0, load))


def pressed(half_space: HalfSpace, approach: float, undeformed: np.ndarray | None = None) -> NormalState:
    h = distance(half_space) if undeformed is None else undeformed
    return solve_normal(NormalProblem(half_space, h, 1.0, 0.0, approach))
