"""Coherence of parallel lines: known pairs, and what averaging few pieces does."""

import numpy as np
import pytest

from wheelrail.analysis.coherence import BandCoherence, coherence_in_contact, roughness_coherence

DX = 1e-3


@pytest.mark.parametrize("keys", [{"periodic": True}, {"segment": 1000}, {}])
def test_lines_that_are_the_same_but_for_a_factor_and_a_shift(keys):
    line = np.random.default_rng(1).standard_normal(20_000)
    bands = roughness_coherence(np.array([line, -3.0 * line + 7.0, line + 0.1]), spacing=DX, **keys)
    np.testing.assert_allclose(bands.coherence, 1.0, atol=1e-12)  # achieved 1e-15


@pytest.mark.parametrize("keys", [{"periodic": True}, {"segment": 500}])
@pytest.mark.parametrize("noise", [0.3, 1.0, 3.0])
def test_a_common_part_with_noise_on_each_line(keys, noise):
    # gamma^2 = 1 / (1 + noise^2)^2 for independent noise on both lines.
    generator = np.random.default_rng(4)
    common = generator.standard_normal(200_000)
    lines = common + noise * generator.standard_normal((2, 200_000))
    bands = roughness_coherence(lines, spacing=DX, **keys)
    expected = 1.0 / (1.0 + noise**2) ** 2
    wide = bands.averages > 300.0
    assert np.sum(wide) >= 10
    scatter = np.sqrt(2.0 * expected / bands.averages) * (1.0 - expected)
    deviation = (bands.coherence[:, 0, 1] - expected) / scatter
    assert np.max(np.abs(deviation[wide])) < 4.0  # achieved 2.1


@pytest.mark.parametrize("keys", [{"periodic": True}, {"segment": 500}])
def test_uncorrelated_lines_come_out_at_one_over_the_averages(keys):
    lines = np.random.default_rng(6).standard_normal((30, 20_000))
    bands = roughness_coherence(lines, spacing=DX, **keys)
    pairs = np.triu_indices(30, k=1)
    mean = np.mean(bands.coherence[:, pairs[0], pairs[1]], axis=1)
    # 435 pairs to a band.
    np.testing.assert_allclose(mean * bands.averages, 1.0, atol=0.2)  # achieved 0.13


def test_waves_in_one_band_only():
    x = np.arange(10_000) * DX
    # 20 mm in common, 5 mm on one line with nothing on the other.
    common = np.sin(2.0 * np.pi * x / 0.02)
    lines = np.array([common + np.sin(2.0 * np.pi * x / 0.005), common])
    noise = 1e-3 * np.random.default_rng(2).standard_normal(lines.shape)
    bands = roughness_coherence(lines + noise, spacing=DX, periodic=True)
    at = {round(-10.0 * np.log10(w)): c[0, 1] for w, c in zip(bands.wavelengths, bands.coherence, strict=True)}
    assert at[round(-10.0 * np.log10(0.02))] > 0.999
    assert at[round(-10.0 * np.log10(0.005))] < 0.01


def test_bands_that_hold_too_little_are_left_out():
    bands = roughness_coherence(np.random.default_rng(1).standard_normal((2, 2000)), spacing=DX, periodic=True)
    assert bands.averages[0] >= 2.0
    assert bands.averages[0] < 3.0
    assert bands.bias.shape == bands.coherence.shape
    np.testing.assert_allclose(np.diagonal(bands.coherence, axis1=1, axis2=2), 1.0, rtol=1e-14)
    # A line without anything in it has no coherence.
    empty = roughness_coherence(np.array([np.zeros(2000), np.arange(2000) % 7]), spacing=DX, periodic=True)
    assert np.all(np.isnan(empty.coherence[:, 0, 1]))


def test_mean_over_pairs_within_the_contact():
    coherence = np.array([[[1.0, 0.9, 0.1], [0.9, 1.0, 0.5], [0.1, 0.5, 1.0]]])
    bands = BandCoherence(np.array([100.0]), coherence, np.array([50.0]))
    lateral = np.array([-4e-3, 0.0, 4e-3])
    assert coherence_in_contact(bands, lateral=lateral, centre=0.0, width=8e-3) == pytest.approx([0.5])
    assert coherence_in_contact(bands, lateral=lateral, centre=2e-3, width=6e-3) == pytest.approx([0.5])
    assert coherence_in_contact(bands, lateral=lateral, centre=-2e-3, width=6e-3) == pytest.approx([0.9])
    with pytest.raises(ValueError, match="1 lines lie within the contact"):
        coherence_in_contact(bands, lateral=lateral, centre=0.0, width=6e-3)
    with pytest.raises(ValueError, match="2 positions for 3 lines"):
        coherence_in_contact(bands, lateral=lateral[:2], centre=0.0, width=8e-3)


@pytest.mark.parametrize(
    ("heights", "keys", "message"),
    [
        (np.zeros(100), {}, "shape"),
        (np.zeros((2, 10)), {}, "at least 16"),
        (np.full((2, 100), np.inf), {}, "finite"),
        (np.zeros((2, 100)), {"spacing": 0.0}, "spacing"),
        (np.zeros((2, 100)), {"segment": 200}, "segment"),
        (np.zeros((2, 100)), {"segment": 50, "periodic": True}, "whole"),
    ],
)
def test_refusals(heights, keys, message):
    with pytest.raises(ValueError, match=message):
        roughness_coherence(heights, **({"spacing": DX} | keys))
