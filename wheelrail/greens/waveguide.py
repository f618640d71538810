"""Moving Green's functions of a rail modelled as a waveguide, in three directions with all cross terms.

Length: the functions end where, for the forces and displacements of equal direction, the energy (sum of squares)
between the end and the horizon is at most a given share of the whole. Lateral motion dies out most slowly and decides.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .bloch import BlochModes, bloch_greens
from .moving import MovingGreens
from .travelling_waves import Waves, wave_greens

__all__ = ["WaveguideRail", "compute_waveguide_greens"]

ENERGY_TOLERANCE = 1e-4
HORIZON = 0.3  # s
_DIAGONAL = np.arange(3)


class WaveguideRail(Protocol):
    """What a waveguide offers: the waves of a uniform rail or the modes of one on supports; the other one is None."""

    @property
    def waves(self) -> Waves | None: ...  # noqa: D102

    @property
    def bloch_modes(self) -> BlochModes | None: ...  # noqa: D102


def compute_waveguide_greens(
    rail: WaveguideRail,
    *,
    speed: float,
    dx: float,
    memory: float | None = None,
    energy_tolerance: float = ENERGY_TOLERANCE,
    progress: Callable[[float], None] | None = None,
) -> MovingGreens:
    """Compute the moving Green's functions for every position of the force.

    Parameters
    ----------
    rail : WaveguideRail
    speed, dx : float
        m/s and m; the spacing of discrete supports must be a multiple of dx.
    memory : float, optional
        Length in s; by default it follows from ``energy_tolerance``.
    energy_tolerance : float
        Largest share of energy between the end and the horizon.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    MovingGreens
        ``values`` of shape (positions, 3, 3, samples): [position, force direction, displacement direction, sample];
        one position for a uniform rail, else one for each dx of a bay.

    Raises
    ------
    ValueError
        If the spacing of the supports is no multiple of dx.
    """
    dt = dx / speed
    horizon = HORIZON if memory is None else memory
    samples = max(int(horizon / dt * (1.0 + 1e-9)), 2)
    modes = rail.bloch_modes
    if modes is not None:
        positions = round(modes.spacing / dx)
        if positions < 1 or abs(positions * dx - modes.spacing) > 1e-9 * modes.spacing:
            raise ValueError(f"sleeper spacing {modes.spacing:g} m is no multiple of dx = {dx:g} m")
        values = bloch_greens(modes, speed=speed, dx=dx, samples=samples, progress=progress)
    else:
        assert rail.waves is not None
        values = wave_greens(rail.waves, speed=speed, dx=dx, samples=samples, progress=progress)[None]
    keep, energy, compliance = samples, 0.0, 0.0
    direct = values[:, _DIAGONAL, _DIAGONAL]  # (positions, 3, samples)
    beyond = np.cumsum(direct[:, :, ::-1] ** 2, axis=2)[:, :, ::-1]
    beyond /= beyond[:, :, :1].copy()
    if memory is None:
        keep = max(2, int(np.count_nonzero(beyond > energy_tolerance, axis=2).max()))
    if keep < samples:
        energy = beyond[:, :, keep].max(axis=1)
        compliance = (direct[:, :, keep:].sum(axis=2) / direct.sum(axis=2)).max(axis=1)
    kept = values[..., :keep].copy()
    kept[..., -1] *= 0.5  # eq. 3.14: the last sample is halved
    positions = np.zeros(len(values))
    return MovingGreens(kept, dx, dt, energy + positions, compliance + positions, horizon)


def moving_receptance(values: NDArray, frequency: NDArray, dt: float) -> NDArray:
    """Receptance seen by the moving contact: the Fourier sum of the functions of one position.

    Parameters
    ----------
    values : ndarray, shape (d, d, samples)
        [force direction, displacement direction, sample], m/N.
    frequency : ndarray, shape (n,)
        Hz, as the contact sees it.
    dt : float
        s.

    Returns
    -------
    ndarray of complex, shape (n, d, d)
        [frequency, displacement, force] in m/N.
    """
    phase = np.exp(-2j * np.pi * np.multiply.outer(frequency, np.arange(values.shape[-1])) * dt)
    return np.einsum("fn,abn->fba", phase, values, optimize=True)
