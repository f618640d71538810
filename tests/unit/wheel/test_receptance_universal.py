"""Frequency response functions in universal files that pyuff writes."""

import numpy as np
import pytest
import pyuff

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.wheel.modes import FlexibleWheel, Mode
from wheelrail.wheel.receptance_file import read_receptance

AXES = ("x", "-z", "y")
# Directions of the file, of which y points down and z to the gauge side, in the frame of the package.
FILE_DIRECTION = {"x": 1, "y": -3, "z": 2}
WHEEL = FlexibleWheel(
    tuple(
        Mode.with_frequency(name=str(f), mass=50.0, frequency=f, damping_ratio=5e-3, shape=shape)
        for f, shape in [(400.0, (0.0, 1.0, 0.3)), (1600.0, (0.0, -0.2, 0.9))]
    )
)
FREQUENCY = np.arange(10.0, 2001.0, 5.0)
EXACT = WHEEL.receptance(FREQUENCY)
SI = {
    "type": 164,
    "units_code": 1,
    "units_description": "SI",
    "temp_mode": 1,
    "length": 1.0,
    "force": 1.0,
    "temp": 1.0,
    "temp_offset": 0.0,
}
MM = {**SI, "units_code": 9, "length": 1e3}
TYPES = {8: 0, 11: 1, 12: 2}


def function(pair, *, kind=8, factor=1.0, flip=(1, 1), frequency=FREQUENCY, receptance=EXACT, **other):
    i, j = ("xyz".index(axis) for axis in pair)
    data = receptance[:, i, j] * (2j * np.pi * frequency) ** TYPES.get(kind, 0) * factor * flip[0] * flip[1]
    return {
        "type": 58,
        "func_type": 4,
        "rsp_node": 7,
        "rsp_dir": FILE_DIRECTION[pair[0]] * flip[0],
        "ref_node": 7,
        "ref_dir": FILE_DIRECTION[pair[1]] * flip[1],
        "abscissa_spec_data_type": 18,
        "ordinate_spec_data_type": kind,
        "orddenom_spec_data_type": 13,
        "x": frequency,
        "data": data,
        "abscissa_spacing": 1,
        "abscissa_inc": frequency[1] - frequency[0],
        **other,
    }


def written(tmp_path, *sets):
    path = tmp_path / "wheel.uff"
    pyuff.UFF(str(path)).write_sets([dict(data) for data in sets], mode="overwrite")
    return path


def refused(path, **arguments):
    with pytest.raises(DataFileError) as caught:
        read_receptance(path, axes=AXES, **arguments)
    return str(caught.value).replace(str(path), "FILE")


@pytest.mark.parametrize("kind", [8, 11, 12])
@pytest.mark.parametrize(("units", "factor"), [(SI, 1.0), (MM, 1e3)])
@pytest.mark.parametrize(
    "form", [{"abscissa_spacing": 1}, {"abscissa_spacing": 0}, {"abscissa_spacing": 1, "binary": 1}]
)
def test_functions_with_their_quantities_units_and_directions(tmp_path, kind, units, factor, form):
    path = written(
        tmp_path,
        units,
        function("yy", kind=kind, factor=factor, **form),
        function("zz", kind=kind, factor=factor, flip=(-1, 1), **form),
        function("zy", kind=kind, factor=factor, flip=(-1, -1), **form),
    )
    found, notes = read_receptance(path, axes=AXES)
    np.testing.assert_allclose(found.frequency, FREQUENCY, rtol=1e-12)
    # The format holds 12 digits.
    np.testing.assert_allclose(found.values, EXACT, atol=1e-11 * np.abs(EXACT).max())
    assert notes == [
        "wheel.uff: yx, zx taken as zero, as the wheel's symmetry has it",
        "wheel.uff: xx not given: the wheel is taken as rigid in that direction",
    ]


def test_uneven_lines_hold_six_digits(tmp_path):
    frequency = np.geomspace(10.0, 2000.0, 300)
    path = written(
        tmp_path, SI, function("zz", frequency=frequency, receptance=WHEEL.receptance(frequency), abscissa_spacing=0)
    )
    found, _ = read_receptance(path, axes=AXES)
    np.testing.assert_allclose(found.frequency, frequency, rtol=1e-5)


def test_force_and_response_at_different_nodes(tmp_path):
    path = written(
        tmp_path, SI, function("zz"), function("zz", ref_node=8, factor=0.5), function("zz", rsp_node=9, ref_node=9)
    )
    assert refused(path) == "FILE: responses at 2 nodes (7, 9); say which one is the contact: node"
    point, notes = read_receptance(path, axes=AXES, node=7)
    transfer, _ = read_receptance(path, axes=AXES, node=7, reference_node=8)
    np.testing.assert_allclose(transfer.values, 0.5 * point.values, rtol=1e-10)
    assert notes[0] == "wheel.uff: 2 functions of other nodes or types left out"
    assert refused(path, node=9, reference_node=8) == "FILE: no forces with node 9 at node 8; there are 9"


def test_what_was_measured(tmp_path):
    path = written(tmp_path, SI, function("zz", kind=0))
    assert refused(path) == (
        "FILE, data set 2 (type 58), line 7: doesn't say what was measured; say it: quantity = receptance, mobility, "
        "accelerance"
    )
    found, _ = read_receptance(path, axes=AXES, quantity="mobility")
    np.testing.assert_allclose(found.values[:, 2, 2], EXACT[:, 2, 2] / (2j * np.pi * FREQUENCY), rtol=1e-8)
    path = written(tmp_path, SI, function("zz", kind=12))
    assert refused(path, quantity="mobility") == (
        'FILE, data set 2 (type 58), line 7: holds the accelerance, but quantity = "mobility"; leave quantity out'
    )
    with pytest.raises(ParameterError, match="quantity = 'inertance' is refused"):
        read_receptance(path, axes=AXES, quantity="inertance")


def test_faults(tmp_path):
    where = "FILE, data set 2 (type 58), line 7: "
    assert refused(written(tmp_path, SI)) == "FILE: no frequency response function (data set 58 of function type 4)"
    assert refused(written(tmp_path, SI, function("zz", rsp_dir=5))) == (
        where + "response direction 5; allowed are +-1, +-2 and +-3, translations along the axes"
    )
    assert refused(written(tmp_path, SI, function("zz", orddenom_spec_data_type=8))) == (
        where + "the denominator is of type 8; allowed is 13, force"
    )
    assert refused(written(tmp_path, SI, function("zz", ordinate_spec_data_type=3))) == (
        where + "the ordinate is of type 3; allowed are 8, 11 and 12, displacement, velocity and acceleration"
    )
    assert refused(written(tmp_path, SI, function("zz", abscissa_spec_data_type=17))) == (
        where + "the abscissa is of type 17; allowed is 18, frequency"
    )
    assert refused(written(tmp_path, SI, function("zz", kind=12, ordinate_axis_units_lab="g"))) == (
        where + "the unit \"g\" of its ordinate isn't one of the file's units; export m/s2"
    )
    assert refused(written(tmp_path, SI, function("zz", kind=12, ordinate_axis_units_lab="mm/s2"))) == (
        where + 'the unit "mm/s2" of its ordinate contradicts the units of the file, m and N; give units'
    )
    assert refused(written(tmp_path, function("zz"))).startswith(
        "FILE, data set 1 (type 58), line 1: the file doesn't say its units"
    )
    twice = refused(written(tmp_path, SI, function("zz"), function("zz")))
    assert twice.startswith("FILE, data set 3 (type 58), line ")
    assert twice.endswith("a second function for the pair zz; the first is FILE, data set 2 (type 58), line 7")
    other = function("yy", frequency=FREQUENCY[:-1], receptance=EXACT[:-1])
    assert refused(written(tmp_path, SI, function("zz"), other)).endswith(
        "398 frequencies up to 1995 Hz, but FILE, data set 2 (type 58), line 7 has 399 up to 2000 Hz; all functions "
        "need the same"
    )


def test_a_file_that_is_cut_short(tmp_path):
    path = written(tmp_path, SI, function("zz"))
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:60] + lines[-1:]))
    assert refused(path).startswith("FILE, data set 2 (type 58), line 7: ")
    assert refused(path).endswith("values, but its header says 399")
