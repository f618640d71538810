"""Faults between the keys of flats, joints, dents and out-of-round wheels."""

import pytest
from case_faults import changed, faults_of

from wheelrail.case import case_from_dict

FLAT = {"type": "wheel-flat", "angle": 0.0}
JOINT = {"type": "rail-joint", "position": 1.0}
DENT = {"type": "dent", "depth": 1e-4, "length": 0.03}
ROUND = {"type": "out-of-round", "orders": [1, 2], "amplitudes": [1e-4, 1e-5]}

ALLOWED = [
    {**FLAT, "shape": "new", "depth": 1e-3},
    {**FLAT, "shape": "rounded", "depth": 1e-3, "length": 0.1},
    {**JOINT, "gap": 0.01, "step": 1e-3, "dip": 1e-3, "dip_length": 0.5},
    {**JOINT, "step": 1e-3, "step_length": 0.5, "spacing": 20.0},
    {**DENT, "on": "rail", "position": 2.0, "width": 0.02},
    {**DENT, "on": "wheel", "angle": 1.0},
    ROUND,
    {"type": "corrugation", "amplitude": 1e-5, "wavelength": 0.05, "start": 0.0, "length": 3.0},
]
LINES = {"type": "spectrum", "name": "iso3095-2013-limit", "on": "rail", "seed": 1, "lines": [-2e-3, 0.0, 2e-3]}
MEASURED = {"type": "measured", "file": "r.csv", "on": "rail"}
ALLOWED += [{**LINES, "coherence": 1.5}, {**LINES, "coherence": 0}, {**LINES, "coherence": "none"}]
FAULTS = [
    (LINES, 'excitation #1.coherence: missing; several lines need it (a number, or "none")'),
    (
        {**LINES, "lines": [0.0, 1e-3, 0.0], "coherence": 1.0},
        "excitation #1.lines: a position is given twice",
    ),
    (
        {**MEASURED, "column": 1, "lateral": [0.0, 1e-3]},
        "excitation #1: column and lateral both given; column takes one line, lateral all of them",
    ),
    ({**FLAT, "shape": "new"}, "excitation #1.depth: missing; a new flat needs its depth or its length (m)"),
    (
        {**FLAT, "shape": "rounded", "depth": 1e-3},
        'excitation #1.length: missing; needed with shape = "rounded"',
    ),
    ({**FLAT, "shape": "measured"}, 'excitation #1.file: missing; needed with shape = "measured"'),
    ({**JOINT, "dip": 1e-3}, "excitation #1.dip_length: missing; a dip needs its length on each side (m)"),
    (
        {**JOINT, "step": 1e-3, "spacing": 20.0},
        "excitation #1.step_length: missing; a step that comes again has to run back to level (m)",
    ),
    (
        {**JOINT, "dip": 1e-3, "dip_length": 0.5, "spacing": 0.8},
        "excitation #1.dip_length = 0.5: must be <= spacing / 2 = 0.4 (m)",
    ),
    ({**DENT, "on": "rail"}, 'excitation #1.position: missing; needed with on = "rail"'),
    (
        {**DENT, "on": "wheel", "angle": 0.0, "position": 1.0},
        'excitation #1.position: not used with on = "wheel"; leave it out',
    ),
    (
        {**ROUND, "amplitudes": [1e-4]},
        "excitation #1.amplitudes: 1 values for 2 orders; give one for each",
    ),
    (
        {"type": "corrugation", "amplitude": 1e-5, "wavelength": 0.002, "start": 0.0, "length": 3.0},
        "excitation #1.wavelength = 0.002: must be > 2 simulation.dx = 0.002 (m); the grid can't carry a shorter one",
    ),
]


@pytest.mark.parametrize("entry", ALLOWED, ids=lambda entry: entry["type"])
def test_allowed(entry):
    case = case_from_dict(changed({"excitation": [entry]}))
    assert case.excitation[0].type == entry["type"]


@pytest.mark.parametrize(("entry", "line"), FAULTS, ids=lambda value: str(value)[:60])
def test_faults(entry, line, tmp_path):
    (tmp_path / "r.csv").touch()
    assert faults_of(changed({"excitation": [entry]}), folder=tmp_path) == [line]
