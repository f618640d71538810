import numpy as np
import pytest

from wheelrail.excitation.named_spectra import named_spectra, named_spectrum
from wheelrail.excitation.sources import SpectrumLine
from wheelrail.excitation.synthesis import plan_harmonics, rail_repeat_length, synthesise


def band_levels(values, dx, wavelengths):
    """Levels by direct sums over harmonics, without the package's analysis."""
    count = values.shape[0]
    amplitude = 2.0 * np.abs(np.fft.rfft(values)) / count
    wavenumber = np.arange(amplitude.shape[0]) / (count * dx)
    levels = []
    for wavelength in wavelengths:
        inside = (wavenumber >= 10**-0.05 / wavelength) & (wavenumber < 10**0.05 / wavelength)
        levels.append(10.0 * np.log10(np.sum(amplitude[inside] ** 2) / 2.0 / 1e-12))
    return np.array(levels)


@pytest.mark.parametrize("name", named_spectra())
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("length", [20.0, 2.0 * np.pi * 0.46])
def test_realised_line_has_its_band_levels(name, seed, length):
    table = named_spectrum(name)
    line = SpectrumLine(
        wavelengths=table.wavelengths, levels=table.levels, length=length, seed=seed, dx=1e-3, on="rail", name=name
    )
    plan = plan_harmonics(wavelengths=table.wavelengths, levels=table.levels, count=line.count, dx=1e-3)
    values = line.realise(dx=1e-3, seed_override=None).values
    achieved = band_levels(values, 1e-3, table.wavelengths[plan.kept])
    np.testing.assert_allclose(achieved, table.levels[plan.kept], atol=1e-9)  # dB; achieved 3e-14
    # Nothing outside the kept bands: the total is the sum of the bands.
    total = np.sum(1e-12 * 10.0 ** (table.levels[plan.kept] / 10.0))
    assert np.mean(values**2) == pytest.approx(total, rel=1e-12)
    assert abs(np.mean(values)) < 1e-18


def test_bands_that_do_not_fit_are_reported():
    table = named_spectrum("cnossos-wheel-cast-iron-tread")
    count = round(2.0 * np.pi * 0.46 / 1e-3)
    plan = plan_harmonics(wavelengths=table.wavelengths, levels=table.levels, count=count, dx=1e-3)
    # 2 dx = 2 mm: the band at 2 mm (exact 1.995 mm) is cut, 2.5 mm (2.24 mm to 2.82 mm) is held.
    np.testing.assert_array_equal(plan.too_short, table.wavelengths < 2.3e-3)
    # Harmonics of a turn of 2890 mm: 2890, 1445, 963, 722.5, ... mm. None lies in 1778..2239 mm or 1122..1413 mm.
    np.testing.assert_allclose(table.wavelengths[plan.without_harmonic], [10**0.3, 10**0.1], rtol=1e-12)
    np.testing.assert_array_equal(plan.kept, ~(plan.too_short | plan.without_harmonic))


def test_a_band_must_lie_wholly_above_two_spacings():
    # dx = 1.2 mm: 2.4 mm lies inside the band of 2.5 mm (2.24 mm to 2.82 mm).
    wavelengths = np.array([10**-2.5, 10**-2.6])
    plan = plan_harmonics(wavelengths=wavelengths, levels=np.zeros(2), count=10_000, dx=1.2e-3)
    np.testing.assert_array_equal(plan.too_short, [False, True])


def test_spectral_density_has_no_steps_at_band_edges():
    # Levels rising by 1 dB a band (10 lg of the band ratio) are a constant density: equal amplitudes throughout.
    numbers = np.arange(0, 25)
    wavelengths = 10.0 ** (-numbers / 10.0)
    plan = plan_harmonics(wavelengths=wavelengths, levels=1.0 * numbers, count=100_000, dx=1e-3)
    used = plan.amplitudes[plan.amplitudes > 0.0]
    wide = used[-15_000:]  # bands of many harmonics; the others hold a whole number of harmonics only roughly
    assert np.max(wide) / np.min(wide) - 1.0 < 1e-3  # achieved 1.2e-4
    # A steep density is followed inside bands as well: ratio of neighbours stays small across edges.
    steep = plan_harmonics(wavelengths=wavelengths, levels=-2.0 * numbers, count=100_000, dx=1e-3)
    used = steep.amplitudes[steep.amplitudes > 0.0][-15_000:]
    assert np.max(np.abs(np.diff(np.log(used)))) < 1e-3  # achieved 2e-4; steps between bands would give 0.35


def test_heights_are_close_to_normally_distributed():
    table = named_spectrum("iso3095-2013-limit")
    count = 20_000
    plan = plan_harmonics(wavelengths=table.wavelengths, levels=table.levels, count=count, dx=1e-3)
    kurtosis = [
        np.mean(r**4) / np.mean(r**2) ** 2 for r in (synthesise(plan, count=count, entropy=[s]) for s in range(20))
    ]
    assert np.mean(kurtosis) == pytest.approx(3.0, abs=0.2)  # a sinusoid has 1.5; achieved 2.99


def test_repeat_length():
    assert rail_repeat_length(np.array([0.4, 0.1])) == 20.0
    assert rail_repeat_length(np.array([4.0, 0.1])) == 40.0


def test_no_band_fits():
    with pytest.raises(ValueError, match="no band"):
        plan_harmonics(wavelengths=np.array([1e-3]), levels=np.array([0.0]), count=1000, dx=1e-3)
