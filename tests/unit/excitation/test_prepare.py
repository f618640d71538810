import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.prepare import prepare_source
from wheelrail.excitation.sources import Line, Sinusoid, SpectrumLine
from wheelrail.excitation.view import ContactView

COMMON = {"dx": 1e-3, "wheel_radius": 0.46, "view": ContactView(radius=0.46, stretch=1.0, trajectory=False)}


def test_sinusoid():
    source, notes = prepare_source(type="sinusoid", amplitude=1e-5, wavelength=0.05, **COMMON)
    assert isinstance(source, Sinusoid)
    assert (source.amplitude, source.wavelength, notes) == (1e-5, 0.05, [])


def test_measured(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("x_m,r_um\n" + "\n".join(f"{i / 1000},{i % 7}" for i in range(50)))
    source, _ = prepare_source(type="measured", file=path, on="rail", beyond_end="stop", column=None, **COMMON)
    assert isinstance(source, Line)
    np.testing.assert_allclose(source.values, (np.arange(50) % 7) * 1e-6, rtol=1e-12)


def test_spectrum_on_rail_and_wheel():
    source, notes = prepare_source(
        type="spectrum", name="cnossos-rail-average-network", on="rail", seed=1, length=None, **COMMON
    )
    assert isinstance(source, SpectrumLine)
    assert source.count == 20_000
    assert any("repeats every 20 m" in note for note in notes)
    assert any("left out" in note and "1.995, 1.585, 1.259, 1, 0.7943" in note for note in notes)
    source, notes = prepare_source(type="spectrum", name="iso3095-2013-limit", on="wheel", seed=1, **COMMON)
    assert isinstance(source, SpectrumLine)
    assert source.count == round(2.0 * np.pi * 0.46 / 1e-3) == 2890
    assert any("2890 steps, -0.265 mm a turn" in note for note in notes)
    assert any("spectrum of the rail is used on the wheel" in note for note in notes)
    assert any("not extrapolated" in note for note in notes)


def test_spectrum_from_a_file(tmp_path):
    path = tmp_path / "s.csv"
    path.write_text("wavelength_mm,level_dB\n100,3\n50,0\n")
    source, _ = prepare_source(type="spectrum", file=path, on="rail", seed=1, length=5.0, **COMMON)
    line = source.realise(dx=1e-3, seed_override=None)
    assert isinstance(line, Line)
    assert line.values.shape == (5000,)
    assert np.mean(line.values**2) == pytest.approx((10**0.3 + 1.0) * 1e-12, rel=1e-12)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"type": "noise"}, "type = 'noise'.*sinusoid, measured, spectrum"),
        ({"type": "sinusoid", "amplitude": 1e-5}, "wavelength"),
        ({"type": "sinusoid", "amplitude": 1e-5, "wavelength": 1e-3}, "longer than 2 dx"),
        ({"type": "sinusoid", "amplitude": 1e-5, "wavelength": 0.1, "seed": 1}, "seed"),
        ({"type": "spectrum", "on": "rail", "seed": 1}, "either a name or a file"),
        ({"type": "spectrum", "name": "x", "on": "rail", "seed": 1}, "known spectra"),
        ({"type": "spectrum", "name": "iso3095-2013-limit", "on": "rail", "seed": -1}, "whole number"),
        ({"type": "spectrum", "name": "iso3095-2013-limit", "on": "rail", "seed": 1.5}, "whole number"),
        ({"type": "spectrum", "name": "iso3095-2013-limit", "on": "track", "seed": 1}, "wheel"),
        ({"type": "spectrum", "name": "iso3095-2013-limit", "on": "wheel", "seed": 1, "length": 9.0}, "every turn"),
        ({"type": "spectrum", "name": "iso3095-2013-limit", "on": "rail", "seed": 1, "length": 1e9}, "between"),
    ],
)
def test_wrong_entries(keys, message):
    with pytest.raises(ParameterError, match=message):
        prepare_source(**COMMON, **keys)


def test_spectrum_wholly_below_the_grid(tmp_path):
    path = tmp_path / "s.csv"
    path.write_text("wavelength_mm,level_dB\n1,3\n")
    with pytest.raises(DataFileError, match="no band fits"):
        prepare_source(type="spectrum", file=path, on="rail", seed=1, **COMMON)
