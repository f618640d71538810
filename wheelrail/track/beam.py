"""The two-node Rayleigh-Timoshenko beam element with shear-dependent cubic shape functions.

Degrees of freedom per element: (w1, theta1, w2, theta2), deflection w positive down (z'), theta = dw/dx - gamma the
rotation of the cross-section. The shape functions solve the static beam equations without load exactly, so point forces
inside an element act through them and static deflections at the nodes are exact. Under the force itself the element
bends more than its nodes tell; `local_compliance` is what is missing. Left out, a rolling force would find the rail
stiffer in every element's middle (1 % with 8 elements per bay) and be excited at the element passing frequency.

Sources: Przemieniecki (1968), Theory of Matrix Structural Analysis, sections 5.6 and 11.5; Nielsen and Igeland (1995).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["element_matrices", "local_compliance", "shape_functions", "shear_parameter"]


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


def local_compliance(
    s0: ArrayLike, s: ArrayLike, *, length: float, bending_stiffness: float, shear_stiffness: float
) -> NDArray:
    """Compute the static deflection inside an element with clamped ends, under a unit force inside it.

    Parameters
    ----------
    s0, s : array_like
        Positions of force and response in the element divided by its length, 0 to 1; broadcast against each other.
    length : float
        Element length in m.
    bending_stiffness, shear_stiffness : float
        EI in N m2 and kGA in N.

    Returns
    -------
    ndarray
        m/N; symmetric in force and response, 0 at the ends.
    """
    s0, s = np.broadcast_arrays(np.asarray(s0, dtype=float), np.asarray(s, dtype=float))
    # The smaller distance from an end decides which part the response is in; by reciprocity it may always be the left.
    force, response = np.maximum(s0, s), np.minimum(s0, s)
    inside = (force > 0.0) & (force < 1.0) & (response > 0.0)
    force = np.where(inside, force, 0.5)
    left, right = force * length, (1.0 - force) * length
    # Two elements joined under the force: exact, since both carry no load between their ends.
    phi_left, phi_right = (
        shear_parameter(length=part, bending_stiffness=bending_stiffness, shear_stiffness=shear_stiffness)  # type: ignore[arg-type]
        for part in (left, right)
    )
    stiff_left = bending_stiffness / (left**3 * (1.0 + phi_left))
    stiff_right = bending_stiffness / (right**3 * (1.0 + phi_right))
    k_ww = 12.0 * (stiff_left + stiff_right)
    k_wt = 6.0 * (right * stiff_right - left * stiff_left)
    k_tt = (4.0 + phi_left) * left**2 * stiff_left + (4.0 + phi_right) * right**2 * stiff_right
    determinant = k_ww * k_tt - k_wt**2
    deflection, rotation = k_tt / determinant, -k_wt / determinant
    t = np.where(inside, response / force, 0.0)
    scale = 1.0 / (1.0 + phi_left)
    shape_w = scale * (3.0 * t**2 - 2.0 * t**3 + phi_left * t)
    shape_t = scale * left * (-(t**2) + t**3 - 0.5 * phi_left * (t - t**2))
    return np.where(inside, shape_w * deflection + shape_t * rotation, 0.0)
