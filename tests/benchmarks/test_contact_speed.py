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

from wheelrail.contact.friction.laws import KraftLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift, roll
from wheelrail.contact.slip_dependent_rolling import entering, roll_slip_dependent
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


class FallingRun(Run):
    """The same with a friction law, or steady load and creepage; zero tractions at the start."""

    def __init__(self, elements_across: int, dx: float, friction: SlipFriction | None, steady: bool) -> None:
        super().__init__(elements_across, dx)
        self.friction, self.steady = friction, steady
        self.speed = np.zeros(self.grid.elements)
        self.coefficient = np.zeros(self.grid.elements)
        if friction is not None:
            self.coefficient = entering(self.grid, friction, 0.3)

    def step(self) -> None:
        k, self.number = self.number, self.number + 1
        load = 65e3 if self.steady else 65e3 * (1.0 + 0.1 * np.sin(k / 7.0) + 0.02 * self.rng.normal())
        normal = solve_normal(NormalProblem(self.grid, self.gap, 0.0, 1.0, load), self.contact)
        self.contact = normal.contact
        creepages = (0.0, 5e-3, 0.0) if self.steady else (5e-4 * np.cos(k / 5.0), 5e-3 * (1.0 + np.sin(k / 11.0)), 0.1)
        x, y, spin = creepages
        shift = rigid_shift(self.grid, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=self.grid.dx)
        if self.friction is None:
            rolling = roll(self.grid, normal, friction=0.3, shift=shift, previous=self.tractions)
        else:
            state = roll_slip_dependent(
                self.grid,
                normal,
                friction=self.friction,
                static=0.3,
                dt=self.grid.dx / (50.0 / 3.6),
                shift=shift,
                previous=self.tractions,
                speed=self.speed,
                coefficient=self.coefficient,
            )
            rolling, self.speed, self.coefficient = state.rolling, state.speed, state.coefficient
        self.tractions = rolling.tractions
        self.worst = max(self.worst, rolling.residual)


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


@pytest.mark.parametrize(("across", "dx", "steps"), [(19, 1e-3, 200), (37, 0.5e-3, 60)])
def test_falling_friction_step(across: int, dx: float, steps: int) -> None:
    """The same run, and thesis section 5.3.2, with constant and with slip-velocity dependent friction."""
    runs = {
        "constant": None,
        "Kraft, memory 3 um": SlipFriction(KraftLaw(True), FrictionMemory(3e-6, 1e-3)),
        "Kraft, no memory": SlipFriction(KraftLaw(True)),
        "Kraft, no memory, the thesis' way": SlipFriction(KraftLaw(True), solver="broyden"),
    }
    with threadpool_limits(1):
        for case, steady in (("changing load and creepages", False), ("65 kN, lateral creepage 0.5 %", True)):
            print(f"\ndx {1e3 * dx:g} mm, {case}")
            contenders = {name: FallingRun(across, dx, friction, steady) for name, friction in runs.items()}
            times: dict[str, list[float]] = {name: [] for name in runs}
            for number in range(steps):
                for name, run in contenders.items():  # in turn, so that all see the same machine
                    begin = perf_counter()
                    run.step()
                    if number >= steps // 4:
                        times[name].append(perf_counter() - begin)
            base = median(times["constant"])
            for name, run in contenders.items():
                print(
                    f"  {name:34s} {1e3 * median(times[name]):7.2f} ms, {median(times[name]) / base:5.2f} x constant; "
                    f"mean {np.mean(times[name]) / np.mean(times['constant']):5.2f} x; largest residual {run.worst:.0e}"
                )
