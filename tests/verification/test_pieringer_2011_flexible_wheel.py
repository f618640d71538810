"""The flexible wheel of Pieringer (2011), section 3.2.2, with the synthetic section in place of the C20 wheel's."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic_wheel import synthetic_wheel

from wheelrail.wheel.modes import FlexibleWheel, rigid_modes
from wheelrail.wheel.tuning import tune_two_dof

WHEELSET = {"mass": 341.5, "suspension_stiffness": 1.12e6, "suspension_damping": 13.2e3}


def wheel(contact_position: float) -> FlexibleWheel:
    modes = synthetic_wheel().at(contact_position=contact_position, damping="thesis")
    return FlexibleWheel(modes, rigid_modes(**WHEELSET))


def test_modes_of_the_squeal_runs():
    """(7,0,a) and (2,c), printed near 5.2 kHz; the scan leaves 52x6 and 5228 Hz."""
    frequency = {mode.name: mode.frequency for mode in synthetic_wheel().modes}
    assert frequency["7,0,a"] == pytest.approx(5296.0, rel=2e-3)  # as computed; 5246 +- 50 in the thesis
    assert frequency["2,c"] == pytest.approx(5228.0, rel=0.015)  # achieved: 1.0 %


def test_modal_damping():
    """Eq. 3.9."""
    ratios = {mode.name: mode.damping_ratio for mode in wheel(0.0).modes}
    for name, expected in {"0,0,a": 1e-3, "0,c": 1e-3, "1,0,a": 1e-2, "1,c*": 1e-2, "1,r": 1.0, "1,r*": 1.0}.items():
        assert ratios[name] == pytest.approx(expected, rel=1e-12)
    assert {round(ratio, 12) for name, ratio in ratios.items() if int(name[0]) >= 2} == {1e-4}


def test_two_masses_tuned_to_the_flexible_wheel():
    """Fig. 3.13: at the tread centre the thesis arrives at 6.0 GN/m and 155 kN s/m."""
    fit = tune_two_dof(wheel(0.0), **WHEELSET, contact_mass=3.0)
    assert fit.contact_stiffness == pytest.approx(6.0e9, rel=0.1)  # achieved: 5.59e9, another wheel
    assert fit.contact_damping == pytest.approx(155e3, rel=0.05)  # achieved: 156e3
    # The anti-resonance near 650 Hz.
    frequency = np.geomspace(500.0, 900.0, 2000)
    lowest = [
        frequency[np.argmin(np.abs(level))]
        for level in (wheel(0.0).receptance(frequency)[:, 2, 2], fit.wheel.receptance(frequency))
    ]
    assert lowest[0] == pytest.approx(670.0, rel=5e-3)
    assert lowest[1] == pytest.approx(lowest[0], rel=0.04)  # achieved: 3.6 %, 646.5 Hz
    # Below it both are the same body.
    low = np.geomspace(10.0, 250.0, 200)
    ratio = np.abs(wheel(0.0).receptance(low)[:, 2, 2] / fit.wheel.receptance(low))
    np.testing.assert_allclose(20.0 * np.log10(ratio), 0.0, atol=1.0)  # achieved: 0.43


def test_fit_beside_the_tread_centre():
    """Fig. 3.14: lateral and vertical motion are coupled there, which two masses can't follow."""
    centre, beside = (tune_two_dof(wheel(position), **WHEELSET, contact_mass=3.0) for position in (0.0, 0.02))
    assert beside.deviation > 1.15 * centre.deviation  # achieved: 7.8 and 6.6 dB


def test_coupling_grows_away_from_the_tread_centre():
    frequency = np.geomspace(100.0, 7000.0, 500)

    def coupling(position: float) -> float:
        values = np.abs(wheel(position).receptance(frequency))
        return float(np.exp(np.mean(np.log(values[:, 1, 2] / np.sqrt(values[:, 1, 1] * values[:, 2, 2])))))

    assert coupling(0.0) < coupling(0.01) < coupling(0.02) < coupling(0.04)  # 0.12, 0.24, 0.35, 0.51


def test_reciprocity_and_passivity():
    """The velocity under a force can't give energy: the Hermitian part of its matrix has no negative eigenvalue."""
    rigid = rigid_modes(
        **WHEELSET,
        lateral_mass=341.5,
        lateral_stiffness=5e6,
        lateral_damping=20e3,
        roll_inertia=200.0,
        roll_stiffness=1e6,
        roll_damping=5e3,
        roll_arm_y=0.75,
        roll_arm_z=0.39,
    )
    frequency = np.geomspace(1.0, 20e3, 5000)
    for position in (-0.03, 0.0, 0.04):
        full = FlexibleWheel(synthetic_wheel().at(contact_position=position, damping="thesis"), rigid)
        receptance = full.receptance(frequency)
        np.testing.assert_allclose(receptance, receptance.swapaxes(1, 2), rtol=1e-12, atol=0.0)
        mobility = 2j * np.pi * frequency[:, None, None] * receptance
        hermitian = 0.5 * (mobility + mobility.conj().swapaxes(1, 2))
        eigenvalues = np.linalg.eigvalsh(hermitian)
        assert np.all(eigenvalues > -1e-12 * eigenvalues.max(axis=1, keepdims=True))
        # Turned round, every mode would feed energy in.
        assert np.all(np.linalg.eigvalsh(-hermitian).min(axis=1) < 0.0)
