import numpy as np
import pytest

from wheelrail.analysis.third_octave import roughness_third_octave, third_octave

FS = 20_000.0


def noise(count=200_000, seed=1):
    return np.random.default_rng(seed).standard_normal(count)


@pytest.mark.parametrize("window", ["hann", "boxcar"])
@pytest.mark.parametrize("segment", [None, 4096, 4095])
@pytest.mark.parametrize("share_lines", [True, False])
def test_no_power_is_lost_or_counted_twice(window, segment, share_lines):
    spectrum = third_octave(
        noise(30_001), spacing=1 / FS, window=window, segment=segment, share_lines=share_lines, lowest=40, highest=3000
    )
    assert spectrum.below > 0.0
    assert spectrum.above > 0.0
    total = spectrum.below + np.sum(spectrum.mean_square) + spectrum.above
    assert total == pytest.approx(spectrum.total, rel=1e-12)


@pytest.mark.parametrize("count", [10_000, 10_001])
def test_total_is_the_variance(count):
    signal = noise(count) + 5.0
    spectrum = third_octave(signal, spacing=1 / FS, window="boxcar")
    assert spectrum.total == pytest.approx(np.var(signal), rel=1e-12)


def test_pure_tone_lands_in_its_band_with_half_the_square_of_its_amplitude():
    t = np.arange(20_000) / FS
    for centre in (125.89254, 1000.0, 3162.2777):
        tone = 3.0 * np.sin(2 * np.pi * centre * t + 0.4) + 7.0
        for window, tolerance in (("hann", 1e-6), ("boxcar", 0.005)):  # achieved 5e-9, 1.5e-3 (leakage)
            spectrum = third_octave(tone, spacing=1 / FS, window=window)
            band = int(np.argmin(np.abs(np.log(spectrum.centres / centre))))
            assert spectrum.centres[band] == pytest.approx(centre, rel=1e-6)
            assert spectrum.mean_square[band] == pytest.approx(4.5, rel=tolerance)
            assert np.sum(np.delete(spectrum.mean_square, band)) < tolerance * 4.5
            assert spectrum.rms[band] == pytest.approx(3.0 / np.sqrt(2.0), rel=tolerance)
            assert spectrum.level(reference=1.0)[band] == pytest.approx(10 * np.log10(4.5), abs=0.1)


def test_white_noise_rises_by_one_decibel_a_band():
    spectrum = third_octave(noise(1_000_000), spacing=1 / FS, segment=8192, lowest=100)
    levels = spectrum.level(reference=1.0)
    slope = np.polyfit(10.0 * np.log10(spectrum.centres), levels, 1)[0]
    assert slope == pytest.approx(1.0, abs=0.01)  # dB per band, 3.01 dB per octave; achieved 1.001
    # Density 2/fs: band mean square = 0.2308 fc 2/fs.
    np.testing.assert_allclose(spectrum.mean_square, 0.2307676 * spectrum.centres * 2 / FS, rtol=0.05)  # achieved 0.022


def test_lines_at_band_edges_are_shared():
    # Flat line spectrum of an impulse: band powers are proportional to bandwidth to rounding, however few lines.
    impulse = np.zeros(2000)
    impulse[700] = 1.0
    spectrum = third_octave(impulse, spacing=1 / FS, window="boxcar", lowest=20.0)
    assert spectrum.lines_per_band[0] < 1.0
    ratio = spectrum.mean_square / (0.2307676 * spectrum.centres)
    np.testing.assert_allclose(ratio, ratio[-1], rtol=1e-12)  # achieved 3e-14


def test_a_line_across_an_edge_is_split():
    # Line of 112 Hz, 1 Hz wide, edge of the bands of 100 Hz and 125 Hz at 10^2.05 = 112.2018 Hz.
    t = np.arange(20_000) / FS
    spectrum = third_octave(np.sqrt(2.0) * np.sin(2 * np.pi * 112 * t), spacing=1 / FS, window="boxcar")
    bands = [int(np.argmin(np.abs(spectrum.centres - centre))) for centre in (100.0, 125.9)]
    np.testing.assert_allclose(spectrum.mean_square[bands], [0.701845, 0.298155], atol=1e-6)
    unsplit = third_octave(
        np.sqrt(2.0) * np.sin(2 * np.pi * 112 * t), spacing=1 / FS, window="boxcar", share_lines=False
    )
    bands = [int(np.argmin(np.abs(unsplit.centres - centre))) for centre in (100.0, 125.9)]
    np.testing.assert_allclose(unsplit.mean_square[bands], [1.0, 0.0], atol=1e-12)


def test_default_range_is_what_the_record_resolves():
    spectrum = third_octave(noise(20_000), spacing=1 / FS)
    assert spectrum.lines_per_band[0] >= 1.5
    assert spectrum.lines_per_band[0] < 1.5 * 1.26
    assert spectrum.centres[-1] == pytest.approx(7943.28, rel=1e-5)  # the next band ends at 11220 Hz, above fs/2


def test_roughness_is_given_by_wavelength():
    x = np.arange(20_000) * 1e-3
    r = 10e-6 * np.sin(2 * np.pi * x / 0.05)
    for periodic in (True, False):
        spectrum = roughness_third_octave(r, spacing=1e-3, periodic=periodic)
        band = int(np.argmax(spectrum.mean_square))
        assert spectrum.wavelengths[band] == pytest.approx(0.0501187, rel=1e-5)
        # 10 um amplitude: 50 um^2, 16.99 dB re 1 um.
        assert spectrum.level(reference=1e-6)[band] == pytest.approx(16.99, abs=0.01)


@pytest.mark.parametrize(
    ("signal", "keys"),
    [
        (np.zeros(10), {}),
        (np.zeros((4, 20)), {}),
        (np.full(100, np.nan), {}),
        (np.zeros(100), {"spacing": 0.0}),
        (np.zeros(100), {"window": "flat"}),
        (np.zeros(100), {"segment": 200}),
        (np.zeros(100), {"lowest": -1.0}),
    ],
)
def test_wrong_arguments(signal, keys):
    with pytest.raises(ValueError, match=r"must|allowed"):
        third_octave(signal, **({"spacing": 1e-3} | keys))
