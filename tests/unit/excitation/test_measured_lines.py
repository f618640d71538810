import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.measured import read_measured_line
from wheelrail.excitation.measured_lines import names_positions, read_height_lines, read_measured_lines

DX = 1e-3
RADIUS = 0.46
TURN = 2.0 * np.pi * RADIUS


def write(folder, header, x, *columns):
    path = folder / "lines.csv"
    rows = [",".join(f"{value:.9g}" for value in row) for row in zip(x, *columns, strict=True)]
    path.write_text("\n".join(["# parallel lines", header, *rows]), encoding="utf-8")
    return path


def three(folder, header="x_m,y=-4mm_um,y=0mm_um,y=5mm_um", *, x=None, seed=2):
    """Three smooth lines with their own zero, and their file."""
    x = np.arange(400) * 1e-3 if x is None else x
    waves = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (3, 5))
    heights = np.array(
        [
            10.0 * (k + 1) + sum(np.sin(2.0 * np.pi * (m + 2) * x / 0.1 + phase[m]) for m in range(5))
            for k, phase in enumerate(waves)
        ]
    )
    return write(folder, header, x, *heights), x, heights * 1e-6


@pytest.mark.parametrize(
    "header",
    [
        "x_m,y=-4mm_um,y=0mm_um,y=5mm_um",
        "x [m],left y=-4mm [um],middle y = 0 mm [um],right y=5.0mm [um]",
        "x_m,height_y=-0.004m_um,height_y=0m_um,height_y=5e-3m_um",
        "x_m,Y=-4MM_um,Y=0MM_um,Y=+5MM_um",
    ],
)
def test_the_header_names_positions(tmp_path, header):
    path, x, heights = three(tmp_path, header)
    lines = read_height_lines(path)
    np.testing.assert_allclose(lines.lateral, [-4e-3, 0.0, 5e-3], atol=1e-18)
    np.testing.assert_allclose(lines.x, x, atol=1e-12)
    np.testing.assert_allclose(lines.heights, heights, atol=1e-13)  # printed with nine digits


def test_columns_are_sorted_by_position(tmp_path):
    path, _, heights = three(tmp_path, "x_m,y=5mm_um,y=-4mm_um,y=0mm_um")
    lines = read_height_lines(path)
    np.testing.assert_allclose(lines.heights, heights[[1, 2, 0]], atol=1e-13)
    assert lines.names == ("y=-4mm", "y=0mm", "y=5mm")


def test_the_caller_names_positions(tmp_path):
    path, _, heights = three(tmp_path, "x_m,a_um,b_um,c_um")
    assert read_height_lines(path).lateral is None
    lines = read_height_lines(path, lateral=[0.002, -0.001, 0.0])
    np.testing.assert_array_equal(lines.lateral, [-0.001, 0.0, 0.002])
    np.testing.assert_allclose(lines.heights, heights[[1, 2, 0]], atol=1e-13)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("x_m,y=-4mm_um,b_um,y=5mm_um", "line 2: column 'b' names no position across"),
        ("x_m,y=-4mm_um,y=-4.0mm_um,y=5mm_um", "two columns have the position y = -4 mm"),
        ("x_m,y=-4mm_um,y=zeromm_um,y=5mm_um", "'y=zeromm': the position across must be a number"),
        ("x_m,y=-4mm_um,y=nanmm_um,y=5mm_um", "'y=nanmm': the position across must be a number"),
        ("x_m,y=-4mm_um,y=0mm_um,y=5m_um", "'y=5m': the position across must be a number within 100 mm"),
        ("x_m,y=-4mm,y=0mm_um,y=5mm_um", "column .y=-4mm. names no unit"),
    ],
)
def test_faults_of_the_header(tmp_path, header, message):
    path, *_ = three(tmp_path, header)
    with pytest.raises(DataFileError, match=message):
        read_height_lines(path)


@pytest.mark.parametrize(
    ("header", "lateral", "message"),
    [
        ("x_m,y=-4mm_um,y=0mm_um,y=5mm_um", [0.0, 1e-3, 2e-3], "names the positions already"),
        ("x_m,a_um,b_um,c_um", [0.0, 1e-3], "3 height columns"),
        ("x_m,a_um,b_um,c_um", [0.0, 1.0, 2.0], "within 100 mm"),
        ("x_m,a_um,b_um,c_um", [0.0, float("nan"), 2e-3], "within 100 mm"),
        ("x_m,a_um,b_um,c_um", [0.0, 0.0, 2e-3], "twice"),
        ("x_m,a_um,b_um,c_um", None, "does not say where its lines lie"),
    ],
)
def test_faults_of_positions(tmp_path, header, lateral, message):
    path, *_ = three(tmp_path, header)
    with pytest.raises(ParameterError, match=message):
        read_measured_lines(path, dx=DX, on="rail", wheel_radius=None, beyond_end="stop", lateral=lateral)


def test_a_fault_in_a_further_column_is_found(tmp_path):
    x = np.arange(40) * 1e-3
    bad = np.zeros(40)
    bad[7] = 2e4
    path = write(tmp_path, "x_m,y=0mm_um,y=4mm_um", x, np.zeros(40), bad)
    with pytest.raises(DataFileError, match="line 10: height 20000 um is implausible"):
        read_height_lines(path)


@pytest.mark.parametrize(("on", "beyond_end"), [("rail", "stop"), ("rail", "repeat"), ("wheel", "stop")])
def test_every_line_is_treated_as_a_single_one(tmp_path, on, beyond_end):
    x = np.arange(round(TURN / 2e-3)) * 2e-3
    path, *_ = three(tmp_path, x=x)
    keys = {"dx": DX, "on": on, "wheel_radius": RADIUS, "beyond_end": beyond_end}
    lines, notes = read_measured_lines(path, **keys)
    assert lines.on == on
    for k in range(3):
        single, single_notes = read_measured_line(path, column=k + 1, **keys)
        np.testing.assert_array_equal(lines.values[k], single.values - single.values.mean())
        assert (lines.first_index, lines.periodic) == (single.first_index, single.periodic)
        assert lines.covered() == single.covered()
        # Nothing that is said about a line gets lost.
        assert all(any(note.endswith(said) for note in notes) for said in single_notes)
    assert sum("spacing" in note for note in notes) == 1
    assert "3 lines at y = -4, 0, 5 mm" in notes[-1]


@pytest.mark.parametrize(
    ("keys", "name"),
    [
        ({"on": "road"}, "on"),
        ({"beyond_end": "wrap"}, "beyond_end"),
        ({"on": "wheel", "wheel_radius": None}, "wheel_radius"),
    ],
)
def test_arguments_are_checked_as_for_a_single_line(tmp_path, keys, name):
    path, *_ = three(tmp_path)
    with pytest.raises(ParameterError, match=f"^{name} ="):
        read_measured_lines(path, **({"dx": DX, "on": "rail", "wheel_radius": RADIUS, "beyond_end": "stop"} | keys))


def test_columns_that_are_not_used_may_hold_anything(tmp_path):
    """A file of one line, with the gauge beside it: nothing says where columns lie, so the first is the line."""
    path = tmp_path / "log.csv"
    path.write_text("x_m,rail_um,gauge_mm\n" + "\n".join(f"{i / 1000},{i % 7},1435" for i in range(50)))
    assert not names_positions(path)
    lines = read_height_lines(path)
    assert lines.heights.shape == (1, 50)
    assert lines.lateral is None
