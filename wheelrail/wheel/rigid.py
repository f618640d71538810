"""Rigid wheels on the primary suspension, with one or two degrees of freedom (Pieringer 2011, section 3.2.1).

The wheel is seen from the contact: displacement positive into the rail (z'), force positive in the same direction, so
that the displacement under contact force F and vehicle force P is the response to P - F.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm

__all__ = ["RigidWheel"]


@dataclass(frozen=True)
class RigidWheel:
    """A wheel of one or two masses.

    Parameters
    ----------
    mass_matrix, damping_matrix, stiffness_matrix : ndarray, shape (n, n)
        In kg, N s/m and N/m; the last degree of freedom is the one in contact.
    """

    mass_matrix: NDArray
    damping_matrix: NDArray
    stiffness_matrix: NDArray

    @classmethod
    def one_dof(cls, *, mass: float, suspension_stiffness: float, suspension_damping: float) -> RigidWheel:
        """Mass M_W on the primary suspension k_S, c_S (kg, N/m, N s/m); 0 and 0 leave it unsprung."""
        return cls(np.array([[mass]]), np.array([[suspension_damping]]), np.array([[suspension_stiffness]]))

    @classmethod
    def two_dof(
        cls,
        *,
        mass: float,
        suspension_stiffness: float,
        suspension_damping: float,
        contact_mass: float,
        contact_stiffness: float,
        contact_damping: float,
    ) -> RigidWheel:
        """Mass M_W on its suspension, and m_W on k_W, c_W between it and the contact (kg, N/m, N s/m)."""
        pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
        return cls(
            np.diag([mass, contact_mass]),
            np.diag([suspension_damping, 0.0]) + contact_damping * pair,
            np.diag([suspension_stiffness, 0.0]) + contact_stiffness * pair,
        )

    def held(self) -> RigidWheel | None:
        """Return what is left when the vehicle model owns and moves the wheel's mass (coupling by displacement).

        Returns
        -------
        RigidWheel or None
            The contact mass on its spring, relative to the wheel; None for a single mass.
        """
        if len(self.mass_matrix) == 1:
            return None
        return RigidWheel(self.mass_matrix[1:, 1:], self.damping_matrix[1:, 1:], self.stiffness_matrix[1:, 1:])

    def receptance(self, frequency: ArrayLike) -> NDArray:
        """Vertical point receptance at the contact (Pieringer 2011, eq. 3.1).

        Parameters
        ----------
        frequency : array_like, shape (m,)
            In Hz.

        Returns
        -------
        ndarray of complex, shape (m,)
            m/N, time factor exp(+i omega t).
        """
        omega = 2.0 * np.pi * np.atleast_1d(np.asarray(frequency, dtype=float))[:, None, None]
        dynamic = self.stiffness_matrix + 1j * omega * self.damping_matrix - omega**2 * self.mass_matrix
        unit = np.zeros((len(self.mass_matrix), 1))
        unit[-1] = 1.0
        return np.linalg.solve(dynamic, np.broadcast_to(unit, (len(dynamic), *unit.shape)))[:, -1, 0]

    def state_space(self) -> tuple[NDArray, NDArray, NDArray]:
        """State matrices of d/dt s = A s + b f, displacement = c s, with s = (displacements, velocities).

        Returns
        -------
        A : ndarray, shape (2 n, 2 n)
        b, c : ndarray, shape (2 n,)
        """
        n = len(self.mass_matrix)
        inverse = np.linalg.inv(self.mass_matrix)
        A = np.block(
            [[np.zeros((n, n)), np.eye(n)], [-inverse @ self.stiffness_matrix, -inverse @ self.damping_matrix]]
        )
        b = np.concatenate([np.zeros(n), inverse[:, -1]])
        c = np.zeros(2 * n)
        c[n - 1] = 1.0
        return A, b, c

    def impulse_response(self, dt: float, n: int) -> NDArray:
        """Green's function g_33 of the contact displacement, sampled at 0, dt, ... (n - 1) dt.

        Parameters
        ----------
        dt : float
            Sampling interval in s.
        n : int
            Number of samples.

        Returns
        -------
        ndarray, shape (n,)
            m/(N s); exact at the samples.
        """
        A, b, c = self.state_space()
        step = expm(A * dt)
        values = np.empty(n)
        state = b
        for i in range(n):
            values[i] = c @ state
            state = step @ state
        return values
