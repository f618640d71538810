"""A beam on a continuous foundation as a ring of waves: against closed forms."""

import numpy as np
import pytest
from beam_as_section import timoshenko_section

from wheelrail.track.ring import Ring, close_ring

BENDING, MASS, FOUNDATION = 6.4e6, 60.0, 200e6
STIFF_IN_SHEAR, NO_INERTIA = 1e13, 1e-6


def euler_ring(*, length: float = 400.0, loss_factor: float = 0.02) -> Ring:
    """An Euler-Bernoulli beam on a Winkler foundation."""
    section = timoshenko_section(
        bending_stiffness=BENDING,
        shear_stiffness=STIFF_IN_SHEAR,
        mass_per_length=MASS,
        rotary_inertia=NO_INERTIA,
        foundation=FOUNDATION,
        loss_factor=loss_factor,
        foundation_loss_factor=loss_factor,
    )
    return close_ring(section, length=length, max_frequency=200e3)


def exact_receptance(frequency, x) -> np.ndarray:
    """Return the closed form for a complex wavenumber kappa^4 = (m' omega^2 - s) / EI, time factor exp(+i omega t)."""
    root = ((MASS * (2.0 * np.pi * np.asarray(frequency)) ** 2 - FOUNDATION) / BENDING + 0j) ** 0.25
    # Of the four roots, one pair decays towards +x.
    roots = root * np.array([1.0, 1j, -1.0, -1j])[:, None]
    order = np.argsort(roots.imag, axis=0)[:2]
    first, second = np.take_along_axis(roots, order, axis=0)
    # Slope 0 and shear force 1/2 at x = 0+ for w = a exp(-i first x) + b exp(-i second x).
    a = 0.5 / (BENDING * 1j * first * (first**2 - second**2))
    b = -a * first / second
    return a * np.exp(-1j * first * x) + b * np.exp(-1j * second * x)


@pytest.mark.parametrize("x", [0.0, 0.3, 1.1])
def test_receptance_off_the_real_axis_is_the_closed_form(x) -> None:
    # A decaying force keeps waves from coming round the ring, and no damping is needed.
    ring = euler_ring(loss_factor=0.0)
    frequency = np.array([30.0, 100.0, 280.0, 400.0, 1500.0, 4000.0]) - 40.0j
    exact = exact_receptance(frequency, x)
    found = ring.receptance(frequency, x)[:, 0, 2, 2]
    # Achieved: 1e-4 at the distances; 7e-14 m/N under the force, the share of the waves above 200 kHz.
    np.testing.assert_allclose(found, exact, rtol=2e-4, atol=1e-13)


def test_static_compliance_is_that_of_a_beam_on_winkler_foundation() -> None:
    beta = (FOUNDATION / (4.0 * BENDING)) ** 0.25
    # Achieved: 1.1e-5, the share of the waves above 200 kHz.
    assert euler_ring().static_compliance()[2, 2] == pytest.approx(beta / (2.0 * FOUNDATION), rel=3e-5, abs=0.0)
