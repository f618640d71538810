"""The exact time stepping of the track against the matrix exponential of the whole track, and against Newmark."""

import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from wheelrail.reference.direct_integration import integrate_moving_force
from wheelrail.track.chain import ChainStepper

DT = 1e-4


@pytest.fixture(scope="module")
def track(thesis_track):
    return thesis_track(bays=20, elements_per_bay=4)


@pytest.fixture(scope="module")
def system(track):
    """Mass, damping, stiffness of the whole track in the stepper's order, assembled independently of it."""
    per_bay, width = track.elements_per_bay, 2 * track.elements_per_bay + 1
    size = track.bays * width

    def rail(node):
        return width * (node // per_bay) + 2 * (node % per_bay)

    mass, damping, stiffness = (np.zeros((size + 2, size + 2)) for _ in range(3))
    for matrix, target in zip(track.element_matrices(), (stiffness, mass), strict=True):
        for e in range(track.nodes - 1):
            dofs = [rail(e), rail(e) + 1, rail(e + 1), rail(e + 1) + 1]
            target[np.ix_(dofs, dofs)] += matrix
    for bay in range(1, track.bays):
        w, sleeper = width * bay, width * bay + width - 1
        for matrix, pad, ballast in (
            (stiffness, track.pad_stiffness, track.ballast_stiffness),
            (damping, track.pad_damping, track.ballast_damping),
        ):
            matrix[w, w] += pad
            matrix[w, sleeper] -= pad
            matrix[sleeper, w] -= pad
            matrix[sleeper, sleeper] += pad + ballast
        mass[sleeper, sleeper] += track.sleeper_mass
    # Clamped: the first and last node; the first cell's sleeper has no rail to carry.
    free = np.setdiff1d(np.arange(size), [0, 1, width - 1])
    at = np.ix_(free, free)
    return mass[at], damping[at], stiffness[at], free


def free_motion(stepper, system, source):
    """Displacements and velocities of the free degrees of freedom."""
    free, width = system[3], stepper.width
    u, v = stepper.state[:, source, :width].reshape(-1), stepper.state[:, source, width:].reshape(-1)
    return u[free], v[free] * stepper.sub_steps / DT


@pytest.fixture(scope="module")
def exact(track, system):
    """exp(A dt) of the whole track for (u, v dt), with a hat force on the node at x = 0 in one more column."""
    mass, damping, stiffness, free = system
    n, inverse = len(free), np.linalg.inv(mass)
    source = int(np.searchsorted(free, (2 * track.elements_per_bay + 1) * (track.bays // 2)))
    A = np.zeros((2 * n + 2, 2 * n + 2))
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n, :n] = -(DT**2) * inverse @ stiffness
    A[n : 2 * n, n : 2 * n] = -DT * inverse @ damping
    A[n : 2 * n, 2 * n] = DT**2 * inverse[:, source]
    A[2 * n, 2 * n + 1] = 1.0
    return expm(A), source


def test_hat_response_is_exact(track, system, exact):
    exponential, source = exact
    n = len(system[3])
    phi, constant, rising = exponential[: 2 * n, : 2 * n], exponential[: 2 * n, 2 * n], exponential[: 2 * n, 2 * n + 1]
    stepper = ChainStepper(track, DT)
    stepper.start_hat()
    state = rising
    worst = largest = 0.0
    for step in range(200):
        u, _ = free_motion(stepper, system, 0)
        deflections = np.arange(n)[np.isin(system[3] % stepper.width, range(0, stepper.width - 1, 2))]
        worst = max(worst, np.abs(u - state[:n])[deflections].max())
        largest = max(largest, np.abs(state[:n])[deflections].max())
        assert stepper.bay_response(0)[0, 0] == u[source]
        if step == 0:
            stepper.finish_hat()
            state = phi @ state + constant - rising
        else:
            stepper.step()
            state = phi @ state
    assert worst < 1e-9 * largest  # achieved: 4e-14


def test_impulse_response_is_exact(track, system, exact):
    exponential, source = exact
    n = len(system[3])
    phi = exponential[: 2 * n, : 2 * n]
    state = np.zeros(2 * n)
    state[n:] = np.linalg.inv(system[0])[:, source] * DT * DT
    stepper = ChainStepper(track, DT)
    stepper.start_impulse(DT)
    for _ in range(50):
        stepper.step()
        state = phi @ state
        u, _ = free_motion(stepper, system, 0)
        np.testing.assert_allclose(u, state[:n], atol=1e-9 * np.abs(state[:n]).max())


def test_newmark_converges_to_it(thesis_track):
    """Direct integration under a standing hat force: second order in its step."""
    track = thesis_track(bays=20)
    dt = 4e-5
    stepper = ChainStepper(track, dt)
    stepper.start_hat()
    expected = [stepper.bay_response(0)[0, 0]]
    stepper.finish_hat()
    for _ in range(59):
        expected.append(stepper.bay_response(0)[0, 0])
        stepper.step()
    errors = []
    for fine in (8, 16, 32):
        _, found = integrate_moving_force(
            track,
            speed=0.0,
            start=0.0,
            force=lambda t: max(0.0, 1.0 - abs(t / dt - 1.0)),
            dt=dt / fine,
            steps=60 * fine,
        )
        errors.append(np.abs(found[fine::fine][:60] - expected).max() / np.max(expected))
    # Achieved: 1.5e-2, 3.9e-3, 1.0e-3
    assert errors[-1] < 2e-3
    for coarse, fine in pairwise(errors):
        assert coarse / fine == pytest.approx(4.0, abs=0.6)


def test_energy_never_increases(track, system):
    mass, _, stiffness, _ = system
    for start in ("start_hat", "start_impulse"):
        stepper = ChainStepper(track, DT)
        if start == "start_hat":
            stepper.start_hat()
            stepper.finish_hat()
        else:
            stepper.start_impulse(DT)
        for source in (0, 3, 2 * track.elements_per_bay):
            copy = stepper.state.copy()
            energies = []
            for _ in range(400):
                u, v = free_motion(stepper, system, source)
                energies.append(0.5 * v @ mass @ v + 0.5 * u @ stiffness @ u)
                stepper.step()
            stepper.state = copy
            energies = np.array(energies)
            assert np.all(np.diff(energies) <= 1e-12 * energies[0])
            assert energies[-1] < 0.7 * energies[0]


def test_half_steps_lead_to_the_same(thesis_track):
    """Steps of dt, and of dt / 2, after the same impulse (of size 1 N s)."""
    track = thesis_track(bays=20)
    whole, half = ChainStepper(track, DT), ChainStepper(track, DT / 2)
    assert (whole.sub_steps, half.sub_steps) == (1, 1)
    whole.start_impulse(DT)
    half.start_impulse(DT / 2)
    for _ in range(100):
        whole.step()
        half.step()
        half.step()
        for bay in (-3, 0, 4):
            one, other = whole.bay_response(bay)[::2] / DT, half.bay_response(bay)[::2] / (DT / 2)
            np.testing.assert_allclose(one, other, atol=1e-14)  # of 2e-6 m per N s; achieved: 3e-17


def test_sub_steps_lead_to_the_same(thesis_track):
    """A step that reaches too far is divided, the hat force with it: a long step against many short ones."""
    track = thesis_track(bays=20, elements_per_bay=4)
    long, short = ChainStepper(track, 16e-4), ChainStepper(track, 1e-4)
    assert long.sub_steps > 1
    long.start_hat()
    long_values = [long.bay_response(0)]
    long.finish_hat()
    long_values.append(long.bay_response(0))
    # The same hat as a sum of short hats.
    total = [np.zeros_like(long_values[0]), np.zeros_like(long_values[0])]
    short.start_hat()
    for age in range(32):
        for number, instant in enumerate((16, 32)):
            weight = 1.0 - abs(instant - age - 16) / 16
            if 0 <= instant - age <= 32 and weight > 0.0:
                total[number] += weight * short.bay_response(0)
        if age == 0:
            short.finish_hat()
        else:
            short.step()
    for one, other in zip(long_values, total, strict=True):
        np.testing.assert_allclose(one[::2], other[::2], atol=1e-9 * np.abs(other[::2]).max())


def test_causality(thesis_track):
    """Nothing arrives before the fastest wave, sqrt(EI / rho I), the mesh making waves a little faster."""
    track = thesis_track(bays=40)
    dt = 4e-5
    stepper = ChainStepper(track, dt)
    stepper.start_hat()
    fastest = np.sqrt(track.bending_stiffness / track.rotary_inertia)  # 5.2 km/s; shear waves 2.0 km/s
    scale = np.abs(stepper.bay_response(0)[::2, 0]).max()
    for step in range(1, 40):
        front = 1.1 * fastest * step * dt / track.sleeper_spacing
        ahead = int(np.ceil(front)) + 2
        if ahead > 18:
            break
        for bay in (ahead, -ahead - 1):
            assert (
                np.abs(stepper.bay_response(bay)[::2, 0]).max() < 5e-4 * scale
            )  # of the first sample, itself a fiftieth of the largest
        if step == 1:
            stepper.finish_hat()
        else:
            stepper.step()
    assert step > 20
    # and it does arrive: three bays away half a millisecond after
    assert np.abs(stepper.bay_response(3)[::2, 0]).max() > 1e-2 * scale


def test_sum_of_hats_is_the_static_compliance(thesis_track):
    """For ever repeated hats are a constant force. Impulses bring the mesh's fast modes as aliases."""
    track = thesis_track(bays=20)
    dt = 1e-3 / 30.0
    expected = track.static_compliance(0.0, [0.0, 0.325])
    found = {}
    for kind in ("linear", "sampled"):
        stepper = ChainStepper(track, dt)
        if kind == "linear":
            stepper.start_hat()
        else:
            stepper.start_impulse(dt)
        total = np.zeros(2)
        for n in range(6000):
            total += stepper.bay_response(0)[[0, track.elements_per_bay], 0]
            if n == 0 and kind == "linear":
                stepper.finish_hat()
            else:
                stepper.step()
        found[kind] = total / expected - 1.0
    # Achieved: 7e-6, and -4.4e-3, -2.6e-4.
    assert np.all(np.abs(found["linear"]) < 2e-5)
    assert np.abs(found["sampled"]).max() > 1e-3


@pytest.mark.parametrize("elements", [2, 3, 16])
def test_any_mesh(thesis_track, elements):
    """Coarse meshes, whose mass matrix couples far, and fine ones: the same as direct integration."""
    track = thesis_track(bays=20, elements_per_bay=elements)
    dt = 5e-5
    stepper = ChainStepper(track, dt)
    stepper.start_hat()
    found = [0.0, stepper.bay_response(0)[0, 0]]
    stepper.finish_hat()
    for _ in range(18):
        found.append(stepper.bay_response(0)[0, 0])
        stepper.step()
    _, expected = integrate_moving_force(
        track, speed=0.0, start=0.0, force=lambda t: max(0.0, 1.0 - abs(t / dt - 1.0)), dt=dt / 64, steps=19 * 64
    )
    # Achieved: 3e-4, of Newmark with dt / 64
    np.testing.assert_allclose(found, expected[::64], atol=3e-3 * np.max(found))


def test_a_mesh_that_is_too_coarse_does_not_hang():
    """One element per bay couples bays further than a step may reach: it is refused, not tried for ever."""
    script = (
        "from conftest import THESIS_TRACK; from wheelrail.track.discrete import DiscreteTrack;"
        "DiscreteTrack(**{**THESIS_TRACK, 'elements_per_bay': 1}).motion(5e-5)"
    )
    root = Path(__file__).parents[3]
    path = os.pathsep.join([str(root), str(root / "tests")])
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0 or "ValueError: " in done.stderr
