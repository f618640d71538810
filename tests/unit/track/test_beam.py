import numpy as np
import pytest

from wheelrail.track.beam import element_matrices, local_compliance, shape_functions, shear_parameter

RAIL = {"bending_stiffness": 6.4e6, "shear_stiffness": 250e6}
INERTIA = {"mass_per_length": 60.0, "rotary_inertia": 0.24}
LENGTH = 0.4


@pytest.fixture
def phi():
    return shear_parameter(length=LENGTH, **RAIL)


def test_shear_parameter(phi):
    assert phi == pytest.approx(12 * 6.4e6 / (250e6 * 0.16), abs=0, rel=1e-15)


def test_shape_functions_interpolate_the_nodes(phi):
    deflection, rotation = shape_functions([0.0, 1.0], length=LENGTH, phi=phi)
    np.testing.assert_allclose(deflection, [[1, 0, 0, 0], [0, 0, 1, 0]], atol=1e-15)
    np.testing.assert_allclose(rotation, [[0, 1, 0, 0], [0, 0, 0, 1]], atol=1e-14)


def test_rigid_motions(phi):
    s = np.linspace(0, 1, 11)
    deflection, rotation = shape_functions(s, length=LENGTH, phi=phi)
    np.testing.assert_allclose(deflection @ [1, 0, 1, 0], 1.0, atol=1e-15)
    turn = [0, 1, LENGTH, 1]
    np.testing.assert_allclose(deflection @ turn, s * LENGTH, atol=1e-15)
    np.testing.assert_allclose(rotation @ turn, 1.0, atol=1e-14)


def test_shape_functions_solve_the_static_equations(phi):
    """EI theta'' + kGA (w' - theta) = 0 and w' - theta constant, by differences of the polynomials."""
    s = np.linspace(0, 1, 401)
    deflection, rotation = shape_functions(s, length=LENGTH, phi=phi)
    x = s * LENGTH
    slope = np.gradient(deflection, x, axis=0, edge_order=2)[1:-1]
    shear = slope - rotation[1:-1]
    curvature = np.gradient(np.gradient(rotation, x, axis=0, edge_order=2), x, axis=0, edge_order=2)[2:-2]
    np.testing.assert_allclose(shear, np.broadcast_to(shear[200], shear.shape), atol=1e-4 * np.abs(shear).max())
    np.testing.assert_allclose(6.4e6 * curvature + 250e6 * shear[1:-1], 0.0, atol=1e-4 * 250e6 * np.abs(shear).max())


def test_stiffness_is_the_energy_of_the_shape_functions(phi):
    stiffness, _ = element_matrices(length=LENGTH, **RAIL, **INERTIA)
    points, weights = np.polynomial.legendre.leggauss(6)
    s, h = 0.5 * (points + 1), 1e-6
    _, rotation = shape_functions(s, length=LENGTH, phi=phi)
    ahead, behind = (shape_functions(s + d, length=LENGTH, phi=phi) for d in (h, -h))
    shear = (ahead[0] - behind[0]) / (2 * h * LENGTH) - rotation
    bend = (ahead[1] - behind[1]) / (2 * h * LENGTH)
    energy = 0.5 * LENGTH * np.einsum("g,gi,gj->ij", weights, 6.4e6 * bend, bend)
    energy += 0.5 * LENGTH * np.einsum("g,gi,gj->ij", weights, 250e6 * shear, shear)
    np.testing.assert_allclose(stiffness, energy, rtol=1e-7, atol=1e-7 * stiffness.max())


def test_cantilever():
    """Tip deflection F L^3 / (3 EI) + F L / kGA, exact with one element."""
    stiffness, _ = element_matrices(length=LENGTH, **RAIL, **INERTIA)
    tip = np.linalg.solve(stiffness[2:, 2:], [1.0, 0.0])[0]
    assert tip == pytest.approx(LENGTH**3 / (3 * 6.4e6) + LENGTH / 250e6, abs=0, rel=1e-13)


def test_mass_of_rigid_motions():
    _, mass = element_matrices(length=LENGTH, **RAIL, **INERTIA)
    shift, turn = np.array([1, 0, 1, 0]), np.array([0, 1, LENGTH, 1])
    assert shift @ mass @ shift == pytest.approx(60 * LENGTH, abs=0, rel=1e-13)
    assert shift @ mass @ turn == pytest.approx(60 * LENGTH**2 / 2, abs=0, rel=1e-13)
    assert turn @ mass @ turn == pytest.approx(60 * LENGTH**3 / 3 + 0.24 * LENGTH, abs=0, rel=1e-13)
    np.testing.assert_allclose(mass, mass.T, rtol=1e-14)
    assert np.linalg.eigvalsh(mass).min() > 0


def test_without_shear_it_is_the_euler_bernoulli_element():
    stiffness, mass = element_matrices(
        length=1.0, bending_stiffness=1.0, shear_stiffness=1e30, mass_per_length=420.0, rotary_inertia=0.0
    )
    np.testing.assert_allclose(stiffness[0], [12, 6, -12, 6], rtol=1e-12)
    np.testing.assert_allclose(mass[0], [156, 22, 54, -13], rtol=1e-12)
    np.testing.assert_allclose(mass[1], [22, 4, 13, -3], rtol=1e-12)


def test_local_compliance_is_what_a_finer_mesh_adds():
    """Clamped element under a force inside it, meshed with two elements that meet under the force."""
    for s0 in (0.01, 0.3, 0.5, 0.9):
        parts = [element_matrices(length=part * LENGTH, **RAIL, **INERTIA)[0] for part in (s0, 1 - s0)]
        joint = np.linalg.solve(parts[0][2:, 2:] + parts[1][:2, :2], [1.0, 0.0])
        s = np.array([0.0, 0.2 * s0, 0.7 * s0, s0, s0 + 0.3 * (1 - s0), 1.0])
        expected = []
        for value in s:
            element = 0 if value <= s0 else 1
            share = value / s0 if element == 0 else (value - s0) / (1 - s0)
            length = (s0, 1 - s0)[element] * LENGTH
            shape, _ = shape_functions(share, length=length, phi=shear_parameter(length=length, **RAIL))
            expected.append(shape[2:] @ joint if element == 0 else shape[:2] @ joint)
        found = local_compliance(s0, s, length=LENGTH, **RAIL)
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-22)


def test_local_compliance_of_a_long_element():
    """Clamped beam, force and deflection in the middle: L^3 / (192 EI) + L / (4 kGA)."""
    found = local_compliance(0.5, 0.5, length=2.0, **RAIL)
    assert found == pytest.approx(8.0 / (192 * 6.4e6) + 2.0 / (4 * 250e6), abs=0, rel=1e-13)
    np.testing.assert_array_equal(local_compliance([0.0, 1.0, 0.4], [0.0, 1.0, 1.0], length=2.0, **RAIL), 0.0)
    one, other = local_compliance([0.2, 0.7], [0.7, 0.2], length=2.0, **RAIL)
    assert one == other
