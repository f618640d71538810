"""Modes from receptances that are sampled in frequency, for wheels whose resonances the lines hardly resolve.

The poles are found by vector fitting (Gustavsen and Semlyen 1999; relaxed: Gustavsen 2006; one set of poles for all
pairs: Deschrijver et al. 2008), and with these the sum

    H = sum of C / (w_r^2 - w^2 + 2 i zeta w_r w) + R - A / w^2

is fitted by real symmetric matrices, which are what modes have: C the product of their shapes (the shape at the contact
of a mode, or of several of one frequency), R the compliance of all modes above the band, A the inverse of the mass of a
free body. Negative eigenvalues, which no modes have, are left out. R becomes modes at twice the end of the band, which
only follow the force.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from .modes import RESIDUAL, FlexibleWheel, Mode
from .receptance_file import PointReceptance

__all__ = ["ModalFit", "fit_modes"]

_ROUNDS = 8
_CONVERGED = 1e-3  # largest move of a pole, over its damping
_PROMINENCE = 3.0  # dB, of a peak that is a first guess
_ENOUGH_LINES, _AROUND = 3000, 12
_HIGHEST = 1.5  # of the end of the band, for poles that are kept
_LARGEST_RATIO = 0.3  # damping ratio up to which a pole is taken for a mode
_LEAST_SHARE = 0.02  # of the receptance at its resonance, below which a mode isn't seen
_MOST_NEGATIVE = 0.2  # eigenvalue of a mode's matrix, over its largest
_LEAST_EIGENVALUE = 0.01  # of the largest of a frequency
_RESIDUAL_FREQUENCY, _RESIDUAL_RATIO = 2.0, 0.5


@dataclass(frozen=True, eq=False)
class ModalFit:
    """Modes that were fitted, and how well.

    Attributes
    ----------
    wheel : FlexibleWheel
        Modes named "fit-1", "fit-2", ... by frequency, and "above-1", ... for the compliance above the band.
    body_accelerance : ndarray, shape (3, 3)
        A in 1/kg; 0 for "static".
    deviation : float
        Of the receptance of the result from the data, rms over the rms of the data.
    level : float
        Median deviation of the magnitude of the vertical point receptance in dB.
    notes : tuple of str
        What a user should know.
    """

    wheel: FlexibleWheel
    body_accelerance: NDArray
    deviation: float
    level: float
    notes: tuple[str, ...]


def fit_modes(
    measured: PointReceptance, *, low_frequency: Literal["static", "free"], rounds: int = _ROUNDS
) -> ModalFit:
    """Find the modes of a wheel from its receptances.

    Parameters
    ----------
    measured : PointReceptance
        The line at 0 Hz, if there is one, isn't used.
    low_frequency : {"static", "free"}
        Whether -A / w^2 of a free body is in it; A is not part of the resulting modes.
    rounds : int
        Largest number of rounds in which the poles are moved.

    Returns
    -------
    ModalFit

    Raises
    ------
    ValueError
        If the receptances have no resonance.
    """
    if low_frequency not in ("static", "free"):
        raise ValueError(f'low_frequency = {low_frequency!r} is refused: allowed are "static" and "free"')
    used = measured.frequency > 0.0
    frequency, values = measured.frequency[used], measured.values[used]
    kept = _informative(frequency, values)
    pairs = [(i, j) for i in range(3) for j in range(i, 3) if measured.given[i, j] and values[:, i, j].any()]
    data = np.array([values[:, i, j] for i, j in pairs])
    weight = 1.0 / (np.abs(data) + np.median(np.abs(data), axis=1, keepdims=True))
    free = low_frequency == "free"
    # In units of the end of the band, so that all terms have similar sizes.
    scale = 2.0 * np.pi * frequency[-1]
    s = 2j * np.pi * frequency / scale
    poles = _first_poles(frequency, values) * 2.0 * np.pi / scale
    for _ in range(rounds):
        moved = _moved_poles(s[kept], data[:, kept], weight[:, kept], poles, free)
        same = len(moved) == len(poles)
        change = np.max(np.abs(moved - poles) / np.abs(np.real(poles)), initial=0.0) if same else np.inf
        poles = moved
        if change < _CONVERGED or not len(poles):
            break
    poles = poles[(np.abs(poles) <= _HIGHEST) & (-np.real(poles) <= _LARGEST_RATIO * np.abs(poles))]
    while True:
        terms, compliance, accelerance = _matrices(s, data, weight, poles, pairs, free)
        kept = _seen(terms, poles, s, values) & _is_motion(terms)
        if kept.all():
            break
        poles = poles[kept]
    if not len(poles):
        raise ValueError("the receptances have no resonance; nothing can be fitted to them")
    modes, lost = _modes(terms, poles * scale / (2.0 * np.pi), scale)
    above = _above(compliance, frequency[-1])
    wheel = FlexibleWheel((*modes, *above))
    found = wheel.receptance(frequency) - accelerance * scale**2 / (2.0 * np.pi * frequency[:, None, None]) ** 2
    deviation = float(np.linalg.norm(found - values) / np.linalg.norm(values))
    level = float(np.median(np.abs(20.0 * np.log10(np.abs(found[:, 2, 2]) / np.abs(values[:, 2, 2])))))
    notes = [
        f"{len(modes)} modes fitted from {modes[0].frequency:.4g} Hz to {modes[-1].frequency:.4g} Hz; they deviate "
        f"from the receptances by {100.0 * deviation:.2g} % (rms), vertically by {level:.2g} dB (median)"
    ]
    if lost > _LEAST_EIGENVALUE:
        notes.append(f"{100.0 * lost:.2g} % of the fitted motion isn't that of modes and is left out")
    return ModalFit(wheel, accelerance * scale**2, deviation, level, tuple(notes))


def _first_poles(frequency: NDArray, values: NDArray) -> NDArray:
    """Poles in Hz at the peaks of all point mobilities, and between them; imaginary parts positive."""
    found: set[int] = set()
    for i in range(3):
        level = 20.0 * np.log10(np.maximum(frequency * np.abs(values[:, i, i]), 1e-300))
        found |= set(find_peaks(level, prominence=_PROMINENCE)[0].tolist())
    at = frequency[sorted(found)]
    # Modes that no peak shows move to their places from here.
    more = np.linspace(frequency[0], frequency[-1], 2 + max(len(at) // 5, 4))[1:-1]
    places = np.sort(np.concatenate([at, more]))
    return places * (-1e-3 + 1j)


def _informative(frequency: NDArray, values: NDArray) -> NDArray:
    """Lines that place the poles: all around the peaks, every few elsewhere."""
    if len(frequency) <= _ENOUGH_LINES:
        return np.arange(len(frequency))
    near = np.zeros(len(frequency), dtype=bool)
    near[:: -(-len(frequency) // (_ENOUGH_LINES // 2))] = True
    for i in range(3):
        level = 20.0 * np.log10(np.maximum(frequency * np.abs(values[:, i, i]), 1e-300))
        for peak in find_peaks(level, prominence=_PROMINENCE)[0]:
            near[max(peak - _AROUND, 0) : peak + _AROUND + 1] = True
    return np.flatnonzero(near)


def _partial(s: NDArray, poles: NDArray) -> NDArray:
    """Partial fractions of the poles with their conjugates for real coefficients, shape (nf, 2 n)."""
    one, other = 1.0 / (s[:, None] - poles), 1.0 / (s[:, None] - poles.conj())
    return np.stack([one + other, 1j * (one - other)], axis=2).reshape(len(s), -1)


def _real_rows(matrix: NDArray) -> NDArray:
    return np.concatenate([np.real(matrix), np.imag(matrix)], axis=0)


def _moved_poles(s: NDArray, data: NDArray, weight: NDArray, poles: NDArray, free: bool) -> NDArray:
    """Move the poles to the zeros of the common denominator that fits best."""
    basis = _partial(s, poles)
    own = np.column_stack([basis, np.ones(len(s)), *([1.0 / s**2] if free else [])])
    common = np.column_stack([basis, np.ones(len(s))])
    count = common.shape[1]
    blocks = []
    for one, w in zip(data, weight, strict=True):
        system = _real_rows(w[:, None] * np.column_stack([own, -one[:, None] * common]))
        # Of each pair's least squares only what concerns the common unknowns is kept.
        blocks.append(np.asarray(np.linalg.qr(system, mode="r"))[own.shape[1] : own.shape[1] + count, own.shape[1] :])
    # The sum of the denominator over the lines is fixed, so that it can't vanish.
    size = float(np.linalg.norm(np.concatenate(blocks)) / np.sqrt(count))
    left = np.concatenate([*blocks, size * np.real(common).mean(axis=0)[None]])
    right = np.zeros(len(left))
    right[-1] = size
    lengths = np.linalg.norm(left, axis=0)
    solution = np.linalg.lstsq(left / lengths, right, rcond=None)[0] / lengths
    residues, constant = solution[:-1], solution[-1]
    matrix = np.zeros((2 * len(poles), 2 * len(poles)))
    entry = np.zeros(2 * len(poles))
    for n, pole in enumerate(poles):
        matrix[2 * n : 2 * n + 2, 2 * n : 2 * n + 2] = [[pole.real, pole.imag], [-pole.imag, pole.real]]
        entry[2 * n] = 2.0
    zeros = np.linalg.eigvals(matrix - np.outer(entry, residues) / constant)
    zeros = zeros[np.imag(zeros) > 0.0]
    # A pole that makes the wheel unstable is mirrored.
    return np.sort_complex(1j * np.imag(zeros) - np.abs(np.real(zeros)))


def _matrices(
    s: NDArray, data: NDArray, weight: NDArray, poles: NDArray, pairs: list[tuple[int, int]], free: bool
) -> tuple[NDArray, NDArray, NDArray]:
    """Fit the real matrices C (n, 3, 3), R and A for given poles, in units of the band."""
    omega2 = np.abs(poles) ** 2
    columns = [1.0 / (omega2 + s[:, None] ** 2 - 2.0 * np.real(poles) * s[:, None]), np.ones((len(s), 1))]
    if free:
        columns.append(1.0 / s[:, None] ** 2)
    basis = np.concatenate(columns, axis=1)
    result = np.zeros((basis.shape[1], 3, 3))
    for (i, j), one, w in zip(pairs, data, weight, strict=True):
        system = _real_rows(w[:, None] * basis)
        lengths = np.linalg.norm(system, axis=0)
        solution = np.linalg.lstsq(system / lengths, _real_rows(w * one), rcond=None)[0] / lengths
        result[:, i, j] = result[:, j, i] = solution
    n = len(poles)
    return result[:n], result[n], result[n + 1] if free else np.zeros((3, 3))


def _seen(terms: NDArray, poles: NDArray, s: NDArray, values: NDArray) -> NDArray:
    """Which poles show: their own response at resonance against the whole one nearby."""
    peak = np.linalg.norm(terms, axis=(1, 2)) / np.maximum(2.0 * np.abs(np.real(poles)) * np.abs(poles), 1e-300)
    nearest = np.argmin(np.abs(np.imag(s)[:, None] - np.abs(poles)), axis=0)
    return peak > _LEAST_SHARE * np.linalg.norm(values[nearest], axis=(1, 2))


def _is_motion(terms: NDArray) -> NDArray:
    """Which matrices can be products of shapes: those without large negative eigenvalues."""
    size = np.linalg.eigvalsh(terms)
    return -size[:, 0] < _MOST_NEGATIVE * size[:, -1]


def _modes(terms: NDArray, poles: NDArray, scale: float) -> tuple[list[Mode], float]:
    """Modes of 1 kg from the matrices of their shapes; also the largest share of negative eigenvalues."""
    modes, lost = [], 0.0
    for term, pole in sorted(zip(terms, poles, strict=True), key=lambda pair: abs(pair[1])):
        size, shapes = np.linalg.eigh(term * scale**2)
        if size[-1] <= 0.0:
            continue
        lost = max(lost, float(-size[0] / size[-1]))
        for value, shape in zip(size[::-1], shapes.T[::-1], strict=True):
            if value > _LEAST_EIGENVALUE * size[-1]:
                x, y, z = (np.sqrt(value) * shape).tolist()
                modes.append(
                    Mode.with_frequency(
                        name=f"fit-{len(modes) + 1}",
                        mass=1.0,
                        frequency=float(abs(pole)),
                        damping_ratio=float(-pole.real / abs(pole)),
                        shape=(x, y, z),
                    )
                )
    return modes, lost


def _above(compliance: NDArray, highest: float) -> list[Mode]:
    """Modes far above the band that have a compliance."""
    size, shapes = np.linalg.eigh(compliance)
    omega = 2.0 * np.pi * _RESIDUAL_FREQUENCY * highest
    modes = []
    for value, shape in zip(size, shapes.T, strict=True):
        if value > 0.0:
            x, y, z = (omega * np.sqrt(value) * shape).tolist()
            modes.append(
                Mode.with_frequency(
                    name=f"{RESIDUAL}{len(modes) + 1}",
                    mass=1.0,
                    frequency=_RESIDUAL_FREQUENCY * highest,
                    damping_ratio=_RESIDUAL_RATIO,
                    shape=(x, y, z),
                )
            )
    return modes
