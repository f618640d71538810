import numpy as np
import pytest

from wheelrail.greens.ordinary import discretise, sample
from wheelrail.wheel.rigid import RigidWheel

DT = 1e-3 / 30.0
SUSPENSION = {"mass": 341.5, "suspension_stiffness": 1.12e6, "suspension_damping": 13.2e3}
CONTACT = {"contact_mass": 3.0, "contact_stiffness": 6.0e9, "contact_damping": 155e3}
WHEELS = {
    "1dof": RigidWheel.one_dof(**SUSPENSION),
    "2dof": RigidWheel.two_dof(**SUSPENSION, **CONTACT),
    "held": RigidWheel.two_dof(**SUSPENSION, **CONTACT).held(),
}


def run(recursion, force):
    """Displacement by the recursion, as the class describes its use."""
    state, found = np.zeros(len(recursion.beta)), []
    for u in force:
        found.append(recursion.c @ state + recursion.first * u)
        state = recursion.phi @ state + recursion.beta * u
    return np.array(found)


@pytest.mark.parametrize("kind", ["linear", "sampled"])
@pytest.mark.parametrize("name", WHEELS)
def test_recursion_is_the_convolution_with_its_values(name, kind):
    recursion = discretise(*WHEELS[name].state_space(), dt=DT, discretisation=kind)
    force = np.random.default_rng(1).normal(size=3000)
    expected = np.convolve(force, recursion.values(3000))[:3000]
    np.testing.assert_allclose(run(recursion, force), expected, atol=1e-11 * np.abs(expected).max())  # achieved: 5e-14


@pytest.mark.parametrize("name", WHEELS)
def test_sampled_is_the_trapezoidal_rule_of_equation_3_6(name):
    recursion = discretise(*WHEELS[name].state_space(), dt=DT, discretisation="sampled")
    expected = DT * WHEELS[name].impulse_response(DT, 500)
    expected[0] *= 0.5
    np.testing.assert_allclose(recursion.values(500), expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("name", WHEELS)
def test_linear_is_exact_for_forces_linear_between_the_steps(name):
    """The same force history on a grid eight times finer must give the same displacements."""
    rng = np.random.default_rng(2)
    force = np.concatenate([[0.0], rng.normal(size=200)])
    coarse = run(discretise(*WHEELS[name].state_space(), dt=DT), force)
    fine_force = np.interp(np.arange(200 * 8 + 1) / 8, np.arange(201), force)
    fine = run(discretise(*WHEELS[name].state_space(), dt=DT / 8), fine_force)
    np.testing.assert_allclose(coarse, fine[::8], atol=1e-10 * np.abs(coarse).max())  # achieved: 1e-13


@pytest.mark.parametrize("name", WHEELS)
def test_transform_is_the_receptance(name):
    """Steady response to exp(i omega t): the receptance times the transform of the hat, sinc(omega dt / 2)^2."""
    recursion = discretise(*WHEELS[name].state_space(), dt=DT)
    m = len(recursion.beta)
    for f in (0.5, 9.0, 100.0, 1000.0):
        z = np.exp(2j * np.pi * f * DT)
        found = recursion.first + recursion.c @ np.linalg.solve(z * np.eye(m) - recursion.phi, recursion.beta)
        expected = WHEELS[name].receptance([f])[0] * np.sinc(f * DT) ** 2
        # Aliasing from 30 kHz - f on: achieved 1e-7 at 9 Hz ... 2e-3 at 1 kHz and the anti-resonance's neighbourhood.
        assert abs(found / expected - 1.0) < (1e-5 if f < 200 else 4e-3)


def test_static_compliance():
    one, two, held = (discretise(*WHEELS[name].state_space(), dt=DT) for name in ("1dof", "2dof", "held"))
    # The linear form's steady response to a constant force is exact: achieved 1e-15, 4e-12, 1e-15
    assert one.static_compliance() == pytest.approx(1 / 1.12e6, abs=0, rel=1e-12)
    assert two.static_compliance() == pytest.approx(1 / 1.12e6 + 1 / 6e9, abs=0, rel=1e-10)
    assert held.static_compliance() == pytest.approx(1 / 6e9, abs=0, rel=1e-12)
    assert one.values(60_000).sum() == pytest.approx(1 / 1.12e6, abs=0, rel=1e-9)
    sampled = discretise(*WHEELS["held"].state_space(), dt=DT, discretisation="sampled").static_compliance()
    assert abs(sampled * 6e9 - 1.0) > 0.02  # the held wheel is faster than the sampling: eq. 3.6 is coarse for it


def test_free_mass():
    """g(n) = dt^2 (n - 1) / M but for the first sample, dt^2 / (6 M); no static compliance."""
    wheel = RigidWheel.one_dof(mass=488.5, suspension_stiffness=0.0, suspension_damping=0.0)
    recursion = discretise(*wheel.state_space(), dt=DT)
    expected = DT**2 * np.arange(5000) / 488.5
    expected[0] = DT**2 / 6 / 488.5
    np.testing.assert_allclose(recursion.values(5000), expected, rtol=1e-10)
    assert recursion.static_compliance() == np.inf
    damped = RigidWheel.one_dof(mass=488.5, suspension_stiffness=0.0, suspension_damping=50.0)
    assert discretise(*damped.state_space(), dt=DT).static_compliance() == np.inf


@pytest.mark.parametrize("stiffness", [1.0, 1e3, 1.12e6, 1e12])
@pytest.mark.parametrize("dt", [1e-6, 1e-4])
def test_soft_and_stiff_suspensions_keep_their_static_compliance(stiffness, dt):
    wheel = RigidWheel.one_dof(mass=341.5, suspension_stiffness=stiffness, suspension_damping=10.0)
    assert discretise(*wheel.state_space(), dt=dt).static_compliance() * stiffness == pytest.approx(
        1.0, abs=0, rel=1e-9
    )


def test_sample_ends_where_the_rest_is_negligible():
    recursion = discretise(*WHEELS["1dof"].state_space(), dt=1e-3)
    greens = sample(recursion, dt=1e-3, energy_tolerance=1e-6)
    n = len(greens.values)
    whole = recursion.values(5000)
    np.testing.assert_array_equal(greens.values, whole[:n])
    rest = [np.sum(whole[k:] ** 2) / np.sum(whole**2) for k in (n, n - 1)]
    assert rest[0] <= 1e-6 < rest[1]
    assert greens.neglected_energy == pytest.approx(rest[0], abs=0, rel=1e-6)


def test_sample_of_a_free_mass_ends_at_the_longest():
    free = RigidWheel.one_dof(mass=488.5, suspension_stiffness=0.0, suspension_damping=0.0)
    greens = sample(discretise(*free.state_space(), dt=1e-3), dt=1e-3, longest=2.0)
    assert 2000 <= len(greens.values) <= 4096
