"""A rail on a continuous pad against beams and rigid bodies on springs, and the thesis' figures."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import spsolve

from wheelrail.track.dispersion import cut_on_frequencies
from wheelrail.track.reduced_section import reduce_section
from wheelrail.track.ring import close_ring
from wheelrail.track.safe_matrices import Material, Pad, SectionMatrices, section_matrices
from wheelrail.track.safe_waves import receptance, static_compliance, waves_at
from wheelrail.track.section_sources import preset_section

SHEAR_STIFFNESS = 241e6  # N, 60E1 with E = 207 GPa (Timoshenko beam fitted to its long waves by an independent code)
STEEL = Material(youngs_modulus=207e9, poisson_ratio=0.3, density=7860.0, loss_factor=0.01)


def rubber(loss_factor: float = 0.25) -> Material:
    return Material(youngs_modulus=4.8e6, poisson_ratio=0.45, density=10.0, loss_factor=loss_factor)


def supported(thickness: float, contact_position: float, size: float = 0.008) -> SectionMatrices:
    pad = Pad(material=rubber(), thickness=thickness)
    return section_matrices(
        preset_section("60e1"), material=STEEL, pad=pad, contact_position=contact_position, size=size
    )


@pytest.fixture(scope="module")
def soft():
    return supported(0.03, 0.0)


@pytest.fixture(scope="module")
def off_centre():
    return supported(0.01, 0.012)


def foundation_stiffness(matrices: SectionMatrices) -> float:
    """Vertical stiffness per length, N/m2: an endless line load on the head over the mean sinking of the foot."""
    displacement = spsolve(matrices.combined(lossy=False)[0].tocsc(), matrices.head_rows[2])
    return 1.0 / (matrices.foot_rows[2] @ displacement)


def timoshenko_beam(x, frequency: float, foundation: complex, loss_factor: float) -> np.ndarray:
    """Receptance of Timoshenko's beam on a Winkler foundation, by residues; m/N."""
    section = preset_section("60e1")
    factor = 1.0 + 1j * loss_factor
    bending, shear = factor * STEEL.youngs_modulus * section.second_moments[0], factor * SHEAR_STIFFNESS
    omega2 = (2.0 * np.pi * frequency) ** 2
    upper = foundation - omega2 * STEEL.density * section.area
    rocking = shear - omega2 * STEEL.density * section.second_moments[0]
    # W / F = (EI k^2 + r) / ((kGA k^2 + u)(EI k^2 + r) - (kGA)^2 k^2)
    a, b, c = shear * bending, shear * rocking + upper * bending - shear**2, upper * rocking
    result = np.zeros(len(x), dtype=complex)
    for square in np.roots([a, b, c]):
        k = np.sqrt(square + 0j)
        k = -k if k.imag > 0 else k
        result += -1j * (bending * square + rocking) / (4 * a * k**3 + 2 * b * k) * np.exp(-1j * k * np.abs(x))
    return result


def test_static_deflection(soft):
    """A beam on springs, beside the force: the softer the pad, the better."""
    x = np.array([0.1, 0.2, 0.3, 0.5])
    found = static_compliance(soft, x=x)[:, 2, 2]
    beam = timoshenko_beam(x, 0.0, foundation_stiffness(soft), 0.0).real
    np.testing.assert_allclose(found, beam, rtol=4e-3)  # achieved: 9.6e-4, 8.3e-4, 1.8e-3, 3.4e-3
    stiffer = supported(0.006, 0.0)
    beam = timoshenko_beam(x, 0.0, foundation_stiffness(stiffer), 0.0).real
    worse = static_compliance(stiffer, x=x)[:, 2, 2]
    np.testing.assert_allclose(worse, beam, rtol=3e-2)  # achieved: up to 2.7e-2, since the foot bends


def test_point_stiffness_contains_the_indentation(soft):
    """At the force itself the head yields locally too: stiffness 96.3 MN/m, 0.6 % below the beam's 96.9 MN/m."""
    point = 1.0 / static_compliance(soft)[0, 2, 2]
    beam = 1.0 / timoshenko_beam(np.zeros(1), 0.0, foundation_stiffness(soft), 0.0).real[0]
    assert 0.985 < point / beam < 1.0


@pytest.mark.parametrize(("frequency", "limit"), [(20.0, 5e-3), (100.0, 6e-3), (300.0, 7e-3), (500.0, 1.2e-2)])
def test_receptance_at_low_frequencies(soft, frequency, limit):
    x = np.array([0.1, 0.2, 0.3, 0.5])
    found = receptance(soft, frequency=[frequency], x=x)[0, :, 2, 2]
    foundation = foundation_stiffness(soft) * (1.0 + 1j * rubber().loss_factor)
    beam = timoshenko_beam(x, frequency, foundation, STEEL.loss_factor)
    # Achieved: 3.6e-3, 4.3e-3, 5.6e-3, 9.7e-3; 2.4e-2 at 1 kHz, 7 % at 2 kHz.
    assert np.abs(found / beam - 1.0).max() < limit


def test_cut_ons_are_those_of_a_rigid_body_on_the_pad(soft):
    """Lateral, roll and vertical motion of a stiff section on the pad's stiffness, found by three static loads."""
    stiff = Material(youngs_modulus=1e4 * STEEL.youngs_modulus, poisson_ratio=0.3, density=7860.0, loss_factor=0.0)
    pad = Pad(material=rubber(), thickness=0.03)
    rigid = section_matrices(preset_section("60e1"), material=stiff, pad=pad, contact_position=0.0, size=0.008)
    k0 = rigid.combined(lossy=False)[0].tocsc()
    rows = rigid.foot_rows[1:]
    stiffness = np.linalg.inv(rows @ np.column_stack([spsolve(k0, row) for row in rows]))
    section = preset_section("60e1")
    m, h = STEEL.density * section.area, section.centroid[1]
    polar = STEEL.density * sum(section.second_moments[:2])
    # Of (y', z', roll) at the foot; the roll y' to z' moves the centroid, h above it, by + h in y'.
    mass = np.array([[m, 0.0, m * h], [0.0, m, 0.0], [m * h, 0.0, polar + m * h**2]])
    expected = np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi)

    def error(matrices: SectionMatrices) -> np.ndarray:
        # The longitudinal cut-on stands between them.
        return np.abs(cut_on_frequencies(matrices, number=4)[:, None] / expected - 1.0).min(axis=0)

    assert error(rigid).max() < 1e-3
    assert error(soft).max() < 1.2e-2  # achieved: 5.9e-3, 1.0e-2, 2.0e-3: the web of the real rail bends


def test_thesis_web_bending_on_a_rail_like_bv50():
    """Peaks off the centre line at the second web bending cut-on, 4030 Hz (Pieringer 2011, section 3.3.2)."""
    pad = Pad(material=rubber(), thickness=0.006)
    like = section_matrices(preset_section("bv50-like"), material=STEEL, pad=pad, contact_position=0.012, size=0.01)
    cut_on = cut_on_frequencies(like, number=7)
    assert cut_on[5] == pytest.approx(4030.0, rel=0.02)  # achieved: 3975, -1.4 %: the section is a stand-in
    # The printed first one has lost digits; the rail and the pad leave 1362 and 1462 Hz.
    assert 1300.0 < cut_on[4] < 1500.0  # 1409
    # Vertical receptance: the cut-on shows off the centre line and not on it.
    f = np.array([0.97, 1.0, 1.03]) * cut_on[5]
    centre = section_matrices(preset_section("bv50-like"), material=STEEL, pad=pad, contact_position=0.0, size=0.01)
    prominence = []
    for matrices in (like, centre):
        h = np.abs(receptance(matrices, frequency=f, x=0.3)[:, 0, 2, 2])
        prominence.append(h[1] / np.sqrt(h[0] * h[2]))
    assert prominence[0] > 2.0  # achieved: 2.5
    assert prominence[1] == pytest.approx(1.0, abs=0.02)  # achieved: 1.003


def test_cross_receptances(off_centre):
    """Zero at the centre of a symmetric rail, odd in the lateral position, and reciprocal."""
    right, left = off_centre, supported(0.01, -0.012)
    f = np.array([80.0, 4000.0])
    h = [receptance(matrices, frequency=f, x=[0.0, 0.4], number=20) for matrices in (right, left)]
    np.testing.assert_allclose(h[0][..., 1, 2], -h[1][..., 1, 2], rtol=1e-6)
    np.testing.assert_allclose(h[0][..., 2, 2], h[1][..., 2, 2], rtol=1e-6)
    np.testing.assert_allclose(h[0][:, 0], np.swapaxes(h[0][:, 0], 1, 2), rtol=1e-9, atol=1e-22)
    centre = receptance(supported(0.01, 0.0), frequency=f, number=20)[:, 0]
    assert np.abs(centre[:, 1, 2]).max() < 1e-7 * np.abs(centre[:, 2, 2]).min()


def test_passivity(off_centre):
    f = np.array([50.0, 300.0, 1400.0, 3900.0, 7000.0])
    for h in receptance(off_centre, frequency=f, number=20)[:, 0]:
        assert np.linalg.eigvalsh((h - h.conj().T) / 2j).max() < 0.0


def test_number_of_waves(off_centre):
    """A dozen do 0.2 m away from the force; under it further ones add to the local indentation."""
    head = off_centre.head_rows
    found = []
    for number in (12, 20, 40, 80):
        waves = waves_at(off_centre, frequency=2000.0, number=number)
        found.append(waves.transfer([0.2, 0.0], responses=head, forces=head))
    scale = np.abs(found[-1][0]).max()
    errors = [np.abs(each[0] - found[-1][0]).max() / scale for each in found[:-1]]
    assert np.all(errors < np.array([1e-4, 2e-6, 1e-8]))  # achieved: 2.8e-5, 4.9e-7, 4.3e-10
    point = [each[1, 2, 2].real for each in found]
    assert point[3] - point[2] > 5e-11  # achieved: 1e-10 m/N


@pytest.mark.slow
def test_the_ring_has_the_same_receptances():
    """One loss factor for all makes the waves of the rail and those of the ring the same; two different methods."""
    loss = 0.02
    steel = Material(youngs_modulus=207e9, poisson_ratio=0.3, density=7860.0, loss_factor=loss)
    matrices = section_matrices(
        preset_section("60e1"),
        material=steel,
        pad=Pad(material=rubber(loss), thickness=0.01),
        contact_position=0.012,
        size=0.008,
    )
    x = np.array([0.5, 1.0])
    ring = close_ring(
        reduce_section(matrices, matrices.head_rows, max_frequency=14000.0), length=900.0, max_frequency=14000.0
    )
    # What is left is the end of the ring's sum at 14 kHz. Achieved: 3.4e-4 and 7.2e-3.
    for f, limit in [(60.0, 5e-4), (150.0, 5e-4), (400.0, 5e-4), (1000.0, 1e-2), (2000.0, 1e-2), (6000.0, 1e-2)]:
        found = receptance(matrices, frequency=[f], x=x)[0]
        # The ring's sum with the loss factor in place of its viscous damping.
        poles = ring.weight / (ring.omega**2 * (1.0 + 1j * loss) - (2.0 * np.pi * f) ** 2)
        for i, j in ((2, 2), (1, 1), (1, 2)):
            products = ring.head[:, i] * ring.head[:, j] * poles
            closed = np.array([np.sum(products * np.cos(ring.wavenumber * each)) for each in x])
            scale = np.sqrt(np.abs(found[:, i, i] * found[:, j, j]))
            assert np.abs((closed - found[:, i, j]) / scale).max() < limit
