"""The command ``wheelrail profiles``."""

import csv
from pathlib import Path

import numpy as np
import pytest

from wheelrail.cli import main

CASE = Path(__file__).parents[2] / "examples" / "cases" / "profiles.toml"


def test_table_and_figures(tmp_path, capsys):
    assert main(["profiles", str(CASE), "--output", str(tmp_path), "--largest", "5e-3"]) == 0
    out = capsys.readouterr().out
    assert "wheel s1002 on rail 60e1" in out
    assert "lateral_shift of a centred wheelset   -3.03 mm" in out
    with (tmp_path / "profiles_wheelset.csv").open() as stream:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(stream)]
    lateral = np.array([row["lateral_mm"] for row in rows])
    np.testing.assert_allclose(lateral, np.arange(-5.0, 5.1, 0.5))
    difference = np.array([row["radius_difference_mm"] for row in rows])
    np.testing.assert_allclose(difference, -difference[::-1], atol=1e-6)  # wheels and rails are mirror images
    assert np.all(np.diff(difference) > 0.0)
    right, left = (np.array([row[f"wheel_{side}_mm"] for row in rows]) for side in ("right", "left"))
    np.testing.assert_allclose(right, left[::-1], atol=1e-4)
    for name in ("profiles_profiles.png", "profiles_contact.png"):
        assert (tmp_path / name).stat().st_size > 10_000
        assert str(tmp_path / name) in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([str(CASE.parent / "smooth.toml")], "the case has no profiles"),
        ([str(CASE), "--gauge", "1435"], "--gauge = 1435.0 is refused: must be 0.5 to 2 m"),
        ([str(CASE), "--gauge", "1.2"], "touch"),
        ([str(CASE), "--output", "nowhere"], "no such folder"),
    ],
)
def test_mistakes(arguments, message, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["profiles", *arguments]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert message in error
