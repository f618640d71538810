r"""Green's functions from receptances that are sampled in frequency, measured ones for instance.

A transform of the whole receptance back into time would ring before the impulse, because the band ends somewhere.
Instead, the function is made from the part out of phase with the force, which holds all the dissipation:

    g(t) = -4 int_0^fmax Im H(f) sin(2 pi f t) df,    t > 0.

That is causal whatever the data, dissipates where Im H < 0, and needs little beyond the band, because Im H is small
away from resonances. By the relations of Kramers and Kronig it determines the part in phase but for two terms from
outside the band: a constant compliance R of all modes above it, and -A/omega^2 of a free body below it. Both are fitted
to the data. What then remains of the part in phase contradicts causality: faults of the measurement, or resonances that
the lines don't resolve. It is reported.

The force is linear between the time steps, as in `wheelrail.greens.ordinary`, so that for each line, with
s(x) = sin(pi x) / (pi x),

    g(n) = -4 df sum of Im H(f) dt s(f dt)^2 sin(2 pi f (n - 1) dt),    g(1) = R - 4 df sum of Im H(f) S(f),
    S(f) = 1/w - sin(w dt) / (w^2 dt), w = 2 pi f, the same for the half of the hat that the first sample has.

With lines df apart the function is known up to 1 / (2 df). By then a resonance with a half-power bandwidth of b lines
has decayed to exp(-pi b / 2): fewer than 4 lines leave more than 0.2 %, and the damping comes out wrong. For lightly
damped wheels (bandwidth 0.4 Hz at 2 kHz for a damping ratio of 1e-4) a modal model is the better choice.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import zoom_fft

from .causality import LowFrequency, outside_the_band
from .receptance_lines import FEWEST_LINES, checked_lines, even_lines, unresolved_resonances

__all__ = ["ReceptanceGreens", "greens_from_receptance", "transform"]

_LISTED = 6
# What is worth a note.
_LARGEST_TAIL, _LARGEST_TRUNCATION, _LARGEST_NON_CAUSAL, _LARGEST_ACTIVE = 1e-2, 1e-3, 2e-2, 1e-3


@dataclass(frozen=True, eq=False)
class ReceptanceGreens:
    """Green's functions from a receptance.

    Attributes
    ----------
    values : ndarray, shape (n, 3, 3)
        Discretised, [sample, displacement, force], m/N; without the motion as a free body.
    dt : float
        Time step in s.
    residual_compliance : ndarray, shape (3, 3)
        R in m/N, contained in the first sample.
    body_accelerance : ndarray, shape (3, 3)
        A in 1/kg, the inverse of the mass matrix of the free body; 0 for "static".
    longest : float
        Longest memory in s that the spacing of the lines allows.
    non_causal : float
        What of the receptance contradicts causality, rms over the rms of the whole.
    truncated_energy : float
        Share of the energy (sum of squares after the first sample) between the end and `longest`.
    tail : float
        Amplitude at `longest` over the largest one.
    active : float
        Largest violation of passivity of the result over its largest value; 0: none.
    unresolved : tuple of float
        Resonances in Hz with fewer than 4 lines in their half-power bandwidth.
    notes : tuple of str
        What a user should know.
    """

    values: NDArray
    dt: float
    residual_compliance: NDArray
    body_accelerance: NDArray
    longest: float
    non_causal: float
    truncated_energy: float
    tail: float
    active: float
    unresolved: tuple[float, ...]
    notes: tuple[str, ...]


def greens_from_receptance(
    *,
    frequency: ArrayLike,
    values: ArrayLike,
    dt: float,
    low_frequency: LowFrequency,
    memory: float | None = None,
    energy_tolerance: float = 1e-6,
    edge: float = 0.02,
    tail_taper: float = 0.1,
) -> ReceptanceGreens:
    """Make discretised Green's functions from receptances.

    Parameters
    ----------
    frequency : array_like, shape (nf,)
        Hz, increasing, not negative.
    values : array_like of complex, shape (nf, 3, 3)
        m/N, [frequency, displacement, force]; time factor exp(+i omega t).
    dt : float
        Time step in s. Lines above half the sampling frequency only count by their compliance.
    low_frequency : {"static", "free"}
        What goes on below the first line: towards a constant compliance, or -A/omega^2 of a free body, which is taken
        out of the result.
    memory : float, optional
        Length in s; by default as long as ``energy_tolerance`` needs and the lines allow.
    energy_tolerance : float
        Largest share of neglected energy.
    edge : float
        Share of the band, at its upper end, over which the lines fade out.
    tail_taper : float
        Share of the functions, at their end, over which they fade out.

    Returns
    -------
    ReceptanceGreens

    Raises
    ------
    ValueError
        For lines that don't increase or are too unevenly spaced, values that aren't finite, a time step that leaves
        no band, or a memory beyond what the lines allow.
    """
    if low_frequency not in ("static", "free"):
        raise ValueError(f'low_frequency = {low_frequency!r} is refused: allowed are "static" and "free"')
    frequency, values = checked_lines(frequency, values)
    notes: list[str] = []
    lines, even = even_lines(frequency, values, notes)
    df = lines[1]
    top = min(lines[-1], 0.5 / dt)
    kept = lines <= top * (1.0 + 1e-9)
    if np.count_nonzero(kept & (lines >= frequency[0])) < FEWEST_LINES:
        raise ValueError(
            f"dt = {dt:g} s is refused: half the sampling frequency is {0.5 / dt:g} Hz, the lines are from "
            f"{frequency[0]:g} Hz to {frequency[-1]:g} Hz"
        )
    fade = np.clip((top - lines) / max(edge * top, df), 0.0, 1.0)
    odd = np.where(kept, np.sin(0.5 * np.pi * fade) ** 2, 0.0)[:, None, None] * np.imag(even)
    compliance, accelerance, non_causal = outside_the_band(lines, even, odd, frequency[0], top, low_frequency)
    longest = 0.5 / df
    whole = _hat_response(lines, odd, dt, int(longest / dt + 1e-9) + 1)
    whole[0] += compliance
    n, truncated = _length(whole, dt, longest, memory, energy_tolerance)
    result = whole[:n].copy()
    faded = min(max(round(tail_taper * n), 1), n - 1)
    result[n - faded :] *= np.cos(0.5 * np.pi * np.arange(1, faded + 1) / faded)[:, None, None] ** 2
    size = np.sqrt(np.sum(whole[1:] ** 2, axis=(1, 2)))
    tail = float(size[-max(len(size) // 20, 1) :].max() / size.max()) if size.any() else 0.0
    unresolved = unresolved_resonances(lines, even, frequency[0], top)
    active = _active(result, dt, top)
    made = ReceptanceGreens(
        result, dt, compliance, accelerance, longest, non_causal, truncated, tail, active, unresolved, ()
    )
    return replace(made, notes=(*notes, *_notes_on(made, frequency[-1], low_frequency)))


def transform(values: ArrayLike, frequency: ArrayLike, *, dt: float) -> NDArray:
    """Receptance that discretised Green's functions have, for forces that are linear between the steps.

    Parameters
    ----------
    values : array_like, shape (n, d, d)
        m/N.
    frequency : array_like, shape (nf,)
        Hz, below half the sampling frequency.
    dt : float
        Time step in s.

    Returns
    -------
    ndarray of complex, shape (nf, d, d)
        m/N; near half the sampling frequency it holds what lies above it as well.
    """
    values, frequency = np.asarray(values, dtype=float), np.atleast_1d(np.asarray(frequency, dtype=float))
    flat = values.reshape(len(values), -1)
    steps = np.arange(len(values))
    result = np.empty((len(frequency), flat.shape[1]), dtype=complex)
    for i, f in enumerate(frequency):
        result[i] = np.exp(-2j * np.pi * f * dt * steps) @ flat / np.sinc(f * dt) ** 2
    return result.reshape(len(frequency), *values.shape[1:])


def _hat_response(lines: NDArray, odd: NDArray, dt: float, samples: int) -> NDArray:
    """Compute the samples, for forces that rise to 1 and fall back within a step each; exact for each line."""
    df, omega = lines[1], 2.0 * np.pi * lines
    weights = dt * np.sinc(lines * dt) ** 2
    found = zoom_fft(weights[:, None, None] * odd, [0.0, samples * dt], m=samples, fs=1.0 / df, endpoint=False, axis=0)
    result = 4.0 * df * np.imag(found)
    half = np.zeros_like(omega)
    half[1:] = 1.0 / omega[1:] - np.sin(omega[1:] * dt) / (omega[1:] ** 2 * dt)
    result[0] = -4.0 * df * np.tensordot(half, odd, axes=1)
    return result


def _length(
    whole: NDArray, dt: float, longest: float, memory: float | None, energy_tolerance: float
) -> tuple[int, float]:
    """Choose the number of samples to keep; also return the share of energy beyond them."""
    energy = np.sum(whole**2, axis=(1, 2))
    energy[0] = 0.0
    beyond = np.append(np.cumsum(energy[::-1])[::-1], 0.0) / (energy.sum() or 1.0)
    if memory is None:
        n = int(np.count_nonzero(beyond[:-1] > energy_tolerance))
    else:
        n = round(memory / dt)
        if not 1 < n <= len(whole):
            raise ValueError(
                f"memory = {memory:g} s is refused: allowed is more than dt = {dt:g} s, at most {longest:g} s, half "
                "the inverse of the spacing of the lines"
            )
    n = max(n, 2)
    return n, float(beyond[n])


def _active(values: NDArray, dt: float, top: float) -> float:
    """Largest negative eigenvalue of the part that dissipates, over the largest value."""
    size = 1 << (2 * len(values) - 1).bit_length()
    spectrum = np.fft.rfft(values, size, axis=0)
    inside = np.arange(len(spectrum)) / (size * dt) <= top
    dissipating = -0.5 * (spectrum.imag + np.swapaxes(spectrum.imag, 1, 2))[inside]
    smallest = np.linalg.eigvalsh(dissipating)[:, 0].min()
    return float(max(-smallest, 0.0) / np.abs(spectrum[inside]).max())


def _notes_on(made: ReceptanceGreens, highest: float, low_frequency: LowFrequency) -> list[str]:
    notes = []
    half_rate, df, longest = 0.5 / made.dt, 0.5 / made.longest, f"{made.longest:.4g} s"
    if highest < half_rate:
        notes.append(
            f"the receptances end at {highest:g} Hz, half the sampling frequency is {half_rate:g} Hz: in between there "
            "is only the compliance of what lies above"
        )
    elif highest > half_rate * (1.0 + 1e-9):
        notes.append(f"lines above half the sampling frequency, {half_rate:g} Hz, count by their compliance only")
    if made.unresolved:
        listed = ", ".join(f"{f:.6g}" for f in made.unresolved[:_LISTED])
        notes.append(
            f"{len(made.unresolved)} resonances ({listed}{', ...' if len(made.unresolved) > _LISTED else ''} Hz) have "
            f"fewer than {FEWEST_LINES:g} lines of {df:g} Hz in their half-power bandwidth; what they do after "
            f"{longest} isn't known and their damping comes out wrong: use finer lines or a modal model"
        )
    if made.tail > _LARGEST_TAIL:
        notes.append(
            f"the functions have decayed to {100.0 * made.tail:.2g} % only where the spacing of the lines ends them, "
            f"at {longest}"
        )
    if made.truncated_energy > _LARGEST_TRUNCATION:
        notes.append(f"{100.0 * made.truncated_energy:.2g} % of the energy lies beyond the memory")
    if made.non_causal > _LARGEST_NON_CAUSAL:
        free = "; does it belong to a free body?" if low_frequency == "static" and made.non_causal > 0.2 else ""
        notes.append(f"{100.0 * made.non_causal:.2g} % of the receptance (rms) contradicts causality{free}")
    if made.active > _LARGEST_ACTIVE:
        notes.append(f"the functions aren't passive by {100.0 * made.active:.2g} % of their largest receptance")
    return notes
