"""Studies of small cases."""

from __future__ import annotations

import pytest

from wheelrail.study import load_study

BASE = """
title = "small"
[simulation]
speed = 30.0
dx = 5e-3
duration = 0.05
start_position = 0.0
[wheel]
preset = "thesis-1dof"
[track]
model = "rigid"
[contact]
normal = "winkler"
length = 25e-3
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
[friction]
law = "constant"
coefficient = 0.3
[load]
preload = 65e3
coupling = "load"
[[excitation]]
type = "sinusoid"
amplitude = 10e-6
wavelength = 0.13
[[excitation]]
type = "spectrum"
name = "iso3095-2013-limit"
on = "rail"
seed = 1
[output]
record = ["force_z", "wheel_disp_z"]
"""


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "base.toml").write_text(BASE)


@pytest.fixture
def study_of(tmp_path):
    """Make a study from the text of its file, without the line that names the case."""

    def make(text):
        path = tmp_path / "study.toml"
        path.write_text(f'case = "base.toml"\n{text}')
        return load_study(path)

    return make
