"""Files of the MiniProf instrument: published samples of several software versions, and faults in them."""

from pathlib import Path

import numpy as np
import pytest

from wheelrail.errors import DataFileError
from wheelrail.profile.reading import read_profile

DATA = Path(__file__).parents[2] / "data" / "profiles"
RAIL = (DATA / "rail_60e1_canted.ban").read_text(encoding="utf-8")


def rail(folder, old="", new="", text=RAIL):
    path = folder / "rail.ban"
    assert old in text
    path.write_text(text.replace(old, new, 1) if old else text, encoding="utf-8")
    return path


def test_old_header_in_plain_words():
    profile = read_profile(DATA / "wheel_worn_old_header.whl", kind="wheel")
    # As the published file prints it: the tip of the flange, and the tread 70 mm from the back of the flange.
    assert np.max(profile.z) == pytest.approx(27.8119e-3)
    assert np.interp(70e-3, profile.y[40:], profile.z[40:]) == pytest.approx(0.1e-3, abs=0.05e-3)
    assert profile.y[0] == pytest.approx(-0.0986e-3)
    # Two strokes overlap at the tip.
    assert any("steps back along the profile: 2" in note for note in profile.notes)
    assert np.any(np.diff(profile.y) < -0.5e-3)


def test_header_without_an_empty_line_and_a_gap_of_the_instrument():
    profile = read_profile(DATA / "rail_roller.ban", kind="rail")
    assert len(profile.y) == 66
    assert np.ptp(profile.y) == pytest.approx(73.9564e-3)
    assert profile.z[0] == pytest.approx(31.1753e-3)
    assert "the header announces 345 points, 66 are there" in profile.notes
    assert any(note.startswith("gaps between points: 1, up to 12.6 mm") for note in profile.notes)


def test_commented_points_count_as_announced():
    notes = read_profile(DATA / "rail_60e1_canted.ban", kind="rail").notes
    assert "points commented out in the file: 1" in notes
    assert not any("announces" in note for note in notes)


def test_columns_and_offsets(tmp_path):
    plain = read_profile(rail(tmp_path), kind="rail")
    header, _, rows = RAIL.partition("\n\n")
    points = [row.split() for row in rows.splitlines() if not row.startswith('"')]
    header = header.replace("ColumnDef=X,Y", "ColumnDef=A,Y,N,X").replace("XOffset=0.0000", "XOffset=2.5")
    text = header + "\n\n" + "\n".join(f"nan {b} 1 {a}" for a, b in points)
    profile = read_profile(rail(tmp_path, text=text), kind="rail")
    np.testing.assert_allclose(profile.y, plain.y + 2.5e-3, atol=1e-15)
    np.testing.assert_array_equal(profile.z, plain.z)
    assert "XOffset of 2.5 mm added" in profile.notes


def test_without_column_definition_the_first_two_count(tmp_path):
    text = RAIL.replace("ColumnDef=X,Y\n", "")
    plain = read_profile(DATA / "rail_60e1_canted.ban", kind="rail")
    np.testing.assert_array_equal(read_profile(rail(tmp_path, text=text), kind="rail").y, plain.y)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ColumnDef=X,Y", "ColumnDef=X,X", r"rail\.ban, line \d+: ColumnDef='X,X'; it must name X and Y, each once"),
        ("ColumnDef=X,Y", "ColumnDef=X,Y,A", r"rail\.ban, line 14: 2 values; a point has 3 in this file"),
        ("XOffset=0.0000", "XOffset=west", r"line \d+, XOffset: 'west' is not a finite number"),
        ("XYPoints=", "XYPoints=?", r"XYPoints: '\?88' is not a finite number"),
        ("4.3618505E+01\t3.5050696E+01", "43.618505\t?", r"line \d+: '\?' is not a finite number"),
        ("4.3618505E+01\t3.5050696E+01", "43,618505\t35,050696", r"decimal commas are not read"),
        ("4.3618505E+01\t3.5050696E+01", "Tilt=3", r"line \d+: 'Tilt=3' among the points"),
        ("4.3618505E+01\t3.5050696E+01", "43.618505", r"line \d+: 1 values; a point has 2 in this file"),
        ("Filename=rail.ban", "[FileInfo]", r"line 3: a MiniProf file of several parts"),
    ],
)
def test_faults_are_named(tmp_path, old, new, message):
    with pytest.raises(DataFileError, match=message):
        read_profile(rail(tmp_path, old, new), kind="rail")


def test_a_rail_file_is_no_wheel(tmp_path):
    with pytest.raises(DataFileError, match=r"the file holds the profile of a rail; a wheel is asked for"):
        read_profile(rail(tmp_path), kind="wheel")
