"""Mode shapes in universal files that pyuff writes."""

import numpy as np
import pytest
import pyuff

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.wheel.modal_file import read_modes

AXES = ("x", "-z", "y")  # of a file whose y points down and whose z points to the gauge side
NODES = [11, 12, 13]
# Rows: nodes; columns: the file's x, y, z.
SHAPES = [
    np.array([[0.1, 0.2, -0.3], [0.0, 0.5, -1.0], [0.0, 0.4, 0.8]]),
    np.array([[0.0, 1.0, 0.2], [0.0, 0.9, 0.1], [0.0, -0.5, 0.0]]),
]
FREQUENCIES, RATIOS, MASSES = [412.6, 1650.3], [1e-4, 2e-3], [41.0, 0.16]
UNITS = {
    "m-kg-s": {"units_code": 1, "length": 1.0, "force": 1.0},
    "mm-t-s": {"units_code": 9, "length": 1000.0, "force": 1.0},
    "mm-kg-s": {"units_code": 5, "length": 1000.0, "force": 1000.0},
}


def units_set(name, **other):
    return {
        "type": 164,
        "units_description": name,
        "temp_mode": 1,
        "temp": 1.0,
        "temp_offset": 0.0,
        **UNITS[name],
        **other,
    }


def mode_set(i, *, shape=None, mass=None, ratio=None, **other):
    shape = SHAPES[i] if shape is None else shape
    return {
        "type": 55,
        "model_type": 1,
        "analysis_type": 2,
        "data_ch": 2,
        "spec_data_type": 8,
        "load_case": 1,
        "mode_n": i + 1,
        "freq": FREQUENCIES[i],
        "modal_m": MASSES[i] if mass is None else mass,
        "modal_damp_vis": RATIOS[i] if ratio is None else ratio,
        "node_nums": NODES,
        **{f"r{k + 1}": shape[:, k] for k in range(3)},
        **other,
    }


def complex_set(i, *, phase, spread=0.0, conjugate=False):
    """The same mode as a complex one: turned by a phase, with modal A to match, and out of phase by some spread."""
    omega = 2 * np.pi * FREQUENCIES[i]
    pole = omega * (-RATIOS[i] + 1j * np.sqrt(1 - RATIOS[i] ** 2))
    turn = np.exp(1j * phase)
    out = np.exp(1j * spread * np.arange(len(NODES)))
    data = mode_set(i, shape=SHAPES[i] * out[:, None] * turn, analysis_type=3)
    data["eig"], data["modal_a"] = pole, 2j * pole.imag * MASSES[i] * turn**2
    data["modal_b"] = -pole * data["modal_a"]
    if conjugate:
        data.update({key: np.conj(data[key]) for key in ("eig", "modal_a", "modal_b", "r1", "r2", "r3")})
    return data


def collinearity(data):
    """Modal phase collinearity as Pappa, Elliott and Schenk (1993) write it, with real and imaginary parts."""
    shape = np.concatenate([data["r1"], data["r2"], data["r3"]])
    xx, yy, xy = shape.real @ shape.real, shape.imag @ shape.imag, shape.real @ shape.imag
    return ((xx - yy) ** 2 + 4 * xy**2) / (xx + yy) ** 2


def written(tmp_path, *sets):
    path = tmp_path / "modes.unv"
    pyuff.UFF(str(path)).write_sets([dict(data) for data in sets], mode="overwrite")
    return path


@pytest.mark.parametrize(("units", "kilograms"), [("m-kg-s", 1.0), ("mm-t-s", 1000.0), ("mm-kg-s", 1.0)])
def test_normal_modes_with_their_units_and_axes(tmp_path, units, kilograms):
    path = written(tmp_path, units_set(units), mode_set(0), mode_set(1))
    wheel, notes = read_modes(path, node=12, axes=AXES)
    assert notes == []
    assert [mode.name for mode in wheel.modes] == ["mode-1", "mode-2"]
    # The format holds six digits.
    for mode, f, ratio, mass in zip(wheel.modes, FREQUENCIES, RATIOS, MASSES, strict=True):
        assert mode.frequency == pytest.approx(f, rel=1e-5)
        assert mode.damping_ratio == pytest.approx(ratio, rel=1e-5)
        assert mode.mass == pytest.approx(mass * kilograms, rel=1e-5)
    assert wheel.modes[0].shape == pytest.approx((0.0, 1.0, 0.5), abs=1e-6)
    assert wheel.modes[1].shape == pytest.approx((0.0, -0.1, 0.9), abs=1e-6)


def test_units_of_a_file_without_and_with_wrong_ones(tmp_path):
    path = written(tmp_path, mode_set(0))
    with pytest.raises(DataFileError) as caught:
        read_modes(path, node=12, axes=AXES)
    assert str(caught.value) == (
        f"{path}, data set 1 (type 55), line 1: the file doesn't say its units (no data set 164 before this one); give "
        "units = m-kg-s or mm-t-s or mm-kg-s"
    )
    assert read_modes(path, node=12, axes=AXES, units="mm-t-s")[0].modes[0].mass == pytest.approx(41e3)
    # SI by its code and foot by its factor, as the example in the documentation of pyuff has it.
    path = written(tmp_path, units_set("m-kg-s", length=3.28083989501312334), mode_set(0))
    with pytest.raises(
        DataFileError, match=r"units code 1 means 1 and 1 units per m and N, but the factors are 3\.28084"
    ):
        read_modes(path, node=12, axes=AXES)
    assert read_modes(path, node=12, axes=AXES, units="m-kg-s")[0].modes[0].mass == pytest.approx(41.0)
    with pytest.raises(ParameterError, match="units = 'inch' is refused: allowed: m-kg-s, mm-t-s, mm-kg-s"):
        read_modes(path, node=12, axes=AXES, units="inch")


def test_complex_modes_are_turned(tmp_path):
    path = written(
        tmp_path,
        units_set("m-kg-s"),
        complex_set(0, phase=0.7),
        complex_set(0, phase=0.7, conjugate=True),
        complex_set(1, phase=-2.0, spread=0.05),
    )
    wheel, notes = read_modes(path, node=12, axes=AXES)
    reference, _ = read_modes(written(tmp_path, units_set("m-kg-s"), mode_set(0), mode_set(1)), node=12, axes=AXES)
    assert len(wheel.modes) == 2
    f = np.array([100.0, 412.6, 1000.0, 1650.0])
    expected = reference.receptance(f)
    found = wheel.receptance(f)
    # 0.1 rad between the nodes of the second mode; at 412.6 Hz the six digits of the frequency show.
    assert np.abs(found - expected).max() < 2e-2 * np.abs(expected).max()
    assert notes == ["modes.unv: complex modes turned to real ones; smallest phase collinearity 0.9953"]
    assert collinearity(complex_set(1, phase=0.0, spread=0.05)) == pytest.approx(0.9953, abs=5e-5)


def test_modes_that_are_too_complex_are_refused(tmp_path):
    path = written(tmp_path, units_set("m-kg-s"), complex_set(0, phase=0.2, spread=0.6))
    with pytest.raises(DataFileError) as caught:
        read_modes(path, node=12, axes=AXES)
    assert str(caught.value) == (
        f"{path}, data set 2 (type 55), line 7: complex mode at 412.6 Hz with phase collinearity "
        f"{collinearity(complex_set(0, phase=0.0, spread=0.6)):.3f}; at least 0.95 is allowed, because real modes "
        "can't show its phases (receptances can)"
    )
    wrong = complex_set(0, phase=0.2)
    wrong["modal_a"] *= 1j
    with pytest.raises(DataFileError, match=r"modal A of the mode at 412.6 Hz doesn't belong to its shape"):
        read_modes(written(tmp_path, units_set("m-kg-s"), wrong), node=12, axes=AXES)


def test_node_that_the_file_leaves_out_does_not_move(tmp_path):
    second = mode_set(1, shape=SHAPES[1][:1], node_nums=NODES[:1])
    wheel, notes = read_modes(written(tmp_path, units_set("m-kg-s"), mode_set(0), second), node=12, axes=AXES)
    assert [mode.name for mode in wheel.modes] == ["mode-1"]
    assert notes == ["modes.unv: 1 of 2 modes don't move at node 12"]


def test_shapes_without_a_modal_mass(tmp_path):
    path = written(tmp_path, units_set("mm-t-s"), mode_set(0, mass=0.0))
    with pytest.raises(DataFileError, match=r"line 7: modal mass 0; allowed is above 0.*say so: mass_normalised"):
        read_modes(path, node=12, axes=AXES)
    assert read_modes(path, node=12, axes=AXES, mass_normalised=True)[0].modes[0].mass == pytest.approx(1e3)


def test_damping_that_the_file_leaves_out(tmp_path):
    path = written(tmp_path, units_set("m-kg-s"), mode_set(0, ratio=0.0, modal_damp_his=0.02), mode_set(1))
    with pytest.raises(DataFileError, match=r"no \(viscous\) damping of 1 modes \(the first is mode-1\)"):
        read_modes(path, node=12, axes=AXES)
    wheel, notes = read_modes(path, node=12, axes=AXES, damping=3e-4)
    assert [mode.damping_ratio for mode in wheel.modes] == pytest.approx([3e-4, 2e-3])
    assert notes == [
        "modes.unv: hysteretic damping of 1 modes not used: programs define it differently; the viscous damping ratio "
        "counts"
    ]


def test_which_node(tmp_path):
    path = written(tmp_path, units_set("m-kg-s"), mode_set(0))
    with pytest.raises(DataFileError) as caught:
        read_modes(path, axes=AXES)
    assert str(caught.value) == f"{path}: mode shapes at 3 nodes (11, 12, 13); say which one is the contact: node"
    with pytest.raises(DataFileError, match="no mode shapes at node 99; there are 11, 12, 13"):
        read_modes(path, node=99, axes=AXES)


def test_axes(tmp_path):
    path = written(tmp_path, units_set("m-kg-s"), mode_set(0))
    with pytest.raises(ParameterError, match="is a universal file; it names the axes of the file"):
        read_modes(path, node=12)
    for axes in (("x", "y"), ("x", "y", "y"), ("x", "y", "down")):
        with pytest.raises(ParameterError, match="it names the axes of the file"):
            read_modes(path, node=12, axes=axes)
    wheel, notes = read_modes(path, node=12, axes=("X", "z", "y"))
    assert wheel.modes[0].shape == pytest.approx((0.0, -1.0, 0.5), abs=1e-6)
    assert notes == ["modes.unv: the axes x, z, y make a mirror image: right for a left-hand wheel only"]


def node_set(frame):
    return {
        "type": 15,
        "node_nums": NODES,
        "disp_cs": [frame] * 3,
        "def_cs": [0] * 3,
        "x": [0.0] * 3,
        "y": [0.0] * 3,
        "z": [0.0] * 3,
    }


def frame_set(kind, matrix):
    return {
        "type": 2420,
        "Part_UID": 1,
        "Part_Name": "wheel",
        "CS_sys_labels": [7],
        "CS_types": [kind],
        "CS_colors": [1],
        "CS_names": ["frame"],
        "CS_matrices": [np.vstack([matrix, np.zeros(3)])],
    }


def test_nodes_in_frames_of_their_own(tmp_path):
    modes = units_set("m-kg-s"), mode_set(0)
    turned = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for frames in ([frame_set(0, np.eye(3)), node_set(7)], [node_set(0)], [node_set(1)]):
        assert len(read_modes(written(tmp_path, *frames, *modes), node=12, axes=AXES)[0].modes) == 1
    for frames in ([frame_set(0, turned), node_set(7)], [frame_set(1, np.eye(3)), node_set(7)], [node_set(7)]):
        with pytest.raises(
            DataFileError, match="the displacements of node 12 are in coordinate system 7, which is not the global one"
        ):
            read_modes(written(tmp_path, *frames, *modes), node=12, axes=AXES)


def test_files_without_modes_and_damaged_ones(tmp_path):
    path = written(tmp_path, units_set("m-kg-s"))
    with pytest.raises(DataFileError, match="no mode shapes"):
        read_modes(path, node=12, axes=AXES)
    path = written(tmp_path, units_set("m-kg-s"), mode_set(0))
    path.write_text(path.read_text().replace("4.12600e+02", "4.12600e+xx"))
    with pytest.raises(DataFileError) as caught:
        read_modes(path, node=12, axes=AXES)
    assert str(caught.value) == (
        f"{path}, data set 2 (type 55), line 7: can't be read; its records aren't laid out as the format says"
    )
