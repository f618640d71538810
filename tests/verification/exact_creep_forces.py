"""Creep forces of Kalker's exact theory by an independent implementation, `tests/data/creep_forces_exact.csv`."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from wheelrail.contact.creep.creep_force import CreepForce

SHEAR_MODULUS, POISSON_RATIO = 207e9 / 2.6, 0.3
ELLIPSE = {"semi_axis_x": 5.749245229979842e-3, "semi_axis_y": 4.826949299763069e-3}
ELASTIC = {**ELLIPSE, "shear_modulus": SHEAR_MODULUS, "poisson_ratio": POISSON_RATIO}
FRICTION = {"load": 65e3, "friction_coefficient": 0.3}
LIMIT = 0.3 * 65e3


@dataclass(frozen=True)
class ExactCase:
    """One row; the creepages are those the reference has used, its spin dx / 6 included."""

    creepage: dict[str, float]
    force: CreepForce
    elements: int

    @property
    def kind(self) -> str:
        x, y, spin = (abs(self.creepage[name]) > 0.0 for name in ("creepage_x", "creepage_y", "spin"))
        if spin:
            return "combined with spin" if x or abs(self.creepage["creepage_y"]) > 0.2e-3 else "spin"
        return "combined" if x and y else "pure"

    def deviation(self, law) -> float:
        """Of a law's force vector, over the friction limit."""
        return ((law.force_x - self.force.force_x) ** 2 + (law.force_y - self.force.force_y) ** 2) ** 0.5 / LIMIT


def exact_cases(dx: float) -> list[ExactCase]:
    cases = []
    path = Path(__file__).parents[1] / "data" / "creep_forces_exact.csv"
    with path.open() as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if float(row["dx_m"]) == dx:
                spin = float(row["spin_1_per_m"])
                creepage = {
                    "creepage_x": float(row["creepage_x"]),
                    "creepage_y": float(row["creepage_y"]) + spin * dx / 6.0,
                    "spin": spin,
                }
                force = CreepForce(*(float(row[name]) for name in ("force_x_N", "force_y_N", "moment_spin_Nm")))
                cases.append(ExactCase(creepage, force, int(row["elements"])))
    assert len(cases) == 40
    return cases


def worst_by_kind(law) -> dict[str, float]:
    """Largest deviation over the friction limit for each kind of creepage, on the finer grid (0.5 mm)."""
    worst: dict[str, float] = {}
    for case in exact_cases(0.5e-3):
        worst[case.kind] = max(worst.get(case.kind, 0.0), case.deviation(law(case.creepage)))
    return worst
