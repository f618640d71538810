"""How fast the three-dimensional contact is: load and creepages change at every step, one thread.

    python -m pytest tests/benchmarks/test_contact_speed.py -m benchmark -s

The baseline of the same run is numpy.linalg.solve of the full contact system: one normal and one tangential solve with
all contact elements, k and 2 k unknowns.
"""

from __future__ import annotations

import cProfile
import pstats
from statistics import median
from time import perf_counter

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift, roll
from wheelrail.contact.tangential import TangentialProblem, influence_matrix

pytestmark = pytest.mark.benchmark

SHEAR_MODULUS, POISSON_RATIO = 207e9 / 2.6, 0.3


class Run:
    """Thesis geometry under changing load and creepages."""

    def __init__(self, elements_across: int, dx: float) -> None:
        self.grid = HalfSpace(elements_across, elements_across, dx, dx, SHEAR_MODULUS, POISSON_RATIO)
        self.gap = self.grid.x**2 / (2 * 0.39) + self.grid.y**2 / (2 * 0.30)
        self.tractions = np.zeros((2, self.grid.elements))
        self.rng = np.random.default_rng(0)
        self.contact = None
        self.number = 0
        self.iterations: list[int] = []
        self.worst = 0.0

    def step(self) -> None:
        k, self.number = self.number, self.number + 1
        load = 65e3 * (1.0 + 0.1 * np.sin(k / 7.0) + 0.02 * self.rng.normal())
        normal = solve_normal(NormalProblem(self.grid, self.gap, 0.0, 1.0, load), self.contact)
        self.contact = normal.contact
        shift = rigid_shift(
            self.grid,
            creepage_x=5e-4 * np.cos(k / 5.0),
            creepage_y=1e-3 * (1.0 + np.sin(k / 11.0)),
            creepage_spin=0.1 * np.sin(k / 13.0),
            distance=self.grid.dx,
        )
        state = roll(self.grid, normal, friction=0.3, shift=shift, previous=self.tractions)
        self.tractions = state.tractions
        self.iterations.append(state.iterations)
        self.worst = max(self.worst, normal.residual, state.residual)

    def full_solve(self) -> None:
        contact = self.contact
        assert contact is not None
        ones = np.ones(len(contact))
        pairs = self.grid.pairs(contact, contact)
        np.linalg.solve(self.grid.coefficients.a33.ravel().take(pairs), ones)
        problem = TangentialProblem(self.grid, contact, ones, np.zeros((2, len(contact))))
        np.linalg.solve(influence_matrix(problem), np.ones(2 * len(contact)))


@pytest.mark.parametrize(("across", "dx", "steps"), [(19, 1e-3, 400), (37, 0.5e-3, 100)])
def test_contact_step(across: int, dx: float, steps: int) -> None:
    with threadpool_limits(1):
        run = Run(across, dx)
        for _ in range(30):
            run.step()
        times, solves = [], []
        for _ in range(steps):
            begin = perf_counter()
            run.step()
            middle = perf_counter()
            run.full_solve()
            times.append(middle - begin)
            solves.append(perf_counter() - middle)
        profile = cProfile.Profile()
        profile.runcall(lambda: [run.step() for _ in range(steps // 4)])
    step, solve = median(times), median(solves)
    assert run.contact is not None
    print(
        f"\n{len(run.contact)} contact elements (dx {1e3 * dx:g} mm): {1e3 * step:.2f} ms, {1 / step:.0f} steps/s, "
        f"{step / solve:.1f} x one full solve ({1e3 * solve:.2f} ms); {np.mean(run.iterations):.1f} Newton iterations, "
        f"largest residual {run.worst:.0e}"
    )
    stats = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    total = sum(entry[2] for entry in stats.values())
    longest = sorted(stats.items(), key=lambda item: -item[1][2])[:5]
    print("  where: " + ", ".join(f"{where[2].strip('<>')} {100 * entry[2] / total:.0f} %" for where, entry in longest))
