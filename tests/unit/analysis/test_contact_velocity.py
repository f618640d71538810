"""Velocities from displacements: exact derivatives, levels."""

import math

import numpy as np
import pytest

from wheelrail.analysis.contact_velocity import contact_velocities, velocity
from wheelrail.errors import ParameterError

DT = 1e-4


@pytest.mark.parametrize("frequency", [3.3, 50.0, 801.0, 2500.0, 4000.0])
def test_derivative_of_a_sinusoid(frequency):
    t = DT * np.arange(4000)
    omega = 2.0 * np.pi * frequency
    found = velocity(np.sin(omega * t + 0.4), dt=DT)
    exact = omega * np.cos(omega * (t[:-1] + 0.5 * DT) + 0.4)
    middle = slice(200, -200)
    # Achieved: 1e-11 at 3 Hz to 1.3e-7 at 4 kHz; plain differences lack 24 % there.
    assert np.abs(found - exact)[middle].max() < 1e-6 * omega


def test_a_trend_is_a_mean_velocity():
    found = velocity(3.0 + 0.2 * DT * np.arange(1000), dt=DT)
    np.testing.assert_allclose(found, 0.2, rtol=1e-9)


def test_level_of_a_sinusoid():
    # 1 um at 1 kHz: v_rms = 2 pi 1e-3 / sqrt 2 m/s.
    t = DT * np.arange(10000)
    found = contact_velocities({"wheel_disp_z": 1e-6 * np.sin(2.0 * np.pi * 1000.0 * t)}, dt=DT, transient=0.0)
    levels = found.levels("wheel_disp_z")
    band = np.argmin(np.abs(found.centres - 1000.0))
    expected = 20.0 * math.log10(2.0 * math.pi * 1e-3 / math.sqrt(2.0) / 1e-9)
    assert levels[band] == pytest.approx(expected, abs=1e-3)
    np.testing.assert_allclose(found.levels("wheel_disp_z", reference=5e-8), levels - 20.0 * math.log10(50.0))


def test_a_jump_at_the_start_is_left_out():
    t = DT * np.arange(10000)
    steady = 1e-6 * np.sin(2.0 * np.pi * 200.0 * t)
    started = steady + np.where(t < 0.1, 1e-3, 0.0)
    one, two = (contact_velocities({"a": values}, dt=DT, transient=0.2) for values in (steady, started))
    np.testing.assert_array_equal(one.mean_squares["a"], two.mean_squares["a"])


def test_refused():
    with pytest.raises(ValueError, match="16 samples"):
        velocity(np.zeros(10), dt=DT)
    with pytest.raises(ParameterError, match="dt"):
        velocity(np.zeros(100), dt=0.0)
    for changes in ({"transient": -1.0}, {"transient": 0.0099}):
        with pytest.raises(ParameterError, match="transient"):
            contact_velocities({"a": np.zeros(100)}, dt=DT, **changes)
    with pytest.raises(ParameterError, match="displacements"):
        contact_velocities({}, dt=DT, transient=0.0)
