import math

import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.dent import dent
from wheelrail.excitation.prepare import prepare_source
from wheelrail.excitation.rail_joint import rail_joint
from wheelrail.excitation.view import ContactView, rigid_path
from wheelrail.excitation.wheel_flat import chord_flat, rounded_flat

R = 0.46
PLAIN = ContactView(radius=R, stretch=1.0, trajectory=False)
COMMON = {"dx": 1e-3, "wheel_radius": R, "view": PLAIN}


def test_a_chord_is_straight():
    s, heights, _ = chord_flat(depth=None, length=0.06, radius=R)
    np.testing.assert_allclose(heights + 0.06**2 / (8 * R), s**2 / (2 * R), rtol=0, atol=1e-18)
    assert heights.min() == pytest.approx(-(0.06**2) / (8 * R))
    assert heights[0] == heights[-1] == pytest.approx(0.0, abs=1e-18)
    from_depth = chord_flat(depth=0.06**2 / (8 * R), length=None, radius=R)[0]
    assert from_depth[-1] == pytest.approx(0.03)


def test_a_rigid_wheel_crosses_a_chord_on_its_edges():
    """The wheel turns about one edge, then about the other."""
    length = 0.06
    s, heights, _ = chord_flat(depth=None, length=length, radius=R)
    x, path = rigid_path(s, heights, radius=R)
    # The wheel stands on its nearer edge, |X| - l / 2 from the lowest point: it has come down by that squared / 2R.
    inside = np.abs(x) < 0.5 * length
    expected = -((0.5 * length - np.abs(x[inside])) ** 2) / (2 * R)
    assert np.abs(path[inside] - expected).max() < 2.8e-9  # achieved 2.72e-9: spacing^2 / 8R of the table
    assert not path[np.abs(x) > 0.5 * length].any()


def test_a_rounded_flat_has_its_depth_and_length():
    s, heights, notes = rounded_flat(depth=0.9e-3, length=0.1, radius=R)
    assert (s[0], s[-1]) == (-0.05, 0.05)
    assert heights.min() == -0.9e-3
    assert heights[len(s) // 4] == pytest.approx(-0.45e-3, rel=1e-12)
    assert not any("hollow" in note for note in notes)
    assert any("hollow" in note for note in rounded_flat(depth=2e-3, length=0.1, radius=R)[2])


@pytest.mark.parametrize("radius", [0.2, 0.3])
def test_a_stretched_shape_keeps_the_path_of_the_real_wheel(radius):
    """A wheel of reduced radius over the stretched shape goes where the real wheel goes over the real shape."""
    s, heights, _ = rounded_flat(depth=0.9e-3, length=0.1, radius=R)
    stretch = math.sqrt(R / radius)
    fine = np.arange(-4000, 4001) * 1e-5
    for x in (0.0, 0.007, -0.031, 0.049):
        real = np.max(np.interp(x + fine, s, heights) - fine**2 / (2 * R))
        reduced = np.max(np.interp(x + fine * stretch, s, heights) - fine**2 / (2 * radius))
        assert reduced == pytest.approx(real, abs=2e-9)  # achieved 5e-10: the searches' steps


@pytest.mark.parametrize("gap", [6e-3, 12e-3])
def test_a_gap_lets_the_wheel_down_by_a_chord(gap):
    x, heights = rail_joint(gap=gap, step=0.0, dip=0.0, dip_length=1.0, step_length=None)
    at, path = rigid_path(x, heights, radius=R)
    assert path.min() == pytest.approx(-(gap**2) / (8 * R), rel=2e-3)  # achieved 7e-4: the faces are 1 um wide
    assert abs(at[np.argmin(path)]) < 1e-4


def test_a_step_is_climbed_from_its_reach():
    """A rigid wheel begins to climb a step h where its surface is h above the rail: at sqrt(2 R h) before it."""
    step = 0.5e-3
    x, heights = rail_joint(gap=0.0, step=step, dip=0.0, dip_length=1.0, step_length=None)
    at, path = rigid_path(x, heights, radius=R)
    begin = at[np.argmax(path > 1e-9)]
    assert begin == pytest.approx(-math.sqrt(2 * R * step), abs=2e-4)
    assert path[-1] == pytest.approx(step)
    back = rail_joint(gap=0.0, step=step, dip=0.0, dip_length=1.0, step_length=0.5)
    assert back[1][-1] == 0.0
    assert np.interp(0.25, *back) == pytest.approx(0.25 * step, rel=1e-9)


def test_dips_meet_at_the_joint():
    x, heights = rail_joint(gap=0.0, step=0.0, dip=2e-3, dip_length=0.5, step_length=None)
    np.testing.assert_allclose(
        np.interp([-0.5, -0.25, 0.0, 0.25, 0.5], x, heights), [0, -0.5e-3, -2e-3, -0.5e-3, 0], atol=1e-8
    )


def test_a_dent_is_level_at_its_rim():
    s, heights, offsets = dent(depth=1e-4, length=0.04, width=0.02)
    assert heights.min() == heights[20, len(s) // 2] == -1e-4
    assert not heights[[0, -1]].any()
    assert not heights[:, [0, -1]].any()
    assert (offsets[0], offsets[-1]) == (-0.01, 0.01)
    # Volume of the raised cosine over an ellipse: d / 2 (1 - 4 / pi^2) pi a b.
    volume = heights.sum() * (s[1] - s[0]) * (offsets[1] - offsets[0])
    assert -volume == pytest.approx(0.5e-4 * (1 - 4 / math.pi**2) * math.pi * 0.02 * 0.01, rel=2e-3)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"type": "wheel-flat", "shape": "new", "angle": 0.0}, "depth or its length"),
        ({"type": "wheel-flat", "shape": "new", "angle": 0.0, "depth": 1e-3, "length": 0.1}, "2.717 mm deep.*60.66 mm"),
        ({"type": "wheel-flat", "shape": "rounded", "angle": 0.0, "depth": 1e-3}, "depth and its length"),
        ({"type": "wheel-flat", "shape": "rounded", "angle": 0.0, "depth": 1e-3, "length": 0.9}, "quarter of the turn"),
        ({"type": "wheel-flat", "shape": "oval", "angle": 0.0}, "allowed"),
        ({"type": "rail-joint", "position": 0.0, "dip": 1e-3}, "dip_length"),
        ({"type": "rail-joint", "position": 0.0, "step": 1e-3, "spacing": 20.0}, "step_length"),
        ({"type": "dent", "on": "rail", "depth": 1e-4, "length": 0.03}, "position"),
        ({"type": "dent", "on": "wheel", "depth": 1e-4, "length": 0.03}, "angle"),
        ({"type": "out-of-round", "orders": [1, 2], "amplitudes": [1e-4]}, "one for each"),
        ({"type": "out-of-round", "orders": [1500], "amplitudes": [1e-4]}, "2 dx"),
        ({"type": "corrugation", "amplitude": 1e-5, "wavelength": 1e-3, "start": 0.0, "length": 1.0}, "2 dx"),
    ],
)
def test_wrong_entries(keys, message):
    with pytest.raises(ParameterError, match=message):
        prepare_source(**COMMON, **keys)


def test_angle_says_where_the_flat_comes_down():
    source, notes = prepare_source(type="wheel-flat", shape="rounded", depth=1e-3, length=0.1, angle=math.pi, **COMMON)
    x = np.arange(2 * 2891)
    out = np.zeros(len(x))
    for first in range(0, len(x), 1):
        one = np.zeros(1)
        source.add_window(first, one)
        out[first] = one[0]
    lowest = np.flatnonzero(out < -0.9999e-3)
    assert abs(lowest[0] * 1e-3 - math.pi * R) < 1e-3
    assert any("x = 1.44513 m, and every 2.89027 m" in note for note in notes)


def flat_file(path, *, lines=1, tilt=0.0, reach=0.08):
    x = np.arange(-reach, reach + 1e-9, 1e-3)
    depth = np.where(np.abs(x) < 0.05, 0.45 * (1 + np.cos(2 * np.pi * x / 0.1)), 0.0)
    columns = ["x_m", "height_mm"] if lines == 1 else ["x_m", *(f"y={4 * i - 4}mm_mm" for i in range(lines))]
    rows = [[xi, *(-(1.0 - 0.1 * i) * d + tilt * xi for i in range(lines))] for xi, d in zip(x, depth, strict=True)]
    path.write_text(",".join(columns) + "\n" + "\n".join(",".join(f"{v:.9g}" for v in row) for row in rows))
    return path


def test_a_measured_flat(tmp_path):
    path = flat_file(tmp_path / "flat.csv", tilt=0.3)
    source, notes = prepare_source(type="wheel-flat", shape="measured", file=path, angle=0.0, **COMMON)
    formula, _ = prepare_source(type="wheel-flat", shape="rounded", depth=0.9e-3, length=0.1, angle=0.0, **COMMON)
    for first in (-40, -5, 30):
        measured, exact = np.zeros(41), np.zeros(41)
        source.add_window(first, measured)
        formula.add_window(first, exact)
        np.testing.assert_allclose(measured, exact, rtol=0, atol=3e-7)  # points 1 mm apart: 2.2e-7
    assert any("0.9 mm deep on 1 line of 160 mm" in note for note in notes)


def test_a_measured_flat_of_several_lines(tmp_path):
    path = flat_file(tmp_path / "flat.csv", lines=3)
    source, notes = prepare_source(type="wheel-flat", shape="measured", file=path, angle=0.0, **COMMON)
    out = np.zeros((3, 1))
    source.add_surface(0, np.array([-4e-3, 0.0, 2e-3]), np.zeros(3), out)
    np.testing.assert_allclose(out[:, 0], [-0.9e-3, -0.81e-3, -0.765e-3], rtol=1e-6)
    assert any("on 3 lines" in note for note in notes)


def test_a_file_that_ends_in_the_flat(tmp_path):
    path = flat_file(tmp_path / "flat.csv", reach=0.03)
    with pytest.raises(DataFileError, match="sound tread"):
        prepare_source(type="wheel-flat", shape="measured", file=path, angle=0.0, **COMMON)
    bump = flat_file(tmp_path / "bump.csv")
    bump.write_text(
        "\n".join(line if i == 0 else line.replace(",-", ",") for i, line in enumerate(bump.read_text().splitlines()))
    )
    with pytest.raises(DataFileError, match="no flat"):
        prepare_source(type="wheel-flat", shape="measured", file=bump, angle=0.0, **COMMON)
