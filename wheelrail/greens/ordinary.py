"""Ordinary Green's functions: of a system that is hit and looked at in the same place (the wheel).

The force is taken as piecewise linear between the time steps, so each sample of the discretised function is the
response to a force that rises from 0 to 1 within one step and falls back within the next. For dt -> 0 it tends to the
trapezoidal rule of Pieringer (2011), eq. 3.6, g(1) = dt g(0) / 2, g(n) = dt g((n - 1) dt), which is available as
"sampled". The thesis cuts the receptances off at half the sampling frequency before it samples; functions computed in
the time domain are not band limited, and sampled they would fold what lies above into the range of interest (for the
track, resonances of the mesh near the sampling frequency, 0.3 % of the static compliance). The linear form does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm, matrix_balance

from .recursion import Recursion

__all__ = ["HIGHEST", "Discretisation", "OrdinaryGreens", "discretise", "sample"]

Discretisation = Literal["linear", "sampled"]

HIGHEST = 0.9
"""Share of half the sampling frequency up to which single modes and waves vibrate; those above only yield.

The grid shows a vibration above half the sampling frequency as one mirrored at that frequency, with the sign of its
damping reversed: it feeds energy in, and lightly damped wheels run away. In contact a mode's frequency rises by some
per cent, hence the margin.
"""


@dataclass(frozen=True)
class OrdinaryGreens:
    """A discretised Green's function of finite length.

    Attributes
    ----------
    values : ndarray, shape (n,)
        m/N.
    dt : float
        Time step in s.
    neglected_energy : float
        Share of the function's energy (sum of squares) that lies beyond its end.
    """

    values: NDArray
    dt: float
    neglected_energy: float


def discretise(
    A: NDArray, b: NDArray, c: NDArray, *, dt: float, discretisation: Discretisation = "linear"
) -> Recursion:
    """Turn a state-space system into its discretised Green's function.

    Parameters
    ----------
    A : ndarray, shape (m, m)
    b, c : ndarray, shape (m,)
        d/dt s = A s + b f, displacement = c s.
    dt : float
        Time step in s.
    discretisation : {"linear", "sampled"}
        Piecewise linear force, or Pieringer (2011), eq. 3.6, as printed.

    Returns
    -------
    Recursion
        Exact for the system and the chosen form, whatever dt.
    """
    m = len(b)
    # Displacements and velocities differ by many orders of magnitude; expm is more accurate for a balanced matrix.
    A, scale = matrix_balance(A * dt, permute=False, separate=True)
    scale = scale[0]
    A, b, c = A / dt, b / scale, c * scale
    if discretisation == "sampled":
        phi = expm(A * dt)
        return Recursion(phi, phi @ b * dt, c, float(0.5 * dt * c @ b))
    # The state, the force and its slope in one system (Van Loan 1978).
    system = np.zeros((m + 2, m + 2))
    system[:m, :m] = A * dt
    system[:m, m] = b * dt
    system[m, m + 1] = 1.0
    exponential = expm(system)
    phi, constant, rising = exponential[:m, :m], exponential[:m, m], exponential[:m, m + 1]
    return Recursion(phi, phi @ rising + constant - rising, c, float(c @ rising))


def sample(recursion: Recursion, *, dt: float, energy_tolerance: float = 1e-8, longest: float = 60.0) -> OrdinaryGreens:
    """Cut a Green's function where the energy beyond falls below a share of the whole.

    Parameters
    ----------
    recursion : Recursion
    dt : float
        Its time step in s.
    energy_tolerance : float
        Largest share of neglected energy.
    longest : float
        In s; a function that has not decayed by then (a free body) is cut there.

    Returns
    -------
    OrdinaryGreens
    """
    limit = int(longest / dt)
    n = 1024
    while True:
        values = recursion.values(n)
        remaining = np.cumsum(values[::-1] ** 2)[::-1] / np.sum(values**2)
        keep = int(np.count_nonzero(remaining > energy_tolerance))
        # Only when it also ends well inside what was computed is the tail known to be small.
        if keep < n // 2 or n >= limit:
            neglected = float(remaining[keep]) if keep < n else 0.0
            return OrdinaryGreens(values[:keep], dt, neglected)
        n *= 2
