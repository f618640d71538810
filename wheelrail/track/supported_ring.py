"""A rail on equal, discrete supports, closed to a ring of many bays (Bloch waves).

The free rail's waves with wavenumbers k_m = kappa + 2 pi m / L_s are what a support couples. For each Bloch wavenumber
kappa they and one support make a small system with constant real matrices, whose eigenvalues and eigenvectors give the
response in time and in frequency exactly: causal and passive, as all its springs, dampers and masses are positive.

Each support acts on the foot's mean displacements (x', y', z') and its rotation about x': a pad (spring and damper for
each direction; its width gives the stiffness against rotation) on a rigid sleeper mass on ballast. The sleeper moves in
three directions and does not rotate. A support has no extent along the rail.

The pinned-pinned resonance and the lateral dynamics exist together here, which the thesis' continuous waveguide lacks
(Pieringer 2011, section 3.3.2) and its beam model as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .reduced_section import ReducedSection, SectionWaves

__all__ = ["SupportedRing", "Supports", "close_supported_ring"]

_AXIAL = np.array([0, 3])  # rows of the outputs that are axial: head x', foot x'
_CHUNK = 1 << 21  # values of one intermediate array


@dataclass(frozen=True, kw_only=True)
class Supports:
    """Equal supports of a rail; triples are for the directions (x', y', z').

    Parameters
    ----------
    spacing : float
        Distance of the sleepers, m.
    pad_stiffness, pad_damping : tuple of 3 floats
        N/m and N s/m of one pad.
    pad_width : float
        m; the pad, uniform over this width, resists the foot's rotation about x'.
    sleeper_mass : float
        Of one rail's half, kg.
    ballast_stiffness, ballast_damping : tuple of 3 floats
        N/m and N s/m under one rail's half of the sleeper.
    """

    spacing: float
    pad_stiffness: tuple[float, float, float]
    pad_damping: tuple[float, float, float]
    pad_width: float
    sleeper_mass: float
    ballast_stiffness: tuple[float, float, float]
    ballast_damping: tuple[float, float, float]

    def matrices(self) -> tuple[NDArray, NDArray]:
        """Stiffness and damping of one support; shape (7, 7), foot x', y', z', rotation, sleeper x', y', z'."""
        return (
            _support_matrix(self.pad_stiffness, self.ballast_stiffness, self.pad_width),
            _support_matrix(self.pad_damping, self.ballast_damping, self.pad_width),
        )


def _support_matrix(pad: tuple[float, ...], ballast: tuple[float, ...], width: float) -> NDArray:
    matrix = np.zeros((7, 7))
    for direction in range(3):
        foot, sleeper = direction, 4 + direction
        matrix[foot, foot] += pad[direction]
        matrix[sleeper, sleeper] += pad[direction] + ballast[direction]
        matrix[foot, sleeper] = matrix[sleeper, foot] = -pad[direction]
    matrix[3, 3] = pad[2] * width**2 / 12.0
    return matrix


@dataclass(frozen=True)
class SupportedRing:
    """Modes of a rail on supports; each Bloch wavenumber stands for itself and its mirror image.

    Parameters
    ----------
    spacing : float
        m.
    bays : int
        Number of supports round the ring.
    kappa : ndarray, shape (n,)
        Bloch wavenumber of each mode, rad/m, 0 to pi / spacing.
    pole : ndarray of complex, shape (n,)
        Eigenvalue of each mode, 1/s, imaginary part >= 0; a complex one stands for its conjugate as well.
    orders : ndarray of int, shape (m,)
        The wavenumbers in a mode are kappa + 2 pi order / spacing.
    shape, participation : ndarray of complex, shape (n, m, 3)
        Displacement at the contact in each mode, and how a force at the contact drives it (in 1/(kg rad/s)), by
        order and direction; the axial ones are -i times and i times the true ones.
    """

    spacing: float
    bays: int
    kappa: NDArray
    pole: NDArray
    orders: NDArray
    shape: NDArray
    participation: NDArray

    @cached_property
    def weight(self) -> NDArray:
        """Share of each mode, with its mirror image and without its conjugate, in a sum over the ring; shape (n,)."""
        inner = (self.kappa > 1e-9) & (self.kappa < np.pi / self.spacing - 1e-9)
        return np.where(inner, 2.0, 1.0) * np.where(np.imag(self.pole) > 0.0, 1.0, 0.5) / self.bays

    def amplitudes(self, x: float) -> tuple[NDArray, NDArray]:
        """Displacement and participation of every mode at a place.

        Parameters
        ----------
        x : float
            Distance from a support, m.

        Returns
        -------
        displacement, participation : ndarray of complex, shape (n, 3)
            For exp(-i kappa x) times a periodic function; directions (x', y', z').
        """
        phase = np.exp(-1j * (self.kappa[:, None] + 2.0 * np.pi * self.orders / self.spacing) * x)
        axial = np.array([1j, 1.0, 1.0])
        return (
            np.einsum("nm,nmd->nd", phase, self.shape) * axial,
            np.einsum("nm,nmd->nd", phase.conj(), self.participation) * axial.conj(),
        )

    def receptance(self, frequency: ArrayLike, x0: float, x: float | None = None) -> NDArray:
        """Receptance between a force at x0 and the displacement at x.

        Parameters
        ----------
        frequency : array_like, shape (k,)
            Hz; complex values ask for the response to exp(i 2 pi f t) off the real axis.
        x0, x : float
            Distance from a support, m; x is x0 unless given.

        Returns
        -------
        ndarray of complex, shape (k, 3, 3)
            [frequency, displacement, force] in m/N.
        """
        s = 2j * np.pi * np.atleast_1d(np.asarray(frequency))
        out = self.amplitudes(x0 if x is None else x)[0]
        inp = self.amplitudes(x0)[1]
        # A pole and its conjugate have conjugate shapes for the real matrices, before the phases along the rail.
        mirror = self.mirrored()
        out_c, inp_c = mirror.amplitudes(x0 if x is None else x)[0], mirror.amplitudes(x0)[1]
        terms = [
            (self.weight[:, None, None] * a[:, :, None] * b[:, None, :]).reshape(len(self.pole), 9)
            for a, b in ((out, inp), (out_c, inp_c))
        ]
        # The sum over kappa and -kappa: half of the sum of the function and its conjugate at the conjugate frequency.
        amplitudes = np.concatenate([0.5 * terms[0], 0.5 * terms[1], 0.5 * terms[0].conj(), 0.5 * terms[1].conj()])
        poles = np.concatenate([self.pole, self.pole.conj(), self.pole.conj(), self.pole])
        result = np.empty((len(s), 9), dtype=complex)
        stride = max(1, _CHUNK // len(poles))
        for first in range(0, len(s), stride):
            part = s[first : first + stride, None]
            result[first : first + stride] = (1.0 / (part - poles)) @ amplitudes
        return result.reshape(len(s), 3, 3)

    def mirrored(self) -> SupportedRing:
        """Return the conjugate modes, at the same Bloch wavenumbers."""
        return SupportedRing(
            self.spacing,
            self.bays,
            self.kappa,
            self.pole.conj(),
            self.orders,
            self.shape.conj(),
            self.participation.conj(),
        )

    def static_compliance(self, x0: float) -> NDArray:
        """Return the static compliance for a force at x0, shape (3, 3), m/N."""
        return self.receptance([0.0], x0)[0].real


def close_supported_ring(
    section: ReducedSection, *, supports: Supports, length: float, max_frequency: float
) -> SupportedRing:
    """Put a free rail on supports, close it to a ring and find its modes.

    Parameters
    ----------
    section : ReducedSection
        Of a free rail, its outputs being the head's x', y', z' and the foot's x', y', z' and rotation about x'.
    supports : Supports
    length : float
        Shortest length of the ring, m.
    max_frequency : float
        Highest frequency of the free rail's waves, Hz.

    Returns
    -------
    SupportedRing
    """
    half = int(np.ceil(0.5 * length / supports.spacing))
    bays = 2 * half
    waves: list[SectionWaves] = []
    while True:
        found = section.waves(2.0 * np.pi * len(waves) / (bays * supports.spacing), max_frequency)
        if len(found.omega) == 0:
            break
        waves.append(found)
    largest = len(waves) // bays + 1
    orders = np.arange(-largest - 1, largest + 1)
    # The mirror image of a wave has the opposite axial displacement.
    flip = np.ones(section.outputs.shape[0])
    flip[_AXIAL] = -1.0
    support = supports.matrices()
    kappas, poles, shapes, participations = [], [], [], []
    for j in range(half + 1):
        members = [(order, j + bays * order) for order in range(-largest - 1, largest + 1)]
        members = [(order, number) for order, number in members if abs(number) < len(waves)]
        column = np.concatenate([np.full(len(waves[abs(n)].omega), order + largest + 1) for order, n in members])
        omega = np.concatenate([waves[abs(n)].omega for _, n in members])
        damping = np.concatenate([waves[abs(n)].loss_factor for _, n in members]) * omega
        outputs = np.hstack([waves[abs(n)].outputs * (flip if n < 0 else np.ones(7))[:, None] for _, n in members])
        pole, shape, participation = _modes(omega, damping, outputs, supports, support)
        by_order = np.zeros((2, len(pole), len(orders), 3), dtype=complex)
        for place in np.unique(column):
            of = column == place
            by_order[0, :, place] = (outputs[:3, of] @ shape[of]).T
            by_order[1, :, place] = participation[:, of] @ outputs[:3, of].T
        kappas.append(np.full(len(pole), 2.0 * np.pi * j / (bays * supports.spacing)))
        poles.append(pole)
        shapes.append(by_order[0])
        participations.append(by_order[1])
    used = np.any(np.concatenate(shapes) != 0.0, axis=(0, 2))
    return SupportedRing(
        supports.spacing,
        bays,
        np.concatenate(kappas),
        np.concatenate(poles),
        orders[used],
        np.concatenate(shapes)[:, used],
        np.concatenate(participations)[:, used],
    )


def _modes(
    omega: NDArray, damping: NDArray, outputs: NDArray, supports: Supports, support: tuple[NDArray, NDArray]
) -> tuple[NDArray, NDArray, NDArray]:
    """Eigenvalues (imaginary part >= 0), rail shapes (waves, modes) and participations (modes, waves) of one kappa."""
    count = len(omega)
    size = count + 3
    rows = np.zeros((7, size))
    rows[:4, :count] = outputs[3:]
    rows[4:, count:] = np.eye(3)
    mass = np.concatenate([np.full(count, supports.spacing), np.full(3, supports.sleeper_mass)])
    stiffness = np.diag(np.concatenate([supports.spacing * omega**2, np.zeros(3)])) + rows.T @ support[0] @ rows
    viscous = np.diag(np.concatenate([supports.spacing * damping, np.zeros(3)])) + rows.T @ support[1] @ rows
    # Velocities in units of a typical frequency, so that the matrix is balanced.
    unit = max(float(omega.max()), 1.0)
    system = np.zeros((2 * size, 2 * size))
    system[:size, size:] = unit * np.eye(size)
    system[size:, :size] = -stiffness / mass[:, None] / unit
    system[size:, size:] = -viscous / mass[:, None]
    poles, vectors = np.linalg.eig(system)
    drive = np.zeros((2 * size, count))
    drive[size : size + count] = np.eye(count) / (supports.spacing * unit)
    participation = np.linalg.solve(vectors, drive.astype(complex))
    kept = np.imag(poles) >= 0.0
    return poles[kept], vectors[:count, kept], participation[kept]
