"""Boussinesq (1885) and Cerruti (1882): influence coefficients against integration of the point-load solutions.

Under a point load Q on a half-space (Johnson 1985, section 3.6), twice for two bodies of one material:

    u_z = (1 - nu) Q_z / (pi G r)
    u_x = Q_x [(1 - nu) / r + nu x^2 / r^3] / (pi G),      u_y = Q_x nu x y / (pi G r^3)
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.influence import influence_coefficients

G, NU = 207e9 / 2.6, 0.3


def by_integration(x: float, y: float, dx: float, dy: float, nu: float = NU) -> np.ndarray:
    """A33, A11, A22 and A12 in polar coordinates round the receiving point.

    The kernels are k(angle) / r, so that dA = r dr d(angle) leaves the length of the ray inside the element times
    k. Between the corners' directions the length is smooth; panels are halved until nothing changes.
    """
    corners = [(sx * dx / 2 - x, sy * dy / 2 - y) for sx in (-1, 1) for sy in (-1, 1)]
    inside = abs(x) < dx / 2 and abs(y) < dy / 2
    if inside:
        bounds = sorted(np.arctan2(q, p) % (2 * np.pi) for p, q in corners)
        bounds.append(bounds[0] + 2 * np.pi)
    else:
        towards = np.arctan2(-y, -x)
        bounds = sorted(towards + (np.arctan2(q, p) - towards + np.pi) % (2 * np.pi) - np.pi for p, q in corners)

    nodes, weights = np.polynomial.legendre.leggauss(20)

    def panel(low: float, high: float) -> np.ndarray:
        angle = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        c, s = np.cos(angle), np.sin(angle)
        with np.errstate(divide="ignore"):
            across = np.sort([(-dx / 2 - x) / c, (dx / 2 - x) / c], axis=0)
            along = np.sort([(-dy / 2 - y) / s, (dy / 2 - y) / s], axis=0)
        enter = np.maximum(np.maximum(across[0], along[0]), 0.0)
        length = np.maximum(np.minimum(across[1], along[1]) - enter, 0.0)
        kernels = np.array([1 - nu + 0 * c, 1 - nu + nu * c**2, 1 - nu + nu * s**2, nu * c * s])
        return 0.5 * (high - low) * (kernels * length) @ weights

    def adaptive(low: float, high: float, coarse: np.ndarray, depth: int) -> np.ndarray:
        middle = 0.5 * (low + high)
        left, right = panel(low, middle), panel(middle, high)
        if depth == 0 or np.abs(left + right - coarse).max() < 1e-14 * np.abs(coarse).max():
            return left + right
        return adaptive(low, middle, left, depth - 1) + adaptive(middle, high, right, depth - 1)

    total = sum(adaptive(a, b, panel(a, b), 12) for a, b in pairwise(bounds) if b > a)
    return np.asarray(total) / (np.pi * G)


DISTANCES = [
    *[(i, j) for i in (0, 1, 2, 5) for j in (0, 1, 3)],  # own element, neighbours and further, in elements
    *[(-1, 0), (0, -1), (-2, 3), (4, -1), (-16, -16), (16, 0), (0, 40), (100, -70), (300, 1), (1000, 1000)],
    *[(0.25, 0.1), (-0.49, 0.49), (0.7, 0.2), (0.0, 0.3), (1.5001, 0.0), (-2.3, 1.7)],  # not multiples, not at an edge
]


@pytest.mark.parametrize(("dx", "dy"), [(1e-3, 1e-3), (0.5e-3, 2e-3), (3e-3, 0.4e-3)])
def test_coefficients_are_the_integrals_of_the_point_solutions(dx, dy):
    for i, j in DISTANCES:
        x, y = i * dx, j * dy
        found = influence_coefficients(x, y, dx=dx, dy=dy, shear_modulus=G, poisson_ratio=NU)
        expected = by_integration(x, y, dx, dy)
        # relative to A33 at this distance
        error = np.abs(np.array([found.a33, found.a11, found.a22, found.a12]) - expected).max() / expected[0]
        # Far away the formula's differences cancel: an area of dx dy out of terms of size r^2, each good to 1e-16.
        # Up to 5 elements 6e-13, up to 100 1.4e-11, at 300 and 1000 2.3e-9; over the own element's A33 at most 4e-13.
        assert error < (1e-10 if max(abs(i), abs(j)) <= 100 else 1e-8), (i, j)
        assert error * expected[0] < 1e-12 * by_integration(0.0, 0.0, dx, dy)[0], (i, j)


def test_integration_itself():
    """Mean potential of a square over its centre, known in closed form: J3 = 4 dx ln(1 + sqrt 2)."""
    found = by_integration(0.0, 0.0, 1e-3, 1e-3)[0] * np.pi * G / (1 - NU)
    assert found == pytest.approx(4e-3 * np.log(1 + np.sqrt(2)), rel=1e-14)


def test_far_away_the_coefficients_are_those_of_a_point_load():
    dx, dy, x, y = 1e-3, 0.5e-3, 0.2, -0.13
    found = influence_coefficients(x, y, dx=dx, dy=dy, shear_modulus=G, poisson_ratio=NU)
    r = np.hypot(x, y)
    scale = dx * dy / (np.pi * G * r)
    assert found.a33 == pytest.approx(scale * (1 - NU), rel=1e-5, abs=0.0)  # 1e-6, (dx / r)^2 / 24 and less
    assert found.a11 == pytest.approx(scale * (1 - NU + NU * (x / r) ** 2), rel=1e-5, abs=0.0)
    assert found.a22 == pytest.approx(scale * (1 - NU + NU * (y / r) ** 2), rel=1e-5, abs=0.0)
    assert found.a12 == pytest.approx(scale * NU * x * y / r**2, rel=1e-5, abs=0.0)


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.3, 0.5])
def test_poisson_ratio(nu):
    for x, y in ((0.0, 0.0), (1e-3, -2e-3)):
        found = influence_coefficients(x, y, dx=1e-3, dy=0.7e-3, shear_modulus=G, poisson_ratio=nu)
        expected = by_integration(x, y, 1e-3, 0.7e-3, nu)
        np.testing.assert_allclose(
            [found.a33, found.a11, found.a22, found.a12], expected, rtol=0, atol=1e-11 * expected[0]
        )


def test_previous_tractions_act_one_element_upstream():
    """The half-space's shifted coefficients: a particle was at x + dx one step before."""
    half_space = HalfSpace(5, 3, 1e-3, 0.6e-3, G, NU)
    for iy in range(5):
        for ix in range(9):
            expected = by_integration((ix - 4 + 1) * 1e-3, (iy - 2) * 0.6e-3, 1e-3, 0.6e-3)
            found = [getattr(half_space.shifted, name)[iy, ix] for name in ("a33", "a11", "a22", "a12")]
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * expected[0])

    # whole fields
    generator = np.random.default_rng(1)
    tractions = generator.standard_normal((2, 15))
    x = half_space.x[:, None] + 1e-3 - half_space.x
    y = half_space.y[:, None] - half_space.y
    table = influence_coefficients(x, y, dx=1e-3, dy=0.6e-3, shear_modulus=G, poisson_ratio=NU)
    expected = [
        table.a11 @ tractions[0] + table.a12 @ tractions[1],
        table.a12 @ tractions[0] + table.a22 @ tractions[1],
    ]
    np.testing.assert_allclose(
        half_space.carried_displacement(tractions), expected, rtol=0, atol=1e-14 * np.max(expected)
    )
    table = influence_coefficients(x - 1e-3, y, dx=1e-3, dy=0.6e-3, shear_modulus=G, poisson_ratio=NU)
    expected = table.a33 @ tractions[0]
    np.testing.assert_allclose(
        half_space.normal_displacement(tractions[0]), expected, rtol=0, atol=1e-14 * np.abs(expected).max()
    )


def test_symmetries():
    generator = np.random.default_rng(2)
    x, y = generator.uniform(-0.02, 0.02, (2, 200))
    element = {"dx": 1e-3, "dy": 0.6e-3, "shear_modulus": G, "poisson_ratio": NU}
    here = influence_coefficients(x, y, **element)
    for sx, sy in ((-1, -1), (-1, 1), (1, -1)):
        there = influence_coefficients(sx * x, sy * y, **element)
        for name in ("a33", "a11", "a22", "a12"):
            sign = sx * sy if name == "a12" else 1
            error = np.abs(getattr(there, name) - sign * getattr(here, name)).max()
            assert error < 1e-11 * here.a33.min()  # 2e-12
    turned = influence_coefficients(-y, x, dx=0.6e-3, dy=1e-3, shear_modulus=G, poisson_ratio=NU)
    for name, other, sign in (("a33", "a33", 1), ("a11", "a22", 1), ("a22", "a11", 1), ("a12", "a12", -1)):
        assert np.abs(getattr(turned, name) - sign * getattr(here, other)).max() < 1e-11 * here.a33.min()  # 2e-12


@pytest.mark.parametrize(("dx", "dy"), [(1e-3, 1e-3), (1e-3, 0.4e-3)])
def test_assembled_matrices_are_symmetric_and_positive_definite(dx, dy):
    half_space = HalfSpace(11, 9, dx, dy, G, NU)
    everything = np.arange(half_space.elements)
    pairs = half_space.pairs(everything, everything)
    table = half_space.coefficients
    normal = table.a33.ravel()[pairs]
    first, second, cross = (getattr(table, name).ravel()[pairs] for name in ("a11", "a22", "a12"))
    tangential = np.block([[first, cross], [cross, second]])
    for matrix in (normal, tangential):
        # Betti: the work of one load on another's displacements
        assert np.abs(matrix - matrix.T).max() < 3e-14 * matrix.max()  # 9e-15
        values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
        assert values.min() > 0.3 * matrix[0, 0]  # 0.36 to 0.52
    # distances are those of the elements
    i, j = 3, 87
    x, y = half_space.x[i] - half_space.x[j], half_space.y[i] - half_space.y[j]
    alone = influence_coefficients(x, y, dx=dx, dy=dy, shear_modulus=G, poisson_ratio=NU)
    assert cross[i, j] == pytest.approx(float(alone.a12), rel=1e-12, abs=0.0)
    assert normal[i, j] == pytest.approx(float(alone.a33), rel=1e-12, abs=0.0)
