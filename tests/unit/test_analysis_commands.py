"""What ``wheelrail analyse``, ``decay-rate`` and ``contact-filter`` say and write."""

import csv
import math

import numpy as np
import pytest

from wheelrail.analyse_command import analyse_result
from wheelrail.analysis.contact_filter import contact_filter_of
from wheelrail.analysis.contact_filter_models import patch_filter
from wheelrail.analysis.third_octave import third_octave
from wheelrail.case import parse_case
from wheelrail.contact_filter_command import contact_filter_report
from wheelrail.decay_rate_command import decay_rate_report
from wheelrail.errors import ParameterError, WheelrailError
from wheelrail.interaction.build import hertz_of
from wheelrail.results import ResultFileError, open_result
from wheelrail.run import run_case

CASE = """
title = "a flat"
[simulation]
speed = 20.0
dx = 2e-3
duration = {duration}
start_position = 0.0
[wheel]
preset = "thesis-1dof"
[track]
{track}
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
{contact}
[load]
preload = 65e3
coupling = "load"
{more}
[output]
record = [{record}]
"""
RIGID = 'model = "rigid"'
SHORT = 'preset = "thesis-discrete"\nbays = 20\nmemory = 0.02'
FLAT = '[[excitation]]\ntype = "wheel-flat"\nshape = "rounded"\ndepth = 0.05e-3\nlength = 40e-3\nangle = 1.0'


def make(*, track=RIGID, contact="", more=FLAT, record='"force_z", "wheel_disp_z", "rail_disp_z"', duration=0.6):
    return parse_case(CASE.format(track=track, contact=contact, more=more, record=record, duration=duration))


@pytest.fixture(autouse=True)
def _cache(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path / "cache"))


def table(path):
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_result_of_a_flat(tmp_path):
    case = make()
    run_case(case, tmp_path / "flat.nc")
    report = analyse_result(tmp_path / "flat.nc", tmp_path, transient=0.05, factor=1.2)
    names = [path.name for path in report.files]
    assert names == ["flat_bands.csv", "flat_impacts.csv", "flat_turns.csv", "flat_impacts.png", "flat_velocity.png"]
    for path in report.files[3:]:
        assert path.read_bytes().startswith(b"\x89PNG")
    # One blow a turn, always at the same angle but for a step of dx / R.
    period = 2.0 * math.pi * case.wheel.radius / 20.0
    rows = table(tmp_path / "flat_turns.csv")
    assert [int(row["turn"]) for row in rows] == [2, 3, 4]
    angles = [float(row["angle_rad"]) for row in rows]
    assert np.ptp(angles) < 0.02
    assert f"wheel turns      {len(rows)}" in report.text
    with open_result(tmp_path / "flat.nc") as dataset:
        force = dataset["force_z"].values[500:]
    assert max(float(row["largest_N"]) for row in rows) <= force.max() * (1.0 + 1e-6)
    first = table(tmp_path / "flat_impacts.csv")[0]
    assert 0.05 < float(first["time_s"]) < 0.05 + period
    assert float(first["peak_N"]) > 1.2 * 65e3
    assert f"dynamic factor   {force.max() / 65e3:.3f}" in report.text
    # The table's levels are those of the force.
    levels = third_octave(force, spacing=1e-4)
    bands = table(tmp_path / "flat_bands.csv")
    assert len(bands) == len(levels.centres)
    found = [float(row["force_dB_re_1_N"]) for row in bands]
    np.testing.assert_allclose(found, levels.level(reference=1.0), atol=6e-3)
    # A rigid rail does not move.
    assert set(bands[0]) == {
        "frequency_Hz",
        "wavelength_mm",
        "force_dB_re_1_N",
        "wheel_disp_z_velocity_dB_re_1_nm_per_s",
    }
    assert report.notes == ()


def test_stick_and_slip_of_a_result(tmp_path):
    more = '[friction]\nlaw = "constant"\ncoefficient = 0.3\n[creepage]\nx = 0.0\ny = 1e-3\nspin = 0.0'
    record = '"force_z", "force_y", "slip_fraction"'
    case = make(contact='tangential = "fastsim"', more=more, record=record, duration=0.1)
    run_case(case, tmp_path / "creep.nc")
    report = analyse_result(tmp_path / "creep.nc", tmp_path)
    # Steady creepage: a part of the area sticks for ever.
    assert "partial slip 100 %" in report.text
    assert "no whole cycle" in report.text
    assert any("velocities" in note for note in report.notes)
    run_case(make(contact='tangential = "fastsim"', more=more, duration=0.1), tmp_path / "lacks.nc")
    assert any('"slip_fraction"' in note for note in analyse_result(tmp_path / "lacks.nc", tmp_path).notes)


def test_results_that_cannot_be_analysed(tmp_path):
    run_case(make(record='"wheel_disp_z"'), tmp_path / "run.nc")
    with pytest.raises(ResultFileError, match="force_z"):
        analyse_result(tmp_path / "run.nc", tmp_path)
    run_case(make(), tmp_path / "run.nc")
    for transient in (0.6, -1.0):
        with pytest.raises(ParameterError, match="transient"):
            analyse_result(tmp_path / "run.nc", tmp_path, transient=transient)
    with pytest.raises(WheelrailError, match="no such folder"):
        analyse_result(tmp_path / "run.nc", tmp_path / "missing")
    with pytest.raises(WheelrailError, match="no such file"):
        analyse_result(tmp_path / "missing.nc", tmp_path)


def test_decay_rates_of_a_case(tmp_path):
    report = decay_rate_report(make(track='preset = "thesis-discrete"'), tmp_path, stem="track")
    rows = {row["frequency_Hz"]: row for row in table(tmp_path / "track_decay_rate.csv")}
    assert len(rows) == 18
    assert rows["100"]["vertical_limit_dB_per_m"] == ""
    assert float(rows["630"]["vertical_dB_per_m"]) < float(rows["630"]["vertical_limit_dB_per_m"]) == 6.0
    verdict = next(line for line in report.text.splitlines() if line.startswith("vertical:"))
    assert "400, 500, 630, 800" in verdict
    assert any("lateral" in note for note in report.notes)
    assert (tmp_path / "track_decay_rate.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ParameterError, match="rigid"):
        decay_rate_report(make(), tmp_path, stem="track")


def test_contact_filter_of_a_case(tmp_path):
    rough = '[[excitation]]\ntype = "spectrum"\nname = "iso3095-2013-limit"\non = "rail"\nseed = 1'
    case = make(track=SHORT, contact="length = 22e-3", more=rough)
    report = contact_filter_report(case, tmp_path, stem="rough", contacts=["hertz-average"])
    rows = table(tmp_path / "rough_contact_filter.csv")
    assert list(rows[0])[2:] == ["hertz-average [dB]", "patch [dB]", "CNOSSOS 50 kN [dB]", "CNOSSOS 100 kN [dB]"]
    expected = contact_filter_of(case, contacts=["hertz-average"], transient=0.12)["hertz-average"]
    found = [float(row["hertz-average [dB]"] or "nan") for row in rows]
    np.testing.assert_allclose(found, expected.levels, atol=6e-3)
    assert [float(row["wavelength_mm"]) for row in rows] == pytest.approx(1e3 * expected.wavelengths, rel=1e-3)
    patch = patch_filter(expected.wavelengths, radius=hertz_of(case).semi_axis_x)
    np.testing.assert_allclose([float(row["patch [dB]"]) for row in rows], patch, atol=6e-3)
    assert "hertz-average" in report.text
    assert np.any(np.isnan(found))
    assert "no roughness at" in report.notes[0]
    assert len(report.files) == 2
