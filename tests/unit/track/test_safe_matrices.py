"""Matrices of a cross-section."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from wheelrail.track.safe_matrices import Pad, section_matrices
from wheelrail.track.section_sources import preset_section


@pytest.fixture(scope="module")
def free_bar(bar, steel):
    return section_matrices(bar, material=steel, pad=None, contact_position=0.008, size=0.01)


@pytest.fixture(scope="module")
def rail(steel, rubber):
    pad = Pad(material=rubber, thickness=0.01)
    return section_matrices(preset_section("60e1"), material=steel, pad=pad, contact_position=0.012, size=0.01)


def rigid_motions(matrices) -> np.ndarray:
    """Translations in x', y', z' and the roll about x' (y' to z') of a free section; shape (unknowns, 4)."""
    y, up = matrices.mesh.doflocs[:, matrices.node]
    one, zero = np.ones_like(y), np.zeros_like(y)
    parts = [(one, zero, zero), (zero, one, zero), (zero, zero, one), (zero, up, y)]
    return np.column_stack([np.concatenate(part) for part in parts])


def test_matrices_are_symmetric(rail):
    assert len(rail.stiffness_parts) == len(rail.loss_factors) == 2
    assert rail.loss_factors == (0.01, 0.25)
    for matrix in (rail.mass, *rail.stiffness_parts[0], *rail.stiffness_parts[1]):
        assert matrix.shape == (rail.size, rail.size)
        assert abs(matrix - matrix.T).max() <= 1e-12 * abs(matrix).max()


def test_rigid_motions_cost_no_energy_and_carry_the_mass(free_bar, steel, bar):
    motions = rigid_motions(free_bar)
    k0, _, _ = free_bar.combined(lossy=False)
    assert np.abs(k0 @ motions).max() < 1e-9 * abs(k0).max() * np.abs(motions).max()
    mass = motions.T @ (free_bar.mass @ motions)
    m = steel.density * bar.area
    np.testing.assert_allclose(np.diag(mass)[:3], m, rtol=1e-12)
    polar = steel.density * (sum(bar.second_moments[:2]) + bar.area * 0.03**2)
    assert mass[3, 3] == pytest.approx(polar, rel=1e-12)


def test_uniform_stretch(free_bar, steel, bar):
    """Where u_x = x, k u~ = strain: the energy of plain tension, with the section free to contract, is E A / 2."""
    k0, k1, k2 = free_bar.combined(lossy=False)
    k = 1e-2
    stiffness = k0 + k * (k1 + k * k2)
    axial = np.zeros(free_bar.size)
    axial[free_bar.axial] = 1.0
    rest = np.arange(free_bar.lateral.start, free_bar.size)
    # The section's own displacements follow; the small mass keeps it from drifting.
    inner = stiffness[rest][:, rest] + 1e-3 * free_bar.mass[rest][:, rest]
    axial[rest] = -spsolve(inner.tocsc(), stiffness[rest] @ axial)
    energy = axial @ (stiffness @ axial)
    assert energy == pytest.approx(steel.youngs_modulus * bar.area * k**2, rel=1e-6)


def test_rows_of_the_head_and_the_foot_see_rigid_motions(free_bar):
    motions = rigid_motions(free_bar)
    np.testing.assert_allclose(free_bar.head_rows @ motions[:, :3], np.eye(3), atol=1e-12)
    # The contact 60 mm above the underside, 8 mm to the field side: the roll y' to z' moves it by (0.06, 0.008).
    np.testing.assert_allclose(free_bar.head_rows @ motions[:, 3], [0.0, 0.06, 0.008], atol=1e-12)
    np.testing.assert_allclose(free_bar.foot_rows @ motions, np.eye(4), atol=1e-12)


def test_the_head_row_follows_the_crown(steel):
    section = preset_section("60e1")
    for position in (-0.02, 0.0, 0.005, 0.0123):
        matrices = section_matrices(section, material=steel, pad=None, contact_position=position, size=0.01)
        place = matrices.mesh.doflocs[:, matrices.node] @ matrices.head_rows[0, matrices.axial]
        # The crown has a radius of 300 mm up to 10.2 mm beside the middle, then 80 mm about (7.5, 91.9) mm.
        if abs(position) < 0.0102:
            height = 0.172 - 0.3 + np.sqrt(0.3**2 - position**2)
        else:
            height = 91.8721032e-3 + np.sqrt(0.080**2 - (abs(position) - 7.5005483e-3) ** 2)
        assert place == pytest.approx((position, height), abs=2e-6)  # the outline has chords of arcs


def test_the_pad(rail, rubber):
    assert rail.supported
    mesh = rail.mesh
    assert mesh.p[1].min() == pytest.approx(-0.01)
    pad = mesh.p[:, mesh.t[:, rail.rail_elements :]]
    assert (pad[0].min(), pad[0].max()) == pytest.approx((-0.073, 0.073))
    # Held sideways everywhere but at its edges the rubber is almost as stiff as a layer without edges.
    k0, _, _ = rail.combined(lossy=False)
    displacement = spsolve(k0.tocsc(), rail.head_rows[2])
    stiffness = 1.0 / (rail.foot_rows[2] @ displacement)
    e, nu = rubber.youngs_modulus, rubber.poisson_ratio
    layer = e * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * 0.146 / 0.01
    assert 0.88 < stiffness / layer < 1.0  # achieved: 0.91


def test_a_narrower_pad(steel, rubber, rail):
    pad = Pad(material=rubber, thickness=0.01, width=0.1)
    narrow = section_matrices(preset_section("60e1"), material=steel, pad=pad, contact_position=0.012, size=0.01)
    corners = narrow.mesh.p[:, narrow.mesh.t[:, narrow.rail_elements :]]
    assert (corners[0].min(), corners[0].max()) == pytest.approx((-0.05, 0.05))
    softer = [spsolve(m.combined(lossy=False)[0].tocsc(), m.foot_rows[2]) @ m.foot_rows[2] for m in (narrow, rail)]
    assert softer[0] / softer[1] == pytest.approx(1.46, rel=0.1)
    with pytest.raises(ValueError, match=r"doesn't fit the foot's flat underside of 0\.146 m"):
        section_matrices(
            preset_section("60e1"),
            material=steel,
            pad=Pad(material=rubber, thickness=0.01, width=0.2),
            contact_position=0.0,
        )


def test_displacements_of_all_nodes(rail):
    shape = np.arange(rail.size, dtype=float)
    spread = rail.displacement(shape)
    assert spread.shape == (rail.mesh.doflocs.shape[1], 3)
    fixed = rail.mesh.doflocs[1] < -0.00999
    assert np.all(spread[fixed] == 0.0)
    np.testing.assert_array_equal(spread[rail.node, 1], shape[rail.lateral])


def test_the_contact_must_be_on_the_head(steel):
    with pytest.raises(ValueError, match="allowed: "):
        section_matrices(preset_section("60e1"), material=steel, pad=None, contact_position=0.05)


def test_a_given_mesh_rests_on_a_pad_too(coarse_bar, steel, rubber):
    def heights(width: float):
        pad = Pad(material=rubber, thickness=0.01, width=width)
        matrices = section_matrices(coarse_bar, material=steel, pad=pad, contact_position=0.0)
        corners = matrices.mesh.p[:, matrices.mesh.t[:, matrices.rail_elements :]]
        return corners[0].min(), corners[0].max(), corners[1].min()

    assert heights(0.03) == pytest.approx((-0.015, 0.015, -0.01))
    # The edges of a given mesh stay where they are: those count whose middle is on the pad.
    assert heights(0.02) == pytest.approx((-0.015, 0.015, -0.01))
    with pytest.raises(ValueError, match="no edge of the mesh's underside rests on the pad"):
        heights(0.01)
