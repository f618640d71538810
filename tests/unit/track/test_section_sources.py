"""Presets and files of cross-sections."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

from wheelrail.errors import DataFileError
from wheelrail.track.section_sources import load_section, preset_section


def write(path, text: str) -> str:
    path.write_text(text, encoding="utf-8")
    return path.name


OUTLINE = "# a bar\nlateral,vertical\n-0.015,0\n0.015,0\n0.015,0.06\n-0.015,0.06\n"


def test_an_outline_from_a_file(tmp_path):
    section = load_section(write(tmp_path / "bar.csv", OUTLINE), tmp_path)
    assert section.area == pytest.approx(0.0018)
    assert section.name == "bar"
    # Without headings, and with the first point again at the end.
    again = load_section(write(tmp_path / "b.txt", "-0.015,0\n0.015,0\n0.015,0.06\n-0.015,0.06\n-0.015,0\n"), tmp_path)
    assert again.second_moments == section.second_moments


def test_a_mesh_from_a_file(tmp_path):
    mesh = preset_section("60e1").mesh(0.01)
    points = np.column_stack([mesh.p[:, : mesh.nvertices].T, np.zeros(mesh.nvertices)])
    meshio.write(tmp_path / "rail.vtk", meshio.Mesh(points, [("quad", mesh.t.T)]))
    section = load_section("rail.vtk", tmp_path)
    assert section.area == pytest.approx(preset_section("60e1").area, rel=5e-3)  # straight edges now
    assert section.given_mesh is not None


def test_names_of_presets_take_either_case():
    assert load_section("60E1").name == "60e1"


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        (
            "a.csv",
            "-0.015,0\n0.015,zero\n0,1\n",
            r"a.csv: point 2 is \[0.015, 'zero'\]; each needs two numbers, lateral",
        ),
        ("a.csv", "-0.015,0\n0.015\n", r"a.csv: point 2 is \[0.015\]; each needs two numbers"),
        ("a.csv", "lateral,vertical\n0,0\n1,1\n", r"a.csv: holds 2 points"),
        ("a.csv", "0,0\n0.1,0.1\n0.1,0\n0,0.1\n", r"a.csv: the outline crosses or touches itself"),
        (
            "a.csv",
            "-15,0\n15,0\n15,60\n-15,60\n",
            r"a.csv: the section is 60 m high; its coordinates must be in metres",
        ),
        ("a.vtk", "nonsense", r"a.vtk: can't be read as a mesh"),
    ],
)
def test_files_that_hold_no_section(tmp_path, name, text, message):
    with pytest.raises(DataFileError, match=message):
        load_section(write(tmp_path / name, text), tmp_path)


def test_an_unknown_name(tmp_path):
    with pytest.raises(DataFileError, match=r"60e2: neither a preset section \(60e1, bv50-like\) nor a file"):
        load_section("60e2", tmp_path)
