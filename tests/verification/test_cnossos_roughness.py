"""Directive (EU) 2015/996, appendix G, table G-1, as amended by Delegated Directive (EU) 2021/1226."""

import numpy as np
import pytest

from wheelrail.excitation.named_spectra import named_spectrum

# Printed levels at some wavelengths (mm), dB re 1 um.
PRINTED = {
    "cnossos-rail-average-network": {2000: 35.0, 1000: 25.0, 400: 13.5, 100: 3.5, 50: -0.2, 25: -3.0, 0.8: -19.0},
    "cnossos-wheel-cast-iron-tread": {2000: 2.17, 160: 2.37, 125: 0.61, 50: 11.11, 31.5: 9.79, 6.3: -1.17, 1: 3.1},
    "cnossos-wheel-composite-block": {1000: -3.95, 80: -4.34, 20: -7.24, 10: -7.14, 3.15: -2.38, 0.8: -2.46},
    "cnossos-wheel-disc-brake": {315: -5.93, 250: 2.32, 200: 2.82, 63: -0.25, 20: -8.58, 4: -10.91, 2: -9.52},
    "cnossos-rail-iso3095-2013": {2000: 17.1, 400: 17.1, 100: 4.9, 3.15: -11.0, 2.5: -11.6, 1: -14.0, 0.8: -14.0},
}  # fmt: skip


@pytest.mark.parametrize("name", PRINTED)
def test_printed_levels(name):
    table = named_spectrum(name)
    assert table.levels.shape == (35,)
    numbers = np.rint(10 * np.log10(table.wavelengths * 1e3)).astype(int)
    assert (numbers[0], numbers[-1]) == (33, -1)  # 2000 mm to 0.8 mm
    for wavelength, printed in PRINTED[name].items():
        assert table.levels[numbers == round(10 * np.log10(wavelength))] == [printed]


def test_wheel_levels_round_to_those_printed_in_2015():
    # Directive (EU) 2015/996 before the amendment prints one decimal; 1000 mm, 250 mm, 50 mm, 25 mm and 4 mm.
    rounded = {
        "cnossos-wheel-cast-iron-tread": [2.2, 2.2, 11.1, 7.5, 0.3],
        "cnossos-wheel-composite-block": [-4.0, -4.0, -4.9, -6.8, -3.7],
        "cnossos-wheel-disc-brake": [-5.9, 2.3, -1.6, -7.0, -10.9],
    }
    for name, printed in rounded.items():
        table = named_spectrum(name)
        numbers = np.rint(10 * np.log10(table.wavelengths * 1e3))
        held = [table.levels[numbers == n][0] for n in (30, 24, 17, 14, 6)]
        np.testing.assert_allclose(held, printed, atol=0.0501)


def test_the_directive_repeats_the_iso_limit_within_its_range():
    iso, directive = named_spectrum("iso3095-2013-limit"), named_spectrum("cnossos-rail-iso3095-2013")
    inside = (directive.wavelengths < 0.45) & (directive.wavelengths > 3e-3)
    np.testing.assert_allclose(directive.wavelengths[inside], iso.wavelengths, rtol=1e-12)
    np.testing.assert_array_equal(directive.levels[inside], iso.levels)
