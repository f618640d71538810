"""Dispersion curves, their names and slopes."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.track.dispersion import cut_on_frequencies, disperse
from wheelrail.track.safe_matrices import Pad, section_matrices
from wheelrail.track.section_sources import preset_section


@pytest.fixture(scope="module")
def free_rail(steel):
    return section_matrices(preset_section("60e1"), material=steel, pad=None, contact_position=0.0, size=0.01)


def test_names_of_the_waves_of_a_free_rail(free_rail):
    found = disperse(free_rail, [1.0], number=8).names
    assert found[:6] == (
        "lateral bending",
        "vertical bending",
        "torsion",
        "longitudinal",
        "web bending 1",
        "web bending 2",
    )


def test_names_of_the_waves_of_a_supported_rail(steel, rubber):
    pad = Pad(material=rubber, thickness=0.01)
    rail = section_matrices(preset_section("60e1"), material=steel, pad=pad, contact_position=0.0, size=0.01)
    found = disperse(rail, [1.0], number=6).names
    # The six of Pieringer 2011, Fig. 3.20.
    assert sorted(found) == sorted(
        ["lateral bending", "vertical bending", "torsion", "longitudinal", "web bending 1", "web bending 2"]
    )


def test_group_velocity_is_the_slope_of_the_curves(free_rail):
    step = 1e-3
    curves = disperse(free_rail, [3.0 - step, 3.0, 3.0 + step], number=6)
    slope = 2.0 * np.pi * (curves.frequency[2] - curves.frequency[0]) / (2.0 * step)
    np.testing.assert_allclose(curves.group_velocity[1], slope, rtol=1e-5)


def test_curves_are_followed_through_their_crossings(free_rail):
    """Vertical bending crosses lateral bending and torsion; in a symmetric section they do not see each other."""
    curves = disperse(free_rail, np.arange(0.5, 12.01, 0.5), number=6)
    vertical = curves.names.index("vertical bending")
    middle = np.abs(free_rail.mesh.doflocs[0, free_rail.node]) < 1e-9
    for shapes in curves.shapes:
        sideways = np.abs(shapes[free_rail.lateral][middle]).max(axis=0)
        upright = np.abs(shapes[free_rail.vertical][middle]).max(axis=0)
        assert sideways[vertical] < 1e-6 * upright[vertical]
    assert np.all(np.diff(curves.frequency[:, vertical]) > 0.0)
    torsion, lateral = (curves.frequency[:, curves.names.index(name)] for name in ("torsion", "lateral bending"))
    assert np.all(lateral[1:] < curves.frequency[1:, vertical])
    assert torsion[0] > curves.frequency[0, vertical]
    assert torsion[-1] < curves.frequency[-1, vertical]


def test_a_free_rail_has_four_waves_from_zero_on(free_rail):
    cut_on = cut_on_frequencies(free_rail, number=6)
    assert np.all(cut_on[:4] < 0.1)
    assert cut_on[4] > 1000.0
