import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.named_spectra import named_spectra, named_spectrum, read_spectrum


def level(name, wavelength_mm):
    table = named_spectrum(name)
    nearest = int(np.argmin(np.abs(np.log(table.wavelengths / (wavelength_mm * 1e-3)))))
    assert table.wavelengths[nearest] == pytest.approx(wavelength_mm * 1e-3, rel=0.02)
    return table.levels[nearest]


def test_unknown_name_lists_the_known_ones():
    with pytest.raises(ParameterError, match=r"iso3095-2013-limit, .*cnossos-wheel-disc-brake"):
        named_spectrum("iso")


@pytest.mark.parametrize("name", named_spectra())
def test_tables_are_complete_and_read_only(name):
    table = named_spectrum(name)
    assert np.all(np.diff(np.log10(table.wavelengths)) == pytest.approx(-0.1))
    assert np.all(np.isfinite(table.levels))
    assert table.surface in name or table.surface == "rail"
    assert "2013" in table.source or "2015/996" in table.source
    with pytest.raises(ValueError, match="read-only"):
        table.levels[0] = 0.0


def user_file(folder, *lines):
    path = folder / "spectrum.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "lines",
    [
        ("wavelength_mm, level_dB", "50,-1", "100,3", "12.5,-9"),
        ("# c", "wavelength [m];L (dB)", "0.1;3", "0.05;-1", "0.0125;-9"),
        ("lambda_m\tL_dB", "0.1\t3", "0.0501187\t-1", "0.0125893\t-9"),
    ],
)
def test_user_spectrum(tmp_path, lines):
    table = read_spectrum(user_file(tmp_path, *lines))
    np.testing.assert_allclose(table.wavelengths, [0.1, 10**-1.3, 10**-1.9], rtol=1e-12)
    np.testing.assert_array_equal(table.levels, [3.0, -1.0, -9.0])


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (("wavelength_mm,level_dB",), "no rows"),
        (("wavelength_mm,level_um", "100,3"), "'um'; allowed: db"),
        (("wavelength,level_dB", "100,3"), "'wavelength' names no unit"),
        (("wavelength_mm,level_dB,extra_dB", "100,3,4"), "3 columns"),
        (("wavelength_mm,level_dB", "100,3", "0,3"), "line 3: wavelength 0 mm; allowed: above 0"),
        (("wavelength_mm,level_dB", "112,3"), "line 2: wavelength 112 mm is not the centre"),
        (("wavelength_mm,level_dB", "100,3", "99,4"), "line 3: the band of wavelength 99 mm appears twice"),
        (("wavelength_mm,level_dB", "100,300"), "line 2: level 300 dB re 1 um; allowed: -120 dB to 80 dB"),
        (("wavelength_mm,level_dB", "100,nan"), "line 2: 'nan' is not allowed"),
    ],
)
def test_faults_of_a_user_spectrum(tmp_path, lines, message):
    with pytest.raises(DataFileError, match=message):
        read_spectrum(user_file(tmp_path, *lines))
