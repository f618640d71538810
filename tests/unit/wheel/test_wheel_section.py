"""Wheel sections from presets and files, and what is refused."""

from __future__ import annotations

import json

import meshio
import numpy as np
import pytest

from wheelrail.errors import DataFileError
from wheelrail.wheel.flexible import wheel_shapes
from wheelrail.wheel.section import PRESETS, load_section

STEEL = {"youngs_modulus": 207e9, "poisson_ratio": 0.3, "density": 7860.0}
# A small wheel: hub, web, rim and flange, r and z in m.
WHEEL = [
    (0.08, -0.06),
    (0.11, -0.06),
    (0.11, -0.02),
    (0.26, -0.02),
    (0.26, -0.06),
    (0.30, -0.06),
    (0.30, 0.03),
    (0.33, 0.04),
    (0.33, 0.06),
    (0.26, 0.06),
    (0.26, 0.02),
    (0.11, 0.02),
    (0.11, 0.06),
    (0.08, 0.06),
]
SIZE = 0.015


def written(path, points):
    if path.suffix == ".json":
        path.write_text(json.dumps([list(point) for point in points]))
    else:
        path.write_text("# A wheel.\nr_m,z_m\n" + "\n".join(f"{r},{z}" for r, z in points) + "\n")
    return path.name


def frequencies(section):
    return [mode.frequency for mode in wheel_shapes(section, **STEEL, max_frequency=2500.0).modes]


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    section = load_section(written(folder / "wheel.csv", WHEEL), folder, element_size=SIZE)
    assert section.tread_radius == pytest.approx(0.30, rel=1e-12)
    return section, frequencies(section)


@pytest.mark.parametrize("name", ["wheel.json", "wheel.txt"])
def test_outline_formats(tmp_path, expected, name):
    section = load_section(written(tmp_path / name, WHEEL[::-1]), tmp_path, element_size=SIZE)
    # Turned round the polygon starts elsewhere, and its mesh differs a little.
    np.testing.assert_allclose(frequencies(section), expected[1], rtol=3e-3)


@pytest.mark.parametrize("name", ["wheel.vtk", "wheel.msh", "wheel.inp"])
def test_mesh_formats(tmp_path, expected, name):
    section, frequency = expected
    mesh = section.mesh
    points = np.column_stack([mesh.p.T, np.zeros(mesh.p.shape[1])])
    meshio.write(tmp_path / name, meshio.Mesh(points, [("quad", mesh.t.T)]))
    np.testing.assert_allclose(frequencies(load_section(name, tmp_path)), frequency, rtol=1e-6)


def test_triangles(tmp_path, expected):
    section, frequency = expected
    mesh = section.mesh
    points = np.column_stack([mesh.p.T, np.zeros(mesh.p.shape[1])])
    triangles = np.concatenate([mesh.t.T[:, [0, 1, 2]], mesh.t.T[:, [0, 3, 2]]])  # of both orientations
    meshio.write(tmp_path / "wheel.vtk", meshio.Mesh(points, [("triangle", triangles)]))
    np.testing.assert_allclose(
        frequencies(load_section("wheel.vtk", tmp_path)), frequency, rtol=1e-2
    )  # six times as many elements; achieved: 6.7e-3


def test_preset_by_any_case():
    assert load_section("Synthetic-C20", element_size=0.02).tread_radius == pytest.approx(0.39, abs=2e-5)
    assert set(PRESETS) == {"synthetic-c20"}


def mirrored(points):
    return [(r, -z) for r, z in points]


def scaled(points, factor):
    return [(factor * r, factor * z) for r, z in points]


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (scaled(WHEEL, 1e3), "largest radius is 330 m; allowed: 0.1 to 1 m; in millimetres"),
        (scaled(WHEEL, 1e-3), "largest radius is 0.00033 m"),
        ([(0.07, 0.0), *WHEEL], "no inner edge of the hub: the smallest radius, 0.07 m"),
        (mirrored(WHEEL), "flange lies at z = -0.0[46] m"),
        ([(r, z + 0.2) for r, z in WHEEL], "no tread at z = 0"),
        ([(r - 0.09, z) for r, z in WHEEL], "radii can't be negative"),
        ([(r - 0.08, z) for r, z in WHEEL], "no inner edge"),
        ([WHEEL[0], WHEEL[6], WHEEL[3], WHEEL[9]], "crosses or touches itself"),
        (WHEEL[:2], "holds 2 points"),
        ([*WHEEL[:3], (0.2, float("nan"))], "point 4"),
    ],
)
def test_refused_outlines(tmp_path, points, message):
    name = written(tmp_path / "wheel.csv", points)
    with pytest.raises(DataFileError, match=message) as caught:
        load_section(name, tmp_path)
    assert "wheel.csv" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("wheel.csv", "0.1,0.2\n0.1,x\n0.2,0.3\n", "point 2 is .*r, z in m"),
        ("wheel.csv", "0.1,0.2\n0.1\n0.2,0.3\n", "point 2 is"),
        ("wheel.json", '{"r": 1}', "no list of points"),
        ("wheel.json", "[[1, 2], ", "line 1: isn't JSON"),
        ("wheel.msh", "not a mesh", "can't be read"),
    ],
)
def test_refused_files(tmp_path, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(DataFileError, match=message) as caught:
        load_section(name, tmp_path)
    assert name in str(caught.value)


def test_missing_file(tmp_path):
    with pytest.raises(DataFileError, match=r"neither a preset section \(synthetic-c20\) nor a file"):
        load_section("c20", tmp_path)
