import numpy as np
import pytest
from scipy.integrate import quad

from wheelrail.wheel.rigid import RigidWheel

ONE = {"mass": 341.5, "suspension_stiffness": 1.12e6, "suspension_damping": 13.2e3}
TWO = {**ONE, "contact_mass": 3.0, "contact_stiffness": 6.0e9, "contact_damping": 155e3}


def one_dof_receptance(f):
    omega = 2 * np.pi * f
    return 1.0 / (1.12e6 + 1j * omega * 13.2e3 - omega**2 * 341.5)


def test_one_dof_receptance():
    f = np.array([0.0, 9.0, 100.0, 5000.0])
    np.testing.assert_allclose(RigidWheel.one_dof(**ONE).receptance(f), one_dof_receptance(f), rtol=1e-14)


def test_two_dof_receptance():
    """Eq. 3.1 for two masses, by eliminating the wheel mass by hand."""
    f = np.array([0.0, 9.0, 669.0, 5000.0, 20000.0])
    omega = 2 * np.pi * f
    wheel = 1.0 / one_dof_receptance(f)
    link = 6.0e9 + 1j * omega * 155e3
    expected = 1.0 / (link * wheel / (link + wheel) - 3.0 * omega**2)
    np.testing.assert_allclose(RigidWheel.two_dof(**TWO).receptance(f), expected, rtol=1e-10)


def test_one_dof_resonance_and_damping():
    """9.11 Hz and 0.337, from the roots of the state matrix."""
    A, _, _ = RigidWheel.one_dof(**ONE).state_space()
    root = np.linalg.eigvals(A)[0]
    assert abs(root) / (2 * np.pi) == pytest.approx(9.11, abs=0.005)
    assert -root.real / abs(root) == pytest.approx(0.337, abs=0.0005)


def test_two_dof_antiresonance():
    f = np.arange(600.0, 740.0, 0.1)
    values = np.abs(RigidWheel.two_dof(**TWO).receptance(f))
    assert f[np.argmin(values)] == pytest.approx(669.5, abs=0.15)


def test_models_differ_above_200_hz():
    f = np.array([100.0, 213.0, 2000.0])
    one, two = (np.abs(w.receptance(f)) for w in (RigidWheel.one_dof(**ONE), RigidWheel.two_dof(**TWO)))
    level = np.abs(20 * np.log10(two / one))
    assert level[0] < 0.5
    assert level[1] == pytest.approx(1.0, abs=0.05)
    assert level[2] > 15


@pytest.mark.parametrize("wheel", [RigidWheel.one_dof(**ONE), RigidWheel.two_dof(**TWO)], ids=["1dof", "2dof"])
def test_impulse_response_is_the_transform_of_the_receptance(wheel):
    """The integral of g(t) exp(-i omega t) up to 3 s, when all has decayed."""
    dt = 1e-5
    g = wheel.impulse_response(dt, 100_000)
    t = dt * np.arange(len(g))
    for f in (0.0, 3.0, 50.0):
        kernel = g * np.exp(-2j * np.pi * f * t)
        # 2 dof: the contact mass moves with m_W / k_W, 22 us; at t = 0 g starts from zero within that.
        integral = dt * (kernel.sum() - 0.5 * kernel[0])
        assert integral == pytest.approx(wheel.receptance([f])[0], abs=0, rel=2e-4)


def test_impulse_response_of_one_dof():
    """exp(-zeta w t) sin(w_d t) / (M w_d)."""
    omega, zeta = np.sqrt(1.12e6 / 341.5), 13.2e3 / (2 * np.sqrt(1.12e6 * 341.5))
    damped = omega * np.sqrt(1 - zeta**2)
    t = 1e-3 * np.arange(400)
    expected = np.exp(-zeta * omega * t) * np.sin(damped * t) / (341.5 * damped)
    np.testing.assert_allclose(RigidWheel.one_dof(**ONE).impulse_response(1e-3, 400), expected, atol=1e-14)


def test_passivity():
    f = np.geomspace(0.1, 20e3, 200)
    for wheel in (RigidWheel.one_dof(**ONE), RigidWheel.two_dof(**TWO)):
        assert np.all(wheel.receptance(f).imag < 0.0)


def test_held_wheel():
    """The contact mass alone on its spring: 1 / (k_W + i w c_W - w^2 m_W)."""
    held = RigidWheel.two_dof(**TWO).held()
    assert held is not None
    omega = 2 * np.pi * 1234.0
    assert held.receptance([1234.0])[0] == pytest.approx(1 / (6e9 + 155e3j * omega - 3 * omega**2), abs=0, rel=1e-14)
    assert RigidWheel.one_dof(**ONE).held() is None


def test_state_space_is_the_integral_of_its_impulse_response():
    """c A^-1 b is minus the static compliance; by quadrature of the impulse response too."""
    A, b, c = RigidWheel.one_dof(**ONE).state_space()
    assert -c @ np.linalg.solve(A, b) == pytest.approx(1 / 1.12e6, abs=0, rel=1e-12)
    g = RigidWheel.one_dof(**ONE).impulse_response(1e-4, 20001)
    total, _ = quad(lambda t: np.interp(t, 1e-4 * np.arange(20001), g), 0, 2, limit=2000)
    assert total == pytest.approx(1 / 1.12e6, abs=0, rel=1e-4)
