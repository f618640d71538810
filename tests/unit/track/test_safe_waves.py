"""Waves at given frequencies and their superposition."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from skfem import MeshQuad, MeshQuad2

from wheelrail.track.dispersion import disperse
from wheelrail.track.safe_matrices import section_matrices
from wheelrail.track.safe_waves import receptance, static_compliance, waves_at
from wheelrail.track.section import section_from_mesh

FREQUENCY = 700.0


def integrated(matrices, frequency: float, x: np.ndarray, lossy: bool = True) -> np.ndarray:
    """Receptance as the integral over all real wavenumbers, without any eigenvalue problem; shape (k, 3, 3)."""
    k0, k1, k2 = (matrix.toarray() for matrix in matrices.combined(lossy=lossy))
    dynamic = k0 - (2.0 * np.pi * frequency) ** 2 * matrices.mass.toarray()
    head = matrices.head_rows
    turn = np.array([1j, 1.0, 1.0])
    result = np.zeros((len(x), 3, 3), dtype=complex)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    # Fine where there are waves; then no more than some turns of exp(-i k x) in an interval. The mesh lets the
    # integrand fall with the square of k above some 1/mm.
    reach = 8.0 / max(np.max(np.abs(x)), 1e-3)
    limits = [*np.arange(0.0, 30.0, 0.25), 30.0]
    while limits[-1] < (1e9 if np.all(x == 0.0) else 6e4):
        limits.append(limits[-1] + min(0.5 * limits[-1], reach if np.any(x != 0.0) else np.inf))
    for low, high in pairwise(limits):
        for node, weight in zip(nodes, weights, strict=True):
            k = 0.5 * (low + high) + 0.5 * (high - low) * node
            flexibility = head @ np.linalg.solve(dynamic + k * (k1 + k * k2), head.T)
            for sign in (1.0, -1.0):  # K(-k) is K(k) with the axial unknowns turned round
                mirror = np.array([sign, 1.0, 1.0])
                term = (mirror * turn)[:, None] * flexibility * (mirror * turn.conj())
                result += 0.5 * (high - low) * weight * np.exp(-1j * sign * k * x)[:, None, None] * term
    return result / (2.0 * np.pi)


@pytest.mark.parametrize("x", [0.0, 0.03])
def test_all_waves_together_are_the_integral_over_the_wavenumbers(bar_on_rubber, x):
    waves = waves_at(bar_on_rubber, frequency=FREQUENCY, number=bar_on_rubber.size)
    head = bar_on_rubber.head_rows
    found = waves.transfer([x], responses=head, forces=head)
    exact = integrated(bar_on_rubber, FREQUENCY, np.array([x]))
    scale = np.sqrt(np.einsum("kii->ki", np.abs(exact)))
    error = np.abs(found - exact) / (scale[:, :, None] * scale[:, None, :])
    assert error.max() < 1e-6  # achieved: 3e-8 and 2e-7, the part of the integral beyond its limit


def test_static_compliance_is_the_integral_too(bar_on_rubber):
    found = static_compliance(bar_on_rubber, number=bar_on_rubber.size)
    exact = integrated(bar_on_rubber, 0.0, np.array([0.0]), lossy=False).real
    np.testing.assert_allclose(found, exact, rtol=1e-6, atol=1e-9 * exact.max())


def test_few_waves_do_away_from_the_force(bar_on_rubber):
    """Each wave left out decays faster than those kept: 0.1 m away eight of 150 are enough."""
    x = [0.1, 0.3]
    head = bar_on_rubber.head_rows
    all_of_them = waves_at(bar_on_rubber, frequency=FREQUENCY, number=bar_on_rubber.size)
    exact = all_of_them.transfer(x, responses=head, forces=head)
    errors = []
    for number in (4, 8, 16, 32):
        few = waves_at(bar_on_rubber, frequency=FREQUENCY, number=number)
        errors.append(np.abs(few.transfer(x, responses=head, forces=head) - exact).max() / np.abs(exact).max())
    assert errors == sorted(errors, reverse=True)
    # Achieved: 0.66, 3e-6, 2e-9, 3e-12
    assert errors[1] < 1e-5
    assert errors[-1] < 1e-10


def test_the_sparse_solver_finds_the_same_waves_as_the_dense_one(steel):
    mesh = MeshQuad.init_tensor(np.linspace(-0.015, 0.015, 5), np.linspace(0.0, 0.06, 7))
    section = section_from_mesh(MeshQuad2.from_mesh(mesh))
    fine = section_matrices(section, material=steel, pad=None, contact_position=0.008)
    assert fine.size > 300  # so that twelve waves are found by the sparse solver, all of them by the dense one
    sparse = waves_at(fine, frequency=FREQUENCY, number=12)
    dense = waves_at(fine, frequency=FREQUENCY, number=fine.size)
    np.testing.assert_allclose(sparse.wavenumber[:8], dense.wavenumber[:8], rtol=1e-8)


def test_waves_solve_the_equation(bar_on_rubber):
    waves = waves_at(bar_on_rubber, frequency=FREQUENCY, number=12)
    k0, k1, k2 = bar_on_rubber.combined(lossy=True)
    for k, shape in zip(waves.wavenumber, waves.shapes.T, strict=True):
        elastic = (k0 + k * (k1 + k * k2)) @ shape
        inertial = (2.0 * np.pi * FREQUENCY) ** 2 * (bar_on_rubber.mass @ shape)
        assert (
            np.abs(elastic - inertial).max()
            < 1e-8 * np.abs(k2 @ shape).max() * abs(k) ** 2
            + 1e-8 * np.abs(inertial).max()
            + 1e-8 * np.abs(k0 @ shape).max()
        )
        slope = shape @ (k1 @ shape + 2.0 * k * (k2 @ shape))
        assert slope == pytest.approx(1.0, abs=1e-9)
    assert np.all(waves.wavenumber.imag < 0.0)


def test_reciprocity(bar_on_rubber):
    """Head to foot is foot to head, seen from the other side along the rail."""
    waves = waves_at(bar_on_rubber, frequency=FREQUENCY, number=40)
    head, foot = bar_on_rubber.head_rows, bar_on_rubber.foot_rows[:3]
    there = waves.transfer([0.2], responses=foot, forces=head)[0]
    back = waves.transfer([-0.2], responses=head, forces=foot)[0]
    np.testing.assert_allclose(there, back.T, rtol=1e-12, atol=1e-12 * np.abs(there).max())
    point = waves.transfer([0.0], responses=head, forces=head)[0]
    np.testing.assert_allclose(point, point.T, rtol=1e-12)


def test_passivity(bar_on_rubber):
    """Whatever forces act at a point, they feed energy in: Im H is negative semi-definite."""
    f = np.array([30.0, 100.0, 300.0, 1000.0, 3000.0, 6000.0])
    point = receptance(bar_on_rubber, frequency=f, number=bar_on_rubber.size)[:, 0]
    for h in point:
        assert np.linalg.eigvalsh((h - h.conj().T) / 2j).max() < 0.0


def test_without_loss_waves_go_where_their_energy_goes(coarse_bar, steel):
    free = section_matrices(coarse_bar, material=steel, pad=None, contact_position=0.0)
    waves = waves_at(free, frequency=FREQUENCY, lossy=False, number=6)
    travelling = np.abs(waves.wavenumber.imag) < 1e-9
    assert travelling.sum() == 4
    assert np.all(waves.wavenumber[travelling].real > 0.0)
    # And they lie on the dispersion curves, which come from another eigenvalue problem.
    for k in np.sort(waves.wavenumber[travelling].real):
        frequencies = disperse(free, [k], number=4).frequency[0]
        assert np.abs(frequencies / FREQUENCY - 1.0).min() < 1e-9


def test_a_free_rail_at_rest_has_no_answer(coarse_bar, steel):
    free = section_matrices(coarse_bar, material=steel, pad=None, contact_position=0.0)
    with pytest.raises(ValueError, match="free rail has no finite answer at 0 Hz"):
        static_compliance(free)


def test_decay_of_waves(bar_on_rubber):
    waves = waves_at(bar_on_rubber, frequency=FREQUENCY, number=8)
    np.testing.assert_allclose(waves.decay(), -8.685889638 * waves.wavenumber.imag, rtol=1e-9)
    assert waves.propagating().sum() >= 1
