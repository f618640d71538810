"""Waves of a rail at given frequencies, and its response to point forces as their superposition.

With complex moduli the wavenumbers of given frequencies are complex (Pieringer 2011, eq. 3.20-3.22). Scaling the axial
unknown by k makes the problem linear in k^2 at its own size, and since K(k) is symmetric the waves themselves are their
own left eigenvectors, so that the residue of each pole needs no other solution.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eig
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import LinearOperator, eigs, splu

from .safe_matrices import SectionMatrices

__all__ = ["RailWaves", "receptance", "static_compliance", "waves_at"]

NUMBER_OF_WAVES = 40  # pairs kept, those that reach furthest
_SHIFT = 100.0j  # 1/m^2; of k^2, away from the waves, all of which lie near the axes or below
_DENSE = 300  # unknowns up to which all waves are found at once
_TRAVELLING = 1e-6  # |Im k| below this share of |k|: no damping shows which way a wave goes

MIXED = np.array([[False, True, True], [True, False, False], [True, False, False]])
"""Pairs of the longitudinal with another direction; they change sign with the distance."""


@dataclass(frozen=True, eq=False)
class RailWaves:
    """Waves of one frequency that go or decay towards +x; those towards -x are their mirror images.

    Parameters
    ----------
    frequency : float
        Hz.
    wavenumber : ndarray of complex, shape (n,)
        rad/m, in exp(-i k x), ascending in absolute value; the imaginary part is negative or 0.
    shapes : ndarray of complex, shape (unknowns, n)
        The axial unknown is -i times the axial displacement. Scaled so that U^T (dK/dk) U = 1.
    """

    frequency: float
    wavenumber: NDArray
    shapes: NDArray

    def decay(self) -> NDArray:
        """Return the decay of each wave along the rail in dB/m, shape (n,)."""
        return -20.0 / np.log(10.0) * np.imag(self.wavenumber)

    def propagating(self, most: float = 0.2) -> NDArray:
        """Return which waves travel, with |Im k| at most ``most`` times Re k; shape (n,)."""
        return np.abs(np.imag(self.wavenumber)) <= most * np.abs(np.real(self.wavenumber))

    def transfer(self, x: ArrayLike, *, responses: NDArray, forces: NDArray) -> NDArray:
        """Response at distances ``x`` of point forces at 0 (Pieringer 2011, eq. 3.22).

        Parameters
        ----------
        x : array_like, shape (k,)
            m; x = 0 gives the mean of both sides.
        responses, forces : ndarray, shape (3, unknowns)
            Rows that give the displacements (x', y', z') of the points.

        Returns
        -------
        ndarray of complex, shape (k, 3, 3)
            [distance, displacement, force], m/N.
        """
        x = np.atleast_1d(np.asarray(x, dtype=float))
        # True axial displacements are i times the unknown, and the force that goes with it -i times the true one.
        turn = np.array([1j, 1.0, 1.0])
        answer = turn[:, None] * (responses @ self.shapes)
        drive = turn.conj()[:, None] * (forces @ self.shapes)
        decay = np.exp(-1j * np.abs(x)[:, None] * self.wavenumber)
        result = -1j * np.einsum("in,kn,jn->kij", answer, decay, drive, optimize=True)
        return result * np.where(MIXED, np.sign(x)[:, None, None], 1.0)


def waves_at(
    matrices: SectionMatrices, *, frequency: float, lossy: bool = True, number: int = NUMBER_OF_WAVES
) -> RailWaves:
    """Find the waves of one frequency.

    Parameters
    ----------
    matrices : SectionMatrices
    frequency : float
        Hz; 0 for a supported rail only.
    lossy : bool
        Whether the moduli are complex.
    number : int
        Pairs of waves to be found, those with the least |k|.

    Returns
    -------
    RailWaves

    Raises
    ------
    ValueError
        If the rail is free and the frequency 0.
    """
    if frequency == 0.0 and not matrices.supported:
        raise ValueError("a free rail has no finite answer at 0 Hz")
    k0, k1, k2 = matrices.combined(lossy=lossy)
    dynamic = k0 - (2.0 * np.pi * frequency) ** 2 * matrices.mass
    axial, rest = matrices.axial, slice(matrices.lateral.start, matrices.size)
    coupling = k1[axial, rest]
    first = bmat([[dynamic[axial, axial], coupling], [None, dynamic[rest, rest]]], format="csc")
    second = bmat([[k2[axial, axial], None], [coupling.T, k2[rest, rest]]], format="csc")
    squares, vectors = _nearest(first, second, min(number, matrices.size))
    wavenumber = np.sqrt(squares)
    order = np.argsort(np.abs(wavenumber))
    wavenumber, shapes = wavenumber[order], vectors[:, order]
    shapes[axial] *= wavenumber
    slope = _slope(k1, k2, wavenumber, shapes)
    backward = np.imag(wavenumber) > 0.0
    travelling = np.abs(np.imag(wavenumber)) < _TRAVELLING * np.abs(wavenumber)
    # Without loss, the way a wave goes is that of its energy.
    energy = np.real(np.einsum("in,in->n", shapes.conj(), k1 @ shapes + (k2 @ shapes) * (2.0 * np.real(wavenumber))))
    backward = np.where(travelling, energy < 0.0, backward)
    wavenumber = np.where(backward, -wavenumber, wavenumber)
    shapes[axial] *= np.where(backward, -1.0, 1.0)
    slope = np.where(backward, -slope, slope)
    return RailWaves(frequency, wavenumber, shapes / np.sqrt(slope))


def _slope(k1: csr_matrix, k2: csr_matrix, wavenumber: NDArray, shapes: NDArray) -> NDArray:
    """U^T (dK/dk) U of each wave."""
    return np.einsum("in,in->n", shapes, k1 @ shapes + (k2 @ shapes) * (2.0 * wavenumber))


def _nearest(first: Any, second: Any, number: int) -> tuple[NDArray, NDArray]:
    """Solve (first + k^2 second) y = 0 for the k^2 nearest to the shift: values (n,) and vectors (size, n)."""
    size = first.shape[0]
    if size <= _DENSE or number >= size - 1:
        squares, vectors = eig(-first.toarray(), second.toarray())[:2]
        order = np.argsort(np.abs(squares))[:number]
        return squares[order], vectors[:, order]
    factors = splu((first + _SHIFT * second).astype(complex).tocsc())

    def apply(vector: NDArray) -> NDArray:
        return factors.solve(second @ vector)

    operator = LinearOperator((size, size), matvec=apply, dtype=complex)  # type: ignore[call-arg]
    inverse, vectors = eigs(operator, k=number, v0=np.ones(size, dtype=complex), ncv=min(size, 2 * number + 20))[:2]
    return _SHIFT - 1.0 / inverse, vectors


def receptance(
    matrices: SectionMatrices, *, frequency: ArrayLike, x: ArrayLike = 0.0, number: int = NUMBER_OF_WAVES
) -> NDArray:
    """Receptances between points of the rail head at the contact's lateral position.

    Parameters
    ----------
    matrices : SectionMatrices
    frequency : array_like, shape (m,)
        Hz.
    x : array_like, shape (k,)
        Distance of the response from the force, m.
    number : int
        Pairs of waves in the sum. More of them add to the deformation close to the force.

    Returns
    -------
    ndarray of complex, shape (m, k, 3, 3)
        [frequency, distance, displacement, force], directions (x', y', z'), m/N, time factor exp(+i omega t).
    """
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    head = matrices.head_rows
    return np.array(
        [waves_at(matrices, frequency=f, number=number).transfer(x, responses=head, forces=head) for f in lines]
    )


def static_compliance(matrices: SectionMatrices, *, x: ArrayLike = 0.0, number: int = NUMBER_OF_WAVES) -> NDArray:
    """Return the static displacement of the head of a supported rail per point force on it, without loss.

    Parameters
    ----------
    matrices : SectionMatrices
    x : array_like, shape (k,)
        Distance of the response from the force, m.
    number : int
        Pairs of waves in the sum.

    Returns
    -------
    ndarray, shape (k, 3, 3)
        [distance, displacement, force], m/N.
    """
    waves = waves_at(matrices, frequency=0.0, lossy=False, number=number)
    return np.real(waves.transfer(x, responses=matrices.head_rows, forces=matrices.head_rows))
