"""Moving Green's functions of a uniform rail: against those of the same rail as Bloch waves, and its receptances."""

import numpy as np
import pytest

from wheelrail.greens.bloch import bloch_greens
from wheelrail.greens.travelling_waves import hat_weights, wave_greens
from wheelrail.greens.waveguide import compute_waveguide_greens, moving_receptance
from wheelrail.track.safe_matrices import Material, Pad
from wheelrail.track.section import RailSection
from wheelrail.track.supported_ring import Supports, close_supported_ring
from wheelrail.track.waveguide import WaveguideTrack

STEEL = Material(youngs_modulus=207e9, poisson_ratio=0.3, density=7860.0, loss_factor=0.01)
PAD = Pad(material=Material(youngs_modulus=4.8e6, poisson_ratio=0.45, density=10.0, loss_factor=0.25), thickness=0.01)
BAR = RailSection(np.array([(-0.06, 0.0), (0.06, 0.0), (0.03, 0.15), (-0.03, 0.15)]), "trapezium")
SPEED, DX = 25.0, 0.025


@pytest.fixture(scope="module")
def track() -> WaveguideTrack:
    return WaveguideTrack(
        section=BAR, material=STEEL, support=PAD, contact_position=0.01, max_frequency=3000.0, ring_length=100.0
    )


def test_supports_without_stiffness_change_nothing(track) -> None:
    nothing, something = (0.0, 0.0, 0.0), (1e6, 1e6, 1e6)
    supports = Supports(
        spacing=0.5,
        pad_stiffness=nothing,
        pad_damping=nothing,
        pad_width=0.1,
        sleeper_mass=10.0,
        ballast_stiffness=something,
        ballast_damping=nothing,
    )
    ring = close_supported_ring(track.reduced, supports=supports, length=100.0, max_frequency=3000.0)
    bloch = bloch_greens(ring, speed=SPEED, dx=DX, samples=100)
    uniform = wave_greens(track.waves, speed=SPEED, dx=DX, samples=100)
    # Achieved: 5e-16 of the largest sample.
    assert np.abs(bloch - uniform).max() < 1e-13 * np.abs(uniform).max()


def test_sum_of_a_slow_contact_is_the_static_compliance(track) -> None:
    slow = wave_greens(track.waves, speed=0.5, dx=5e-5, samples=20000).sum(axis=-1).T
    static = track.static_compliance()
    # Achieved: 1.2e-6 of the lateral compliance.
    assert np.abs(slow - static).max() < 1e-5 * static.max()


def test_moving_receptance_at_walking_pace_is_the_receptance(track) -> None:
    dx, speed = 2.5e-5, 0.5
    values = wave_greens(track.waves, speed=speed, dx=dx, samples=6000)
    frequency = np.array([100.0, 400.0, 1000.0, 1500.0])
    found = moving_receptance(values, frequency, dx / speed)
    exact = track.receptance(frequency)
    # A hat is the force's spectrum times sinc squared.
    exact = exact * np.sinc(frequency * dx / speed)[:, None, None] ** 2
    # Achieved: 2.7e-3, the Doppler shift; 1e-4 and below away from resonances.
    for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (2, 1)):
        np.testing.assert_allclose(found[:, i, j], exact[:, i, j], rtol=5e-3)


def test_functions_end_where_their_energy_has_gone(track) -> None:
    greens = compute_waveguide_greens(track, speed=SPEED, dx=DX)
    assert greens.values.shape[:3] == (1, 3, 3)
    assert 0.0 < greens.neglected_energy[0] <= 1e-4
    longer = compute_waveguide_greens(track, speed=SPEED, dx=DX, memory=0.2)
    assert longer.values.shape[-1] == 200
    samples = greens.values.shape[-1]
    np.testing.assert_array_equal(greens.values[..., : samples - 1], longer.values[..., : samples - 1])


@pytest.mark.parametrize("z", [0.0, 1e-3 + 2e-3j, 0.05 - 0.2j, -0.3 + 1.1j, -2.0 - 3.0j])
def test_hat_weights_are_integrals(z) -> None:
    points, weights = np.polynomial.legendre.leggauss(40)
    t = 0.5 * (points + 1.0)
    present = np.sum(0.5 * weights * (1.0 - t) * np.exp(z * t))
    later = present + np.sum(0.5 * weights * (1.0 - t) * np.exp(-z * t))
    found = hat_weights(np.array([z / 0.01]), 0.01)
    np.testing.assert_allclose(found[0][0] / 0.01, present, rtol=1e-12)
    np.testing.assert_allclose(found[1][0] / 0.01, later, rtol=1e-12)
