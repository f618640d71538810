"""A rigid wheel of two masses tuned to the vertical receptance of a flexible one (Pieringer 2011, Fig. 3.13)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .modes import FlexibleWheel
from .rigid import RigidWheel

__all__ = ["TwoDofFit", "tune_two_dof"]

_POINTS = 2000


@dataclass(frozen=True)
class TwoDofFit:
    """Result of `tune_two_dof`.

    Parameters
    ----------
    wheel : RigidWheel
    contact_stiffness : float
        k_W in N/m.
    contact_damping : float
        c_W in N s/m.
    deviation : float
        Root mean square difference of the receptances' levels in dB, over the logarithm of the frequency.
    """

    wheel: RigidWheel
    contact_stiffness: float
    contact_damping: float
    deviation: float


def tune_two_dof(
    flexible: FlexibleWheel,
    *,
    mass: float,
    suspension_stiffness: float,
    suspension_damping: float,
    contact_mass: float,
    lowest_frequency: float = 100.0,
    highest_frequency: float | None = None,
) -> TwoDofFit:
    """Adapt k_W and c_W of the two-mass wheel so that the levels of the vertical receptances agree best.

    The stiffness places the anti-resonance; the damping makes the receptance above it the geometric mean of the
    flexible wheel's resonances and anti-resonances. The flexible wheel should have the same rigid-body motion and be
    seen at the tread centre: away from it lateral and vertical motion are coupled, which two masses can't follow.

    Parameters
    ----------
    flexible : FlexibleWheel
    mass, suspension_stiffness, suspension_damping, contact_mass : float
        Of the two-mass wheel, kept as they are; kg, N/m, N s/m, kg.
    lowest_frequency : float
        Hz.
    highest_frequency : float, optional
        Hz; by default that of the highest mode.

    Returns
    -------
    TwoDofFit

    Raises
    ------
    ValueError
        If the wheel has no flexible modes within the frequencies.
    """
    highest = highest_frequency or max((mode.frequency for mode in flexible.modes), default=0.0)
    if not lowest_frequency < highest:
        raise ValueError(f"no flexible mode above the lowest frequency of the fit, {lowest_frequency:g} Hz")
    frequency = np.geomspace(lowest_frequency, highest, _POINTS)
    wanted = np.log(np.abs(flexible.receptance(frequency)[:, 2, 2]))

    def two_masses(stiffness: float, damping: float) -> RigidWheel:
        return RigidWheel.two_dof(
            mass=mass,
            suspension_stiffness=suspension_stiffness,
            suspension_damping=suspension_damping,
            contact_mass=contact_mass,
            contact_stiffness=stiffness,
            contact_damping=damping,
        )

    def difference(logarithms: NDArray) -> NDArray:
        return np.log(np.abs(two_masses(*np.exp(logarithms)).receptance(frequency))) - wanted

    stiffness = 1.0 / flexible.held().static_compliance()[2, 2]
    high = frequency > np.sqrt(lowest_frequency * highest)
    damping = np.exp(np.mean(-wanted[high] - np.log(2.0 * np.pi * frequency[high])))
    fit = least_squares(difference, np.log([stiffness, damping]))
    stiffness, damping = (float(value) for value in np.exp(fit.x))
    deviation = 20.0 / np.log(10.0) * float(np.sqrt(np.mean(fit.fun**2)))
    return TwoDofFit(two_masses(stiffness, damping), stiffness, damping, deviation)
