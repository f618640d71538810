import numpy as np
import pytest

from wheelrail.contact.bedding import WinklerBedding
from wheelrail.errors import ContactGridError


def bedding(nodes: int = 41, dx: float = 0.5e-3) -> WinklerBedding:
    return WinklerBedding(stiffness=1.15e11, radius=0.23, dx=dx, nodes=nodes, width_constant=1.2e-4)


def brute_force(model: WinklerBedding, roughness: np.ndarray, approach: float, fine: int = 400) -> tuple[float, float]:
    """Force and contact length by midpoint quadrature of the deflection of a piecewise linear line."""
    x = (np.arange(model.nodes) - model.nodes // 2) * model.dx
    points = x[0] + (np.arange((model.nodes - 1) * fine) + 0.5) * (model.dx / fine)
    z = approach + np.interp(points, x, roughness) - points**2 / (2.0 * model.radius)
    step = model.dx / fine
    return model.stiffness * np.maximum(z, 0.0).sum() * step, np.count_nonzero(z > 0.0) * step


def given_approach(model: WinklerBedding, roughness: np.ndarray, approach: float):
    return model.solve(roughness, weight=1.0, compliance=0.0, rhs=approach, guess=approach)


def test_random_lines_against_quadrature():
    model, rng = bedding(), np.random.default_rng(3)
    checked = 0
    for _ in range(200):
        roughness = rng.normal(size=model.nodes) * 10.0 ** rng.uniform(-7, -4.6)
        roughness[:12] = roughness[-12:] = -1e-3
        approach = rng.uniform(-5e-5, 1.2e-4)
        solution = given_approach(model, roughness, approach)
        force, length = brute_force(model, roughness, approach)
        # Achieved: 3e-6, and 1.2 steps of the quadrature in length.
        assert solution.force == pytest.approx(force, rel=1e-5, abs=0.01)
        assert solution.length == pytest.approx(length, abs=4 * model.dx / 400)
        assert solution.stiffness == pytest.approx(model.stiffness * solution.length, abs=0, rel=1e-13)
        checked += solution.force > 0.0
    assert checked > 100


def test_two_patches_carry_the_load_together():
    model = bedding(nodes=61)
    roughness = np.zeros(61)
    roughness[22:25] = roughness[36:39] = [10e-6, 60e-6, 10e-6]
    solution = model.solve(roughness, weight=0.0, compliance=1.0, rhs=2e3, guess=1e-4)
    force, length = brute_force(model, roughness, solution.approach, 4000)
    x = (np.arange(61) - 30) * model.dx
    z = solution.approach + roughness - x**2 / (2.0 * model.radius)
    assert z[30] < 0.0 < min(z[23], z[37])  # two patches, the middle in the air
    assert solution.force == pytest.approx(2e3, abs=0, rel=1e-12)
    assert force == pytest.approx(2e3, abs=0, rel=1e-6)  # achieved: 4e-8
    assert length == pytest.approx(solution.length, abs=4 * model.dx / 4000)


def test_touch_inside_a_cell():
    """A sloping line touches first between its nodes."""
    model = bedding(nodes=41)
    x = (np.arange(41) - 20) * model.dx
    slope = 1.3e-3  # highest at x = slope R' = 0.299 mm, between two nodes
    touch = -0.5 * slope**2 * model.radius
    for above in (1e-13, 1e-10, 1e-8):
        solution = given_approach(model, slope * x, touch + above)
        length = 2.0 * np.sqrt(2.0 * model.radius * above)
        # Achieved: 1.2e-7, 1.2e-10, 2e-12: the rounding of the approach.
        assert solution.length == pytest.approx(length, abs=0, rel=1e-19 / above + 1e-11)
        assert solution.force > 0.0
    assert given_approach(model, slope * x, touch - 1e-13).force == 0.0


def test_force_and_stiffness_have_no_jumps():
    """A node that enters the contact changes nothing suddenly (the sum over springs of eq. 3.29 jumps)."""
    model, rng = bedding(), np.random.default_rng(5)
    roughness = 3e-6 * rng.normal(size=41)
    roughness[:6] = roughness[-6:] = -1e-3
    approach = np.linspace(-1e-5, 1e-4, 2001)
    solutions = [given_approach(model, roughness, d) for d in approach]
    force = np.array([s.force for s in solutions])
    stiffness = np.array([s.stiffness for s in solutions])
    assert np.all(np.diff(force) >= 0.0)
    # The force is the integral of the stiffness.
    integral = np.cumsum(0.5 * (stiffness[1:] + stiffness[:-1]) * np.diff(approach))
    np.testing.assert_allclose(force[1:] - force[0], integral, atol=2e-5 * force[-1])  # achieved: 3e-6


def test_loss_of_contact():
    model = bedding()
    solution = model.solve(np.zeros(41), weight=1.0, compliance=1e-9, rhs=-3e-6, guess=1e-4)
    assert solution.force == solution.length == solution.area == solution.pressure_max == solution.stiffness == 0.0
    assert solution.approach == -3e-6


def test_patch_follows_from_the_force():
    model = bedding()
    solution = given_approach(model, np.zeros(41), 8e-5)
    assert solution.width == pytest.approx(2.0 * 1.2e-4 * solution.force ** (1 / 3), abs=0, rel=1e-13)
    assert solution.area == pytest.approx(np.pi / 4 * solution.length * solution.width, abs=0, rel=1e-13)
    assert solution.pressure_max == pytest.approx(1.5 * solution.force / solution.area, abs=0, rel=1e-13)


def advised_cells(error: ContactGridError, dx: float) -> int:
    length = float(str(error).split("contact.length = ")[1].split(" m")[0])
    assert length / dx == pytest.approx(round(length / dx), abs=1e-6)
    assert round(length / dx) % 2 == 1
    return round(length / dx)


@pytest.mark.parametrize("load", [20e3, 65e3, 300e3])
def test_grid_edge_is_refused_and_the_advice_helps(load):
    small = bedding(nodes=11)
    with pytest.raises(ContactGridError, match=r"11 nodes at 0\.0005 m") as refused:
        small.solve(np.zeros(11), weight=0.0, compliance=1.0, rhs=load, guess=1e-4)
    nodes = advised_cells(refused.value, small.dx)
    large = bedding(nodes=nodes)
    solution = large.solve(np.zeros(nodes), weight=0.0, compliance=1.0, rhs=load, guess=1e-4)
    assert solution.force == pytest.approx(load, abs=0, rel=1e-12)
    assert solution.length < (nodes - 1) * large.dx


@pytest.mark.parametrize("side", [0, -1])
def test_a_bump_at_the_edge_is_refused(side):
    model = bedding()
    roughness = np.zeros(41)
    roughness[side] = 400e-6
    with pytest.raises(ContactGridError) as refused:
        model.solve(roughness, weight=0.0, compliance=1.0, rhs=65e3, guess=1e-4)
    nodes = advised_cells(refused.value, model.dx)
    more = (nodes - 41) // 2
    larger = bedding(nodes=nodes).solve(np.pad(roughness, more), weight=0.0, compliance=1.0, rhs=65e3, guess=1e-4)
    assert larger.force == pytest.approx(65e3, abs=0, rel=1e-12)
