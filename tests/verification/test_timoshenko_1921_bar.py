"""Waves in a rectangular bar: bending (Timoshenko 1921), torsion (Saint-Venant 1855), stretching (Rayleigh, Love).

The shear coefficient is that of Hutchinson (2001, Journal of Applied Mechanics 68, eq. 50), which follows from
three-dimensional elasticity; Timoshenko's own 5 (1 + nu) / (6 + 5 nu) is that of a thin plate on edge.
"""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.track.dispersion import disperse
from wheelrail.track.safe_matrices import Material, section_matrices
from wheelrail.track.section import RailSection

E, NU, RHO = 207e9, 0.3, 7860.0
G = 0.5 * E / (1.0 + NU)
WIDTH, HEIGHT = 0.03, 0.06
K = np.array([1.0, 2.0, 5.0, 10.0, 20.0])  # rad/m
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=RHO, loss_factor=0.0)


def bar(size: float):
    half = 0.5 * WIDTH
    section = RailSection(np.array([(-half, 0.0), (half, 0.0), (half, HEIGHT), (-half, HEIGHT)]))
    return section_matrices(section, material=STEEL, pad=None, contact_position=0.0, size=size)


@pytest.fixture(scope="module")
def curves():
    found = disperse(bar(0.004), K, number=4)
    return {name: 2.0 * np.pi * found.frequency[:, i] for i, name in enumerate(found.names)}


def shear_coefficient(depth: float, width: float) -> float:
    a, b = 0.5 * depth, 0.5 * width
    n = np.arange(1, 60)
    series = 16.0 * NU**2 * b**5 * (n * np.pi * a - b * np.tanh(n * np.pi * a / b)) / ((n * np.pi) ** 5 * (1.0 + NU))
    c4 = 4.0 / 45.0 * a**3 * b * (-12.0 * a**2 - 15.0 * NU * a**2 + 5.0 * NU * b**2) + series.sum()
    return -2.0 * (1.0 + NU) / (9.0 / (4.0 * a**5 * b) * c4 + NU * (1.0 - b**2 / a**2))


def timoshenko(depth: float, width: float) -> np.ndarray:
    """Lower branch of Timoshenko's equation, rad/s."""
    area, inertia = depth * width, width * depth**3 / 12.0
    shear = shear_coefficient(depth, width) * G * area
    mass, rotary = RHO * area, RHO * inertia
    linear = mass * (E * inertia * K**2 + shear) + rotary * shear * K**2
    product = mass * rotary * E * inertia * shear * K**4
    return np.sqrt((linear - np.sqrt(linear**2 - 4.0 * product)) / (2.0 * mass * rotary))


def torsion_constant() -> float:
    a, b = 0.5 * HEIGHT, 0.5 * WIDTH
    n = np.arange(1, 60, 2)
    return 16.0 * a * b**3 * (1.0 / 3.0 - 64.0 / np.pi**5 * b / a * np.sum(np.tanh(n * np.pi * a / (2.0 * b)) / n**5))


def test_bending(curves):
    # Achieved: up to 1.1e-6 at 5 rad/m, 3.4e-5 at 10 and 3.1e-4 at 20, where a wave is five heights long.
    limits = np.array([1e-6, 1e-6, 5e-6, 5e-5, 5e-4])
    assert np.all(np.abs(curves["vertical bending"] / timoshenko(HEIGHT, WIDTH) - 1.0) < limits)
    assert np.all(np.abs(curves["lateral bending"] / timoshenko(WIDTH, HEIGHT) - 1.0) < limits)


def test_torsion(curves):
    """At long waves; shorter ones are stiffened by what warping costs, with the square of the wavenumber."""
    polar = WIDTH * HEIGHT * (WIDTH**2 + HEIGHT**2) / 12.0
    error = curves["torsion"] / (K * np.sqrt(G * torsion_constant() / (RHO * polar))) - 1.0
    assert abs(error[0]) < 1e-4  # achieved: 5.4e-5
    assert abs(error[1]) < 5e-4  # achieved: 1.4e-4
    assert np.all(np.diff(error) > 0.0)
    assert (error[3] - error[1]) / (error[2] - error[1]) == pytest.approx((100.0 - 4.0) / (25.0 - 4.0), rel=0.05)


def test_stretching(curves):
    """With the lateral inertia of Rayleigh and Love."""
    polar_radius = (WIDTH**2 + HEIGHT**2) / 12.0
    love = K * np.sqrt(E / RHO) / np.sqrt(1.0 + NU**2 * K**2 * polar_radius)
    error = np.abs(curves["longitudinal"] / love - 1.0)
    assert np.all(error < [1e-8, 1e-7, 5e-6, 1e-4, 1e-3])  # achieved: 4e-9, 7e-8, 2.8e-6, 4.6e-5, 8.0e-4


def test_finer_elements_converge():
    """Torsion constant of Saint-Venant; its error is that of the warping, which the corners hardly disturb."""
    polar = WIDTH * HEIGHT * (WIDTH**2 + HEIGHT**2) / 12.0
    errors = []
    for size in (0.015, 0.004, 0.002):
        found = disperse(bar(size), [0.01], number=4)
        omega = 2.0 * np.pi * found.frequency[0, found.names.index("torsion")]
        errors.append(omega / (0.01 * np.sqrt(G * torsion_constant() / (RHO * polar))) - 1.0)
    assert errors[0] > errors[1] > errors[2] > 0.0
    assert errors[2] < 5e-6  # achieved: 1.9e-4, 2.5e-5, 3.2e-6
