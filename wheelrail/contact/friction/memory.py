"""Friction memory: the coefficient of a particle follows its law over a sliding distance (Vollebregt 2014, Wear 314).

    d mu / dt = -max(s, s_0) / d_c (mu - mu_law(s)),     backward Euler:
    mu = theta mu' + (1 - theta) mu_law(s),     theta = d_c / (d_c + dt max(s, s_0))

with mu' the coefficient of the same particle one step before. A law without memory on a contact without mass lets the
slip jump within a step, so that what follows depends on the grid; with memory the jump takes a distance d_c.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["FrictionMemory"]


@dataclass(frozen=True)
class FrictionMemory:
    """Memory of the friction coefficient.

    Parameters
    ----------
    distance : float
        d_c in m, > 0.
    speed : float
        s_0 in m/s, > 0: the coefficient recovers with this speed at least, also in stick.
    """

    distance: float
    speed: float

    def follow(
        self, coefficient: NDArray, slope: NDArray, speed: NDArray, *, previous: NDArray, dt: float
    ) -> tuple[NDArray, NDArray, NDArray]:
        """Do one step.

        Parameters
        ----------
        coefficient, slope : ndarray, shape (k,)
            mu_law(s) and d mu_law / ds (s/m).
        speed : ndarray, shape (k,)
            Slip velocity s, m/s.
        previous : ndarray, shape (k,)
            Coefficients of the particles one step before.
        dt : float
            s.

        Returns
        -------
        tuple of ndarray, shape (k,)
            The coefficient, its slope over s (s/m), and theta, its slope over the previous one.
        """
        reached = self.distance + dt * np.maximum(speed, self.speed)
        theta = self.distance / reached
        bends = np.where(speed > self.speed, -theta * dt / reached, 0.0)
        return (
            theta * previous + (1.0 - theta) * coefficient,
            bends * (previous - coefficient) + (1.0 - theta) * slope,
            theta,
        )
