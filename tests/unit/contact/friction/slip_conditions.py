"""Slip-dependent contact evaluated from the equations: published formulas and full matrices, nothing of the solvers."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from wheelrail.contact.friction.laws import (
    ConstantLaw,
    ExponentialLaw,
    FrictionLaw,
    KraftLaw,
    PolachLaw,
    RationalLaw,
    TableLaw,
)
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.problem import SlipFrictionProblem
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.influence import influence_coefficients
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift

STEEL = 207e9 / 2.6, 0.3
GRID = HalfSpace(9, 9, 1e-3, 1e-3, *STEEL)
NORMAL = solve_normal(NormalProblem(GRID, GRID.x**2 / (2 * 0.39) + GRID.y**2 / (2 * 0.30), 0.0, 1.0, 20e3))

Formula = Callable[[float], float]
KINDS = ("constant", "kraft", "kraft as printed", "polach", "exponential", "rational", "table")


def law_and_formula(kind: str, generator: np.random.Generator) -> tuple[FrictionLaw, Formula]:
    """A law with random parameters, and mu / mu_s over the slip velocity as published."""
    ratio, half, square = generator.uniform(0, 1), 10.0 ** generator.uniform(-2, 1), 10.0 ** generator.uniform(-1, 1)
    share, decay = generator.uniform(0, 1), 10.0 ** generator.uniform(-2, 1.5)
    speeds = [0.0, *np.cumsum(10.0 ** generator.uniform(-2, 0, 4)).tolist()]
    ratios = [1.0, *generator.uniform(0.2, 1.2, 4).tolist()]
    return {
        "constant": lambda: (ConstantLaw(), lambda _: 1.0),
        "kraft": lambda: (KraftLaw(True), lambda s: (20 / (100 + s**2) + 0.1 / (0.2 + s)) / 0.7),
        "kraft as printed": lambda: (KraftLaw(False), lambda s: 20 / (100 + s**2) + 0.1 / (0.2 + s)),
        "polach": lambda: (PolachLaw(ratio, decay), lambda s: (1 - ratio) * math.exp(-decay * s) + ratio),
        "exponential": lambda: (
            ExponentialLaw(ratio, half),
            lambda s: ratio + (1 - ratio) * math.exp(-math.log(2) * s / half),
        ),
        "rational": lambda: (
            RationalLaw(ratio, half, share, square),
            lambda s: ratio + (1 - ratio) * ((1 - share) * half / (half + s) + share * square**2 / (square**2 + s**2)),
        ),
        "table": lambda: (TableLaw(tuple(speeds), tuple(ratios)), lambda s: float(np.interp(s, speeds, ratios))),
    }[kind]()


@cache
def influence(grid: HalfSpace, moved: bool = False) -> tuple[NDArray, NDArray, NDArray]:
    """A11, A22 and A12 of all elements on all, each shape (n, n), m/Pa; ``moved``: seen from one element upstream."""
    table = influence_coefficients(
        grid.x[:, None] - grid.x + (grid.dx if moved else 0.0),
        grid.y[:, None] - grid.y,
        dx=grid.dx,
        dy=grid.dy,
        shear_modulus=grid.shear_modulus,
        poisson_ratio=grid.poisson_ratio,
    )
    return table.a11, table.a22, table.a12


def slip_of(problem: SlipFrictionProblem, tractions: NDArray) -> NDArray:
    """Slip distances S = A p + h in m, shape (2, k), with what rail and wheel give way as a whole."""
    grid, (px, py) = problem.half_space, tractions
    a11, a22, a12 = (table[np.ix_(problem.contact, problem.contact)] for table in influence(grid))
    slip = np.stack([a11 @ px + a12 @ py, a12 @ px + a22 @ py]) + problem.shift
    if problem.compliance is not None:
        slip = slip + (problem.compliance @ (grid.dx * grid.dy * tractions.sum(axis=1)))[:, None]
    return slip


def coefficient_of(problem: SlipFrictionProblem, formula: Formula, slip: NDArray) -> NDArray:
    """Friction coefficients at slip distances: the law, or what the memory makes of it in one backward Euler step."""
    speed = np.hypot(*slip) / problem.dt
    law = problem.static * np.array([formula(float(s)) for s in speed])
    if problem.memory is None:
        return law
    # mu - mu' = -dt max(s, s_0) / d_c (mu - mu_law)
    rate = problem.dt * np.maximum(speed, problem.memory.speed) / problem.memory.distance
    return (problem.previous + rate * law) / (1.0 + rate)


def violation(problem: SlipFrictionProblem, formula: Formula, tractions: NDArray) -> float:
    """Of |p| <= mu(s) p3 and p |S| + mu(s) p3 S = 0, over the largest bound.

    Together they say all: where there is slip, p = -mu p3 S / |S|. Slip counts by the traction that makes it on one
    element.
    """
    slip = slip_of(problem, tractions)
    bound = coefficient_of(problem, formula, slip) * problem.pressure
    size, scaled = np.hypot(*tractions), slip / influence(problem.half_space)[0][0, 0]
    against = np.hypot(*(tractions * np.hypot(*scaled) + bound * scaled))
    against = against / np.maximum(np.hypot(*scaled), bound.max())
    return float(max((size - bound).max(), against.max()) / bound.max())


def random_problem(
    generator: np.random.Generator, kinds: tuple[str, ...] = KINDS
) -> tuple[SlipFrictionProblem, Formula]:
    """A step of random creepages up to some per cent, law, memory, compliance and history."""
    at = NORMAL.contact
    k = len(at)
    law, formula = law_and_formula(str(generator.choice(kinds)), generator)
    dt = GRID.dx / 10.0 ** generator.uniform(0.7, 1.8)
    static = 10.0 ** generator.uniform(-1.3, 0)
    x, y = 10.0 ** generator.uniform(-5, -2) * generator.standard_normal(2)
    spin = 10.0 ** generator.uniform(-3, 0.3) * generator.standard_normal()
    shift = rigid_shift(GRID, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=GRID.dx)[:, at]
    history = generator.integers(3)
    if history == 1:  # what tractions in any direction have displaced one step before
        angle, carried = generator.uniform(0, 2 * np.pi), np.zeros((2, GRID.elements))
        size = static * NORMAL.pressure[at] * generator.uniform(0, 1, k)
        carried[:, at] = size * np.array([[np.cos(angle)], [np.sin(angle)]])
        shift = shift - GRID.carried_displacement(carried)[:, at]
    elif history == 2:
        shift = shift + 10.0 ** generator.uniform(-8, -5.5) * generator.standard_normal((2, k))
    memory = compliance = None
    if generator.random() < 0.5:
        memory = FrictionMemory(10.0 ** generator.uniform(-7, -3.5), 10.0 ** generator.uniform(-4, -1))
    if generator.random() < 0.4:
        root = generator.standard_normal((2, 2))
        compliance = root @ root.T * 10.0 ** generator.uniform(-11, -9)
    previous = static * formula(0.0) * generator.uniform(0.3, 1, k)
    problem = SlipFrictionProblem(
        GRID,
        at,
        NORMAL.pressure[at],
        shift,
        dt,
        law,
        static,
        memory,
        None if memory is None else previous,
        compliance,
    )
    return problem, formula


def random_guess(problem: SlipFrictionProblem, generator: np.random.Generator) -> tuple[NDArray, NDArray]:
    """Tractions and slip velocities to start from: stick, full slip, or anything."""
    k = len(problem.contact)
    bound = problem.static * problem.pressure
    tractions = bound * generator.uniform(-0.7, 0.7, (2, k)) * (generator.random() < 0.5)
    speeds = (np.zeros(k), problem.speed(problem.shift), 10.0 ** generator.uniform(-3, 1, k))
    return tractions, speeds[generator.integers(3)]
