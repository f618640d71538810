"""The two-node Rayleigh-Timoshenko beam element with shear-dependent cubic shape functions.

Degrees of freedom per element: (w1, theta1, w2, theta2), deflection w positive down (z'), theta = dw/dx - gamma the
rotation of the cross-section. The shape functions solve the static beam equations exactly, so point forces inside an
element act through them and static deflections at the nodes are exact.

Sources: Przemieniecki (1968), Theory of Matrix Structural Analysis, sections 5.6 and 11.5; Nielsen and Igeland (1995).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["element_matrices", "shape_functions"]


def shear_parameter(*, length: float, bending_stiffness: float, shear_stiffness: float) -> float:
    """Return Phi = 12 EI / (kGA L^2), the ratio of bending to shear stiffness (Przemieniecki 1968, eq. 5.117)."""
    return 12.0 * bending_stiffness / (shear_stiffness * length**2)


def shape_functions(s: ArrayLike, *, length: float, phi: float) -> tuple[NDArray, NDArray]:
    """Evaluate the shape functions of deflection and of rotation.

    Parameters
    ----------
    s : array_like, shape (...)
        Position in the element divided by its length, 0 <= s <= 1.
    length : float
        Element length in m.
    phi : float
        Shear parameter, see `shear_parameter`.

    Returns
    -------
    deflection : ndarray, shape (..., 4)
        w = deflection @ (w1, theta1, w2, theta2).
    rotation : ndarray, shape (..., 4)
        theta = rotation @ (w1, theta1, w2, theta2).
    """
    s = np.asarray(s, dtype=float)
    scale = 1.0 / (1.0 + phi)
    deflection = np.stack(
        [
            1.0 - 3.0 * s**2 + 2.0 * s**3 + phi * (1.0 - s),
            length * (s - 2.0 * s**2 + s**3 + 0.5 * phi * (s - s**2)),
            3.0 * s**2 - 2.0 * s**3 + phi * s,
            length * (-(s**2) + s**3 - 0.5 * phi * (s - s**2)),
        ],
        axis=-1,
    )
    rotation = np.stack(
        [
            6.0 * (s**2 - s) / length,
            1.0 - 4.0 * s + 3.0 * s**2 + phi * (1.0 - s),
            6.0 * (s - s**2) / length,
            3.0 * s**2 - 2.0 * s + phi * s,
        ],
        axis=-1,
    )
    return scale * deflection, scale * rotation


def element_matrices(
    *,
    length: float,
    bending_stiffness: float,
    shear_stiffness: float,
    mass_per_length: float,
    rotary_inertia: float,
) -> tuple[NDArray, NDArray]:
    """Stiffness and consistent mass matrix of one element.

    Parameters
    ----------
    length : float
        Element length in m.
    bending_stiffness, shear_stiffness : float
        EI in N m2 and kGA in N.
    mass_per_length, rotary_inertia : float
        m' in kg/m and rho I in kg m.

    Returns
    -------
    stiffness, mass : ndarray, shape (4, 4)
        In (w1, theta1, w2, theta2).
    """
    phi = shear_parameter(length=length, bending_stiffness=bending_stiffness, shear_stiffness=shear_stiffness)
    L = length
    stiffness = (
        bending_stiffness
        / (L**3 * (1.0 + phi))
        * np.array(
            [
                [12.0, 6.0 * L, -12.0, 6.0 * L],
                [6.0 * L, (4.0 + phi) * L**2, -6.0 * L, (2.0 - phi) * L**2],
                [-12.0, -6.0 * L, 12.0, -6.0 * L],
                [6.0 * L, (2.0 - phi) * L**2, -6.0 * L, (4.0 + phi) * L**2],
            ]
        )
    )
    # Products of the cubic shape functions are of degree 6: four Gauss points integrate them exactly.
    points, weights = np.polynomial.legendre.leggauss(4)
    deflection, rotation = shape_functions(0.5 * (points + 1.0), length=L, phi=phi)
    mass = 0.5 * L * np.einsum("g,gi,gj->ij", weights, mass_per_length * deflection, deflection)
    mass += 0.5 * L * np.einsum("g,gi,gj->ij", weights, rotary_inertia * rotation, rotation)
    return stiffness, mass
