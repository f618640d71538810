"""Dispersion of a rail without loss: the frequencies of its waves for given wavenumbers, and what to call the waves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import eigsh

from .safe_matrices import SectionMatrices

__all__ = ["Dispersion", "cut_on_frequencies", "disperse", "name_waves"]

_SHIFT = -((2.0 * np.pi * 200.0) ** 2)  # below all frequencies, also those of a free rail at k = 0
_RIGID = 0.5  # least share of kinetic energy in motion of the undeformed section for the names that go with it
_MIDDLE = 0.06  # nodes within this share of the section's width beside its middle are the web


@dataclass(frozen=True, eq=False)
class Dispersion:
    """Waves of a rail without loss, followed along the wavenumber.

    Parameters
    ----------
    wavenumber : ndarray, shape (m,)
        rad/m.
    frequency : ndarray, shape (m, n)
        Hz; a column follows one wave.
    group_velocity : ndarray, shape (m, n)
        d omega / dk in m/s.
    shapes : ndarray, shape (m, unknowns, n)
        Scaled to unit mass per length; the axial unknown is -i times the axial displacement.
    names : tuple of str
        Of each wave, from its motion at the first wavenumber.
    """

    wavenumber: NDArray
    frequency: NDArray
    group_velocity: NDArray
    shapes: NDArray
    names: tuple[str, ...]


def disperse(matrices: SectionMatrices, wavenumber: ArrayLike, *, number: int = 8) -> Dispersion:
    """Find the lowest waves of each wavenumber.

    Parameters
    ----------
    matrices : SectionMatrices
    wavenumber : array_like, shape (m,)
        rad/m, ascending; close enough together for the waves' shapes to be recognised.
    number : int
        Waves of each wavenumber.

    Returns
    -------
    Dispersion
    """
    wavenumber = np.atleast_1d(np.asarray(wavenumber, dtype=float))
    k0, k1, k2 = matrices.combined(lossy=False)
    omegas, speeds, shapes = [], [], []
    for k in wavenumber:
        squares, vectors = _solve(matrices, k0 + k * (k1 + k * k2), number)
        if shapes:
            overlap = np.abs(shapes[-1].T @ (matrices.mass @ vectors))
            _, order = linear_sum_assignment(-(overlap**2))
            squares, vectors = squares[order], vectors[:, order]
        omega = np.sqrt(np.maximum(squares, 0.0))
        slope = np.einsum("in,in->n", vectors, k1 @ vectors + 2.0 * k * (k2 @ vectors))
        omegas.append(omega)
        speeds.append(0.5 * slope / np.maximum(omega, 1e-6))
        shapes.append(vectors)
    return Dispersion(
        wavenumber,
        np.array(omegas) / (2.0 * np.pi),
        np.array(speeds),
        np.array(shapes),
        name_waves(matrices, shapes[0]),
    )


def cut_on_frequencies(matrices: SectionMatrices, *, number: int = 8) -> NDArray:
    """Return the lowest frequencies at which waves of endless length exist, k = 0, in Hz; shape (number,).

    A free rail has four of 0 Hz.
    """
    squares, _ = _solve(matrices, matrices.combined(lossy=False)[0], number)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)


def _solve(matrices: SectionMatrices, stiffness: csr_matrix, number: int) -> tuple[NDArray, NDArray]:
    squares, vectors = eigsh(
        stiffness.tocsc(),
        number,
        M=matrices.mass,
        sigma=_SHIFT,
        v0=np.ones(matrices.size),
    )
    order = np.argsort(squares)
    return squares[order], vectors[:, order]


def name_waves(matrices: SectionMatrices, shapes: NDArray) -> tuple[str, ...]:
    """Name waves by their motion.

    A wave most of whose motion is that of a section that keeps its form is called longitudinal, vertical bending,
    lateral bending or torsion, whichever share is the largest. The others are called web bending if the web moves
    sideways and foot bending if it doesn't, and numbered in the order given. A second wave of a name of the first kind
    gets a number too: vertical bending 2 is that of the beam's shear.

    Parameters
    ----------
    matrices : SectionMatrices
    shapes : ndarray, shape (unknowns, n)

    Returns
    -------
    tuple of str
    """
    y, z = matrices.mesh.doflocs[:, matrices.node] * [[1.0], [-1.0]]
    one, zero = np.ones_like(y), np.zeros_like(y)
    weights = matrices.mass[matrices.lateral, matrices.lateral] @ one
    y, z = y - weights @ y / weights.sum(), z - weights @ z / weights.sum()
    motions = {
        "longitudinal": [(one, zero, zero)],
        "vertical bending": [(zero, zero, one), (z, zero, zero)],
        "lateral bending": [(zero, one, zero), (y, zero, zero)],
        "torsion": [(zero, -z, y)],
    }
    energy = np.einsum("in,in->n", shapes.conj(), matrices.mass @ shapes).real
    shares = {}
    for name, parts in motions.items():
        basis = np.column_stack([np.concatenate(part) for part in parts])
        moved = matrices.mass @ basis
        amount = np.linalg.solve(basis.T @ moved, moved.T @ shapes)
        shares[name] = np.einsum("in,ij,jn->n", amount.conj(), basis.T @ moved, amount).real / energy
    web = np.abs(matrices.mesh.doflocs[0, matrices.node]) <= _MIDDLE * np.ptp(matrices.mesh.p[0])
    sideways = np.sum(np.abs(shapes[matrices.lateral][web]) ** 2, axis=0)
    upright = np.sum(np.abs(shapes[matrices.vertical][web]) ** 2, axis=0)
    upright += np.sum(np.abs(shapes[matrices.axial][web]) ** 2, axis=0)
    names: list[str] = []
    count: dict[str, int] = {}
    for i in range(shapes.shape[1]):
        rigid = {name: share[i] for name, share in shares.items()}
        if sum(rigid.values()) >= _RIGID:
            name = max(rigid, key=lambda name: rigid[name])
        else:
            name = "web bending" if sideways[i] > upright[i] else "foot bending"
        count[name] = count.get(name, 0) + 1
        plain = name in motions and count[name] == 1
        names.append(name if plain else f"{name} {count[name]}")
    return tuple(names)
