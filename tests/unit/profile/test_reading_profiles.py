"""Readers of profile files against published files of the same bodies, and against the standard S1002 geometry."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.profile.orientation import orient
from wheelrail.profile.reading import read_profile

DATA = Path(__file__).parents[2] / "data" / "profiles"


def wheel_points(count=201):
    """S1002 after EN 13715 from the tip of the flange to the field side, mm: flange at -y, z down.

    The circles and lines of the flange, and a cone of 1:40 in place of the polynomial of the tread.
    """
    y = np.linspace(-69.0, 60.0, count)
    z = np.empty(count)
    for low, high, shape in (
        (-71.0, -62.764705882, lambda s: 9.519259302 + np.sqrt(20.5**2 - (s + 49.5) ** 2)),
        (-62.764705882, -49.662510381, lambda s: 16.0 + np.sqrt(12.0**2 - (s + 55.0) ** 2)),
        (-49.662510381, -39.764473993, lambda s: 8.834924130 + np.sqrt(20.0**2 - (s + 58.558326413) ** 2)),
        (-39.764473993, -38.426669071, lambda s: -93.576667419 - 2.747477419 * s),
        (-38.426669071, -26.210665, lambda s: 16.446 - np.sqrt(13.0**2 - (s + 26.210665) ** 2)),
        (-26.210665, 61.0, lambda s: 3.446 - 0.05 * (s + 26.210665)),
    ):
        part = (y >= low) & (y < high)
        z[part] = shape(y[part])
    return np.column_stack([y, z])


def rail_points(count=181):
    """A rail head of 72 mm with a crown of 300 mm, corners of 13 mm and faces down to 36 mm, mm; y asymmetric."""
    corner = np.linspace(0.0, 0.5 * np.pi, 40)[::-1]
    top = np.linspace(-23.0, 23.0, count - 120)
    depth = 300.0 - np.sqrt(300.0**2 - 23.0**2)
    face = np.linspace(36.0, depth + 13.5, 20)
    left = np.column_stack([-23.0 - 13.0 * np.sin(corner), depth + 13.0 - 13.0 * np.cos(corner)])
    return np.vstack(
        [
            np.column_stack([np.full(20, -36.0), face]),
            left,
            np.column_stack([top, 300.0 - np.sqrt(300.0**2 - top**2)])[1:-1],
            (left * [-1.0, 1.0])[::-1],
            np.column_stack([np.full(18, 36.0), face[::-1][:18]]),
        ]
    )


POINTS = {"wheel": wheel_points(), "rail": rail_points()}


def write(folder, points, *, header="", separator=",", name="profile.csv"):
    path = folder / name
    rows = "\n".join(f"{a:.9g}{separator}{b:.9g}" for a, b in points)
    path.write_text(f"{header}\n{rows}\n" if header else rows + "\n", encoding="utf-8")
    return path


def wheel_from(start):
    return POINTS["wheel"][POINTS["wheel"][:, 0] > start]


@pytest.mark.parametrize("kind", ["wheel", "rail"])
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("down", [1.0, -1.0])
@pytest.mark.parametrize(("factor", "unit"), [(1.0, "mm"), (1e-3, "m")])
def test_unit_height_and_order_are_found(tmp_path, kind, reverse, down, factor, unit):
    given = (POINTS[kind] * [1.0, down] * factor)[:: -1 if reverse else 1]
    profile = read_profile(write(tmp_path, given), kind=kind)
    # Printed to nine digits.
    np.testing.assert_allclose(np.column_stack([profile.y, profile.z]), 1e-3 * POINTS[kind], atol=1e-9)
    assert any(f"taken as {unit}," in note for note in profile.notes)
    assert any("upside down" in note for note in profile.notes) == (down < 0.0)
    assert any("reversed" in note for note in profile.notes) == reverse


@pytest.mark.parametrize("down", [1.0, -1.0])
def test_a_wheel_tells_the_side_of_its_flange(tmp_path, down):
    path = write(tmp_path, POINTS["wheel"] * [-1.0, down])
    for mirrored in (None, True):
        profile = read_profile(path, kind="wheel", mirrored=mirrored)
        np.testing.assert_allclose(profile.y, 1e-3 * POINTS["wheel"][:, 0], atol=1e-9)
    with pytest.raises(DataFileError, match=r"profile\.csv: the flange lies on the other side; mirrored = False"):
        read_profile(path, kind="wheel", mirrored=False)


def test_a_rail_keeps_its_side_unless_told(tmp_path):
    worn = POINTS["rail"][:-30]
    path = write(tmp_path, worn)
    assert any("gauge side taken at negative y" in note for note in read_profile(path, kind="rail").notes)
    mirrored = read_profile(path, kind="rail", mirrored=True)
    np.testing.assert_allclose(mirrored.y, -1e-3 * worn[::-1, 0], atol=1e-9)
    assert np.all(np.isfinite(mirrored.z))
    assert not any("gauge side" in note for note in mirrored.notes)


@pytest.mark.parametrize(
    ("start", "end"),
    [(-55.0, 60.0), (-69.0, 15.0), (-60.0, 30.0)],
    ids=["front of the flange", "short tread", "part"],
)
def test_a_part_of_a_wheel_is_enough(start, end):
    points = POINTS["wheel"]
    part = points[(points[:, 0] >= start) & (points[:, 0] <= end)]
    for side in (1.0, -1.0):
        for down in (1.0, -1.0):
            y, z, _ = orient(side * part[:, 0], down * part[:, 1], kind="wheel")
            np.testing.assert_allclose(np.column_stack([y, z]), 1e-3 * part, atol=1e-12)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("wheel_s1002.prw", "wheel"),
        ("wheel_worn_old_header.whl", "wheel"),
        ("rail_60e1_canted.prr", "rail"),
        ("rail_roller.ban", "rail"),
    ],
)
def test_measured_profiles_are_turned_back_from_every_direction(name, kind):
    profile = read_profile(DATA / name, kind=kind)
    rng = np.random.default_rng(3)
    for roll in (-0.03, 0.0, 0.03):  # the instrument sits askew
        c, s = np.cos(roll), np.sin(roll)
        points = np.column_stack([profile.y, profile.z]) @ np.array([[c, s], [-s, c]])
        points += 30e-6 * rng.standard_normal(points.shape)
        for side in (1.0, -1.0) if kind == "wheel" else (1.0,):
            for down in (1.0, -1.0):
                for order in (1, -1):
                    given = (points * [side, down])[::order]
                    y, z, _ = orient(*given.T, kind=kind)
                    np.testing.assert_array_equal(np.column_stack([y, z]), points)


def test_outer_rim_is_not_taken_for_the_flange():
    # Measured round the rim, a wheel stood on its head shows something like a flange there, 17 mm high.
    rim = np.column_stack([np.full(40, 62.0), np.linspace(-3.0, -20.0, 40)])
    full = np.vstack([POINTS["wheel"], rim])
    y, z, notes = orient(-full[:, 0], -full[:, 1], kind="wheel")
    np.testing.assert_allclose(np.column_stack([y, z]), 1e-3 * full, atol=1e-12)
    assert any("upside down" in note for note in notes)
    # Without the back of the flange, and round the rim down to 24 mm, nothing tells which is which.
    deep = np.vstack([wheel_from(-55.0), rim, [[62.0, -24.0]]])
    with pytest.raises(DataFileError, match=r"can't be told from the outer rim"):
        orient(deep[:, 0], deep[:, 1], kind="wheel")


@pytest.mark.parametrize(("asked", "held"), [("wheel", "rail"), ("rail", "wheel")])
def test_the_shape_of_another_body_is_refused(tmp_path, asked, held):
    with pytest.raises(DataFileError, match=r"profile\.csv: (no flange|the shape isn't that of a rail head)"):
        read_profile(write(tmp_path, POINTS[held]), kind=asked)


@pytest.mark.parametrize(
    ("header", "separator", "factor"),
    [
        ("y_mm,z_mm", ",", 1.0),
        ("y [m];z [m]", ";", 1e-3),
        ("lateral (mm)\theight (mm)", "\t", 1.0),
        ("x/mm z/mm", " ", 1.0),
        ("Y[um]  Z[um]", "  ", 1e3),
        ("y [in], z [in]", ",", 1.0 / 25.4),
        ("# measured\n! by laser\n% in the depot\n\ny,z", ",", 1.0),
        ("y z", " ", 1.0),
    ],
)
def test_headers_and_separators(tmp_path, header, separator, factor):
    profile = read_profile(write(tmp_path, factor * POINTS["wheel"], header=header, separator=separator), kind="wheel")
    np.testing.assert_allclose(np.column_stack([profile.y, profile.z]), 1e-3 * POINTS["wheel"], atol=1e-9)


def test_columns_are_found_by_name(tmp_path):
    path = tmp_path / "columns.txt"
    rows = "\n".join(f"{i};{b:.9g};{a:.9g}" for i, (a, b) in enumerate(POINTS["wheel"]))
    path.write_text(f"number;z_mm;y_mm\n{rows}\n", encoding="utf-8")
    np.testing.assert_allclose(read_profile(path, kind="wheel").y, 1e-3 * POINTS["wheel"][:, 0], atol=1e-9)


def test_simpack_and_miniprof_give_the_same_rail():
    simpack = read_profile(DATA / "rail_60e1_canted.prr", kind="rail")
    # The two files of the publisher differ in the direction of y.
    miniprof = read_profile(DATA / "rail_60e1_canted.ban", kind="rail", mirrored=True)
    np.testing.assert_array_equal(simpack.y, miniprof.y)
    np.testing.assert_array_equal(simpack.z, miniprof.z)
    # Canted towards the track centre, the top lies nearer to the field face: the gauge face is at -y.
    assert simpack.y[0] == pytest.approx(-43.70489e-3)
    assert simpack.y[np.argmin(simpack.z)] == pytest.approx(0.0, abs=1e-3)


def test_simpack_steps_put_an_s1002_wheel_in_place():
    profile = read_profile(DATA / "wheel_s1002.prw", kind="wheel")
    # EN 13715: the tip of the flange is a circle of 12 mm about (-55, 16) mm, 28 mm high; found to 1e-6 mm.
    tip = (profile.y > -62.7e-3) & (profile.y < -49.7e-3)
    assert np.sum(tip) >= 6
    np.testing.assert_allclose(np.hypot(profile.y[tip] + 55e-3, profile.z[tip] - 16e-3), 12e-3, atol=2e-9)
    assert np.max(profile.z) == pytest.approx(28e-3, abs=1e-5)
    field = profile.y > 32.2e-3  # cone of 1:15
    np.testing.assert_allclose(profile.z[field], 1.364323640e-3 - profile.y[field] / 15.0, atol=2e-8)
    assert np.all(np.diff(profile.y) > 0.0)


def simpack_text(points, **keys):
    lines = ["header.begin", "version = 1", "type = 1", "header.end", "spline.begin"]
    lines += [f"{key.replace('_', '.')} = {value}" for key, value in keys.items()]
    return "\n".join([*lines, "point.begin", *(f"{a:.9g} {b:.9g} 1.0" for a, b in points), "point.end", "spline.end"])


def test_simpack_shift_rotation_bounds_and_unit(tmp_path):
    points = POINTS["wheel"]
    angle = 0.02
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    given = points @ rotation - [3.0, -2.0]  # what shift and rotation turn back
    path = tmp_path / "wheel.prw"
    keys = {"shift_y": 3.0, "shift_z": -2.0, "rotate": np.degrees(angle), "units_ang_f": 180.0 / np.pi}
    path.write_text(simpack_text(given, **keys, bound_y_min=-100, bound_y_max=40, units_len_f="1e3"), encoding="utf-8")
    profile = read_profile(path, kind="wheel")
    kept = points[points[:, 0] <= 40.0]
    np.testing.assert_allclose(np.column_stack([profile.y, profile.z]), 1e-3 * kept, atol=1e-9)
    assert any("rotated by 0.02 rad" in note for note in profile.notes)
    assert f"points outside bound.y left out: {len(points) - len(kept)}" in profile.notes


@pytest.mark.parametrize(
    ("key", "side", "told"),
    [("mirror.y", -1.0, "y mirrored"), ("mirror.z", 1.0, "z mirrored"), ("inversion", 1.0, "order")],
)
def test_simpack_mirrors_and_inversion(tmp_path, key, side, told):
    # A rail's shape doesn't tell its side, so the key must be followed; height and order are put right again.
    text = (DATA / "rail_60e1_canted.prr").read_text(encoding="utf-8")
    line = f"    {key:<15s}=  0"
    assert line in text
    path = tmp_path / "rail.prr"
    path.write_text(text.replace(line, line[:-1] + "1"), encoding="utf-8")
    plain = read_profile(DATA / "rail_60e1_canted.prr", kind="rail")
    turned = read_profile(path, kind="rail")
    np.testing.assert_array_equal(turned.y, side * plain.y[:: int(side)])
    np.testing.assert_array_equal(turned.z, plain.z[:: int(side)])
    assert any(told in note for note in turned.notes)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"mirror_y": 2}, r"line 6: mirror\.y = 2; allowed: 0 or 1"),
        ({"units_len_f": 0}, r"line 6: units\.len\.f = 0; it must be above 0"),
        ({"units_len": "'furlong'"}, r"units\.len = 'furlong'; allowed: m, cm, mm"),
        ({"shift_y": "one"}, r"line 6, shift\.y: 'one' is not a finite number"),
        ({"bound_z_min": 0, "bound_z_max": 50}, r"line \d+: outside bound\.z of 0 to 50"),
        ({"units_len_f": 1}, r"implausible; a profile lies within 10 m of its origin. Is the unit right"),
    ],
)
def test_simpack_keys_that_are_refused(tmp_path, keys, message):
    path = tmp_path / "wheel.prw"
    path.write_text(simpack_text(POINTS["wheel"], **keys), encoding="utf-8")
    with pytest.raises(DataFileError, match=message):
        read_profile(path, kind="wheel")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("point.end", "", r"line \d+: spline\.end is out of place"),
        ("spline.end", "", r"section spline doesn't end; the file is cut off"),
        ("point.begin", "knot.begin", r"unknown section 'knot'; allowed: header, spline, point"),
        ("version = 1", "version", r"line 2: 'version' is neither a key"),
        ("type = 1", "type = 7", r"line 3: type = '7'; allowed: 0 \(rail\) or 1 \(wheel\)"),
        ("type = 1", "type = 0", r"the file holds the profile of a rail; a wheel is asked for"),
    ],
)
def test_simpack_sections_that_are_refused(tmp_path, old, new, message):
    path = tmp_path / "wheel.prw"
    path.write_text(simpack_text(POINTS["wheel"]).replace(old, new), encoding="utf-8")
    with pytest.raises(DataFileError, match=message):
        read_profile(path, kind="wheel")


def test_a_known_format_is_recognised_under_another_name(tmp_path):
    for name in ("wheel_s1002.prw", "wheel_worn_old_header.whl"):
        plain = read_profile(DATA / name, kind="wheel")
        copy = shutil.copy(DATA / name, tmp_path / "copy.txt")
        np.testing.assert_array_equal(read_profile(copy, kind="wheel").y, plain.y)


def replaced(row, text):
    lines = [f"{a:.9g},{b:.9g}" for a, b in POINTS["wheel"]]
    lines[row] = text
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", r"p\.csv: the file is empty"),
        (replaced(7, "nan,1"), r"p\.csv, line 8: 'nan' is not a finite number"),
        (replaced(7, "1,inf"), r"p\.csv, line 8: 'inf' is not a finite number"),
        (replaced(7, "1,abc"), r"p\.csv, line 8: 'abc' is not a finite number"),
        (replaced(7, "1,"), r"p\.csv, line 8: an empty field is not a finite number"),
        (replaced(7, "1,2,3"), r"p\.csv, line 8: 3 values; the lines before have 2; decimal commas"),
        (replaced(7, "1;2"), r"p\.csv, line 8: 1 values; the lines before have 2"),
        (replaced(7, "1e300,2"), r"p\.csv, line 8: 1e\+300 is implausible"),
        (replaced(7, "30000,2"), r"p\.csv, line 8: 30000 is implausible; a profile lies within 10 m"),
        (replaced(100, "-20,3"), r"p\.csv, line 102: 16\.16 mm from the point before; a gap of 15 mm"),
        ("1,5,2,5\n1,6,2,5\n", r"p\.csv, line 1: 4 columns and no header; .* decimal commas"),
        ("y;z\n1,5;2,5\n", r"p\.csv, line 2: '1,5' is not a finite number; decimal commas"),
        ("y_mm z_mm\n1,5 2,5\n", r"p\.csv, line 2: '1,5' is not a finite number; decimal commas"),
        ("y_ft,z_ft\n1,2\n", r"p\.csv: 1 different points|plausible neither"),
        ("y [ft],z [ft]\n1,2\n", r"p\.csv, line 1: column 'y \[ft\]': unit 'ft'; allowed: m, cm, mm"),
        ("y_mm,z_m\n1,2\n", r"p\.csv, line 1: columns 'y_mm' and 'z_m' differ in unit"),
        ("a,b,c\n1,2,3\n", r"p\.csv, line 1: columns a, b, c; allowed are two columns"),
        ("y_mm,z_mm\n", r"p\.csv: no points"),
        ("_" * 5000 + "\n1,2", r"p\.csv, line 1: 500\d characters; at most 4096 are read"),
        ("\n".join(f"{5 * i},0" for i in range(15)), r"p\.csv: 15 different points; a profile needs at least 20"),
        ("\n".join(f"{0.01 * i},0" for i in range(99)), r"p\.csv: the profile is 0\.98 units wide, which is plausible"),
        ("y_m,z_m\n" + "\n".join(f"{0.03 * i},0" for i in range(99)), r"is 2940 mm wide; 20 mm to 200 mm are"),
        ("\n".join(f"{i},0" for i in range(99)), r"p\.csv: no flange and tread"),
    ],
)
def test_malformed_columns_are_refused(tmp_path, content, message):
    path = tmp_path / "p.csv"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(DataFileError, match=message):
        read_profile(path, kind="wheel")


def test_a_straight_line_is_no_rail(tmp_path):
    line = np.column_stack([np.linspace(-30.0, 30.0, 99), np.full(99, 4.0)])
    with pytest.raises(DataFileError, match=r"which side of the rail is up can't be told"):
        read_profile(write(tmp_path, line), kind="rail")


def test_a_whole_rail_is_refused():
    # Head, and back along the foot 100 mm below it.
    turns = np.linspace(0.0, 2.0 * np.pi, 200)[:-4]
    with pytest.raises(DataFileError, match=r"the points run round the rail; cut them to the head"):
        orient(36.0 * np.cos(turns), 50.0 * np.sin(turns), kind="rail")


def test_files_that_are_no_text(tmp_path):
    path = tmp_path / "p.csv"
    with pytest.raises(DataFileError, match=r"there is no such file"):
        read_profile(path, kind="rail")
    with pytest.raises(DataFileError, match=r"this is a folder"):
        read_profile(tmp_path, kind="rail")
    path.write_bytes("y,z\n1,2\n".encode("utf-16"))
    with pytest.raises(DataFileError, match=r"UTF-16; save it as UTF-8"):
        read_profile(path, kind="rail")
    path.write_bytes(bytes(range(256)))
    with pytest.raises(DataFileError, match=r"not a text file"):
        read_profile(path, kind="rail")
    path.write_bytes(b"\n" * 1_000_001)
    with pytest.raises(DataFileError, match=r"1000001 lines; a profile file has at most 1000000"):
        read_profile(path, kind="rail")
    with path.open("wb") as stream:
        stream.truncate(50_000_001)  # a hole: takes no room on the disk
    with pytest.raises(DataFileError, match=r"50 MB; a profile file has at most 50 MB"):
        read_profile(path, kind="rail")
    with pytest.raises(ParameterError, match=r'allowed: "wheel" or "rail"'):
        read_profile(path, kind="track")


def test_repeated_points_are_left_out_with_a_note(tmp_path):
    path = write(tmp_path, np.repeat(POINTS["wheel"], 2, axis=0))
    profile = read_profile(path, kind="wheel")
    np.testing.assert_allclose(profile.y, 1e-3 * POINTS["wheel"][:, 0], atol=1e-9)
    assert f"repeated points left out: {len(POINTS['wheel'])}" in profile.notes


def test_points_out_of_order_are_refused(tmp_path):
    rng = np.random.default_rng(5)
    with pytest.raises(DataFileError, match=r"must be in order along the profile"):
        read_profile(write(tmp_path, rng.permutation(POINTS["wheel"])), kind="wheel")
    back_and_forth = np.vstack([POINTS["wheel"], POINTS["wheel"][::-1]])
    with pytest.raises(DataFileError, match=r"line \d+: the profile comes back to where it was at line \d+"):
        read_profile(write(tmp_path, back_and_forth), kind="wheel")


@pytest.mark.parametrize(("height", "refused"), [(1.0, False), (6.0, True)])
def test_scatter_is_kept_and_an_outlier_refused(tmp_path, height, refused):
    points = POINTS["wheel"].copy()
    points[120, 1] += height
    path = write(tmp_path, points)
    if refused:
        with pytest.raises(DataFileError, match=r"line 121: the profile turns back after 6 mm; at most 2 mm"):
            read_profile(path, kind="wheel")
    else:
        assert read_profile(path, kind="wheel").z[120] == pytest.approx(1e-3 * points[120, 1])


def test_crossing_is_found_where_it_is(tmp_path):
    # A loop of 4 mm radius between points 100 and 101.
    points = POINTS["wheel"]
    turns = np.linspace(0.0, 2.0 * np.pi, 60)
    loop = points[100] + 4.0 * np.column_stack([np.sin(turns), np.cos(turns) - 1.0])
    with pytest.raises(DataFileError, match=r"line 15\d: the profile comes back to where it was at line (99|10\d)"):
        read_profile(write(tmp_path, np.vstack([points[:100], loop, points[101:]])), kind="wheel")


def test_order_along_the_face_is_kept(tmp_path):
    # Under the head the face of the rail runs back in y.
    points = POINTS["rail"].copy()
    points[:20, 0] += np.linspace(3.0, 0.0, 20)
    profile = read_profile(write(tmp_path, points), kind="rail")
    np.testing.assert_allclose(profile.y, 1e-3 * points[:, 0], atol=1e-9)
    assert np.any(np.diff(profile.y) < 0.0)
