"""Vibration velocity of wheel and rail at the contact in third-octave bands, as rolling noise models take it.

Velocities are those of the displacements that a run records. The rail's is that of the point under the wheel, which
moves along: below the sleeper passing frequency it holds the deflection's change from bay to bay, which no fixed point
of the rail has.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelrail.errors import ParameterError

from .third_octave import ThirdOctaveSpectrum, third_octave

__all__ = ["DISPLACEMENTS", "REFERENCE_VELOCITY", "ContactVelocities", "contact_velocities", "velocity"]

REFERENCE_VELOCITY = 1e-9
"""Of levels, m/s (ISO 1683:2015); levels re 5e-8 m/s are 34.0 dB lower."""

DISPLACEMENTS = {
    "wheel_disp_z": "wheel, vertical",
    "rail_disp_z": "rail, vertical",
    "wheel_disp_y": "wheel, lateral",
    "rail_disp_y": "rail, lateral",
    "wheel_disp_x": "wheel, longitudinal",
    "rail_disp_x": "rail, longitudinal",
}
"""Recorded displacements that have a spectrum, and what to call them."""


@dataclass(frozen=True, eq=False)
class ContactVelocities:
    """Velocity spectra of one run.

    Attributes
    ----------
    centres : ndarray, shape (bands,)
        Exact centre frequencies, Hz, ascending.
    mean_squares : dict of str to ndarray, shape (bands,)
        (m/s)^2 in each band, by the names of the displacements.
    lines_per_band : ndarray, shape (bands,)
        As in `wheelrail.analysis.third_octave.ThirdOctaveSpectrum`.
    """

    centres: NDArray
    mean_squares: dict[str, NDArray]
    lines_per_band: NDArray

    def levels(self, name: str, *, reference: float = REFERENCE_VELOCITY) -> NDArray:
        """Levels 10 lg(mean square / reference^2), dB, shape (bands,); -inf for an empty band."""
        with np.errstate(divide="ignore"):
            return 10.0 * np.log10(self.mean_squares[name] / reference**2)


def velocity(displacement: ArrayLike, *, dt: float) -> NDArray:
    """Differentiate a displacement as if nothing lay above the Nyquist frequency.

    Differences between neighbours are taken, whose error 2 sin(omega dt / 2) / (omega dt) is then undone at each
    frequency: a step between end and beginning, as the Fourier transform of the whole record would see, does no harm.

    Parameters
    ----------
    displacement : array_like, shape (n,)
        Equidistant samples, m.
    dt : float
        s.

    Returns
    -------
    ndarray, shape (n - 1,)
        m/s, halfway between the samples. A few samples at either end are less exact.

    Raises
    ------
    ValueError
        If there are less than 16 samples or not all are finite.
    ParameterError
        If ``dt`` is not positive.
    """
    values = np.asarray(displacement, dtype=float)
    if values.ndim != 1 or len(values) < 16 or not np.all(np.isfinite(values)):
        raise ValueError("displacement must be 1-D and finite, with at least 16 samples")
    if not (math.isfinite(dt) and dt > 0.0):
        raise ParameterError("dt", dt, "must be a number > 0 s")
    difference = np.diff(values) / dt
    count = len(difference)
    # Mirrored at its ends, the record has no step there.
    spectrum = np.fft.rfft(np.concatenate([difference, difference[::-1]]))
    spectrum /= np.sinc(0.5 * np.arange(count + 1) / count)
    return np.fft.irfft(spectrum, 2 * count)[:count]


def contact_velocities(
    displacements: Mapping[str, ArrayLike],
    *,
    dt: float,
    transient: float,
    lowest: float | None = None,
    highest: float | None = None,
    segment: float | None = None,
) -> ContactVelocities:
    """Third-octave spectra of the velocities of wheel and rail.

    Parameters
    ----------
    displacements : mapping of str to array_like, shape (n,)
        m, of the same run.
    dt : float
        s.
    transient : float
        s; this much of the beginning is left out.
    lowest, highest : float or None
        Hz; as `wheelrail.analysis.third_octave.third_octave` takes them.
    segment : float or None
        s, of the segments that spectra are averaged over; None: the whole rest at once.

    Returns
    -------
    ContactVelocities

    Raises
    ------
    ParameterError
        No displacement, a negative transient, or too little left after it.
    """
    if not displacements:
        raise ParameterError("displacements", "none", f"one at least, such as {', '.join(DISPLACEMENTS)}")
    if not (math.isfinite(transient) and transient >= 0.0):
        raise ParameterError("transient", transient, "must be a number >= 0 s")
    first = round(transient / dt)
    spectra: dict[str, ThirdOctaveSpectrum] = {}
    for name, displacement in displacements.items():
        values = np.asarray(displacement, dtype=float)[first:]
        if len(values) < 64:
            raise ParameterError("transient", transient, "leaves less than 64 samples; make the run longer")
        length = None if segment is None else min(round(segment / dt), len(values) - 1)
        spectra[name] = third_octave(
            velocity(values, dt=dt), spacing=dt, lowest=lowest, highest=highest, segment=length
        )
    some = next(iter(spectra.values()))
    return ContactVelocities(
        some.centres, {name: spectrum.mean_square for name, spectrum in spectra.items()}, some.lines_per_band
    )
