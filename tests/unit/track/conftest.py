"""Sections and matrices that several tests share."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import MeshQuad, MeshQuad2

from wheelrail.track.safe_matrices import Material, Pad, section_matrices
from wheelrail.track.section import RailSection, section_from_mesh

WIDTH, HEIGHT = 0.03, 0.06  # m, of the bar


@pytest.fixture(scope="session")
def steel():
    return Material(youngs_modulus=207e9, poisson_ratio=0.3, density=7860.0, loss_factor=0.01)


@pytest.fixture(scope="session")
def rubber():
    return Material(youngs_modulus=4.8e6, poisson_ratio=0.45, density=10.0, loss_factor=0.25)


@pytest.fixture(scope="session")
def bar():
    half = 0.5 * WIDTH
    return RailSection(np.array([(-half, 0.0), (half, 0.0), (half, HEIGHT), (-half, HEIGHT)]), "bar")


@pytest.fixture(scope="session")
def coarse_bar():
    """The bar as a mesh of 2 x 3 elements."""
    mesh = MeshQuad.init_tensor(np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 3), np.linspace(0.0, HEIGHT, 4))
    return section_from_mesh(MeshQuad2.from_mesh(mesh), "coarse bar")


@pytest.fixture(scope="session")
def bar_on_rubber(coarse_bar, rubber):
    """Few unknowns and much loss, so that everything can be computed in other ways too."""
    lossy = Material(youngs_modulus=207e9, poisson_ratio=0.3, density=7860.0, loss_factor=0.3)
    pad = Pad(material=rubber, thickness=0.01)
    return section_matrices(coarse_bar, material=lossy, pad=pad, contact_position=0.008)
