"""A beam on supports as Bloch waves: against the finite elements of `DiscreteTrack`."""

import numpy as np
import pytest
from beam_as_section import timoshenko_section

from wheelrail.greens.bloch import bloch_greens
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.track.supported_ring import SupportedRing, Supports, close_supported_ring

RAIL = {"bending_stiffness": 6.4e6, "shear_stiffness": 250e6, "mass_per_length": 60.0, "rotary_inertia": 0.24}
SUPPORT = {
    "pad_stiffness": 120e6,
    "pad_damping": 16e3,
    "sleeper_mass": 125.0,
    "ballast_stiffness": 140e6,
    "ballast_damping": 165e3,
}
SPACING = 0.65
HIGHEST = 100e3  # Hz; of the waves, for a kink under the force as the finite elements have it


def close(*, bays: int, max_frequency: float) -> SupportedRing:
    """Put the beam on the thesis' supports."""
    supports = Supports(
        spacing=SPACING,
        pad_stiffness=(1e6, 1e6, SUPPORT["pad_stiffness"]),
        pad_damping=(1e3, 1e3, SUPPORT["pad_damping"]),
        pad_width=0.15,
        sleeper_mass=SUPPORT["sleeper_mass"],
        ballast_stiffness=(1e6, 1e6, SUPPORT["ballast_stiffness"]),
        ballast_damping=(1e3, 1e3, SUPPORT["ballast_damping"]),
    )
    return close_supported_ring(
        timoshenko_section(**RAIL), supports=supports, length=bays * SPACING, max_frequency=max_frequency
    )


@pytest.fixture(scope="module")
def ring() -> SupportedRing:
    return close(bays=120, max_frequency=HIGHEST)


@pytest.fixture(scope="module")
def track() -> DiscreteTrack:
    return DiscreteTrack(**RAIL, sleeper_spacing=SPACING, bays=120, elements_per_bay=40, **SUPPORT)


@pytest.mark.parametrize("x0", [0.0, 0.2, 0.325])
def test_receptance_is_that_of_finite_elements(ring, track, x0) -> None:
    frequency = np.array([50.0, 100.0, 230.0, 400.0, 700.0, 1200.0, 1800.0, 3000.0])
    x = x0 + 0.4
    for place in (x0, x):
        bloch = ring.receptance(frequency, x0, place)[:, 2, 2]
        beam = track.receptance(x0, [place], frequency)[:, 0]
        # Achieved: 3.7e-12 m/N at the distance of 0.4 m, 7.1e-12 m/N (0.1 % of the static compliance) under the
        # force: the part in the beam's kink of the waves left out. From 100 to 300 kHz it falls to a third.
        residual = 8e-12 if place == x0 else 4e-12
        np.testing.assert_allclose(bloch, beam, rtol=1e-4, atol=residual)


def test_static_compliance(ring, track) -> None:
    for x0 in (0.0, 0.325):
        # Achieved: 1e-3, the waves left out as above.
        assert ring.static_compliance(x0)[2, 2] == pytest.approx(
            track.static_compliance(x0, [x0])[0], rel=2e-3, abs=0.0
        )


def test_reciprocity(ring) -> None:
    frequency = np.array([0.0, 180.0, 950.0, 2200.0])
    there, back = ring.receptance(frequency, 0.1, 0.55), ring.receptance(frequency, 0.55, 0.1)
    # Achieved: 1e-15.
    np.testing.assert_allclose(there[:, 2, 2], back[:, 2, 2], rtol=1e-11)


def test_no_mode_grows(ring) -> None:
    # Waves with a node at every support are undamped, since the rail has no loss factor here. Achieved: 2e-15.
    assert np.all(ring.pole.real < 1e-12 * np.abs(ring.pole))


def impulse_response(ring: SupportedRing, x0: float, x: float, t: float) -> float:
    """Vertical displacement at x, t after an impulse at x0: the modes summed as they stand."""
    total = 0.0
    for modes in (ring, ring.mirrored()):
        out, inp = modes.amplitudes(x)[0][:, 2], modes.amplitudes(x0)[1][:, 2]
        total += float(np.sum((ring.weight * out * inp * np.exp(modes.pole * t)).real))
    return total


@pytest.mark.parametrize(("position", "age"), [(0, 0), (3, 1), (10, 7), (20, 60)])
def test_moving_functions_are_the_integral_over_a_moving_hat(position, age) -> None:
    ring = close(bays=20, max_frequency=3e3)
    speed, dx = 450.0, 0.025  # fast enough for the grid to carry all waves
    greens = bloch_greens(ring, speed=speed, dx=dx, samples=61)
    dt, x0 = dx / speed, position * dx
    points, weights = np.polynomial.legendre.leggauss(60)
    total = 0.0
    for side in (-1.0, 1.0) if age else (-1.0,):  # the present force has only risen
        time = side * 0.5 * (points + 1.0)
        values = [impulse_response(ring, x0 + speed * t * dt, x0 + age * dx, (age - t) * dt) for t in time]
        total += 0.5 * dt * np.sum(weights * values * (1.0 - np.abs(time)))
    # Achieved: 4e-13.
    assert greens[position, 2, 2, age] == pytest.approx(total, rel=1e-10, abs=0.0)
