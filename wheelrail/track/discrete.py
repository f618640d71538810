"""Track on discrete supports: Rayleigh-Timoshenko rail on pads, sleepers and ballast (Pieringer 2011, section 3.3.1).

The rail is a chain of identical bays between clamped ends. Position x is measured from the middle sleeper, so that
x = 0 lies over a sleeper and x = sleeper_spacing / 2 at midspan.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import solve_banded, solveh_banded

from .beam import element_matrices, local_compliance, shape_functions, shear_parameter
from .chain import ChainStepper

__all__ = ["DiscreteTrack"]

HALF_BANDWIDTH = 3  # of the rail's matrices: an element joins the two degrees of freedom of two neighbouring nodes


@dataclass(frozen=True, kw_only=True)
class DiscreteTrack:
    """Rail, pads, sleepers and ballast of one track.

    Parameters
    ----------
    bending_stiffness, shear_stiffness : float
        Rail EI in N m2 and kGA in N.
    mass_per_length, rotary_inertia : float
        Rail m' in kg/m and rho I in kg m.
    sleeper_spacing : float
        L_s in m.
    bays, elements_per_bay : int
        Number of bays (even, so that a sleeper stands in the middle) and of elements in each.
    pad_stiffness, pad_damping : float
        k_P in N/m and c_P in N s/m.
    sleeper_mass : float
        Half a sleeper's mass m_S in kg.
    ballast_stiffness, ballast_damping : float
        k_B in N/m and c_B in N s/m.
    """

    bending_stiffness: float
    shear_stiffness: float
    mass_per_length: float
    rotary_inertia: float
    sleeper_spacing: float
    bays: int
    elements_per_bay: int
    pad_stiffness: float
    pad_damping: float
    sleeper_mass: float
    ballast_stiffness: float
    ballast_damping: float
    _phi: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(
            self,
            "_phi",
            shear_parameter(
                length=self.element_length,
                bending_stiffness=self.bending_stiffness,
                shear_stiffness=self.shear_stiffness,
            ),
        )

    @property
    def element_length(self) -> float:
        """Length of a rail element in m."""
        return self.sleeper_spacing / self.elements_per_bay

    @property
    def nodes(self) -> int:
        """Number of rail nodes, the two clamped ones included."""
        return self.bays * self.elements_per_bay + 1

    @property
    def half_length(self) -> float:
        """Distance from the middle sleeper to a clamped end in m."""
        return 0.5 * self.bays * self.sleeper_spacing

    @property
    def degrees_of_freedom(self) -> int:
        """Free degrees of freedom of rail and sleepers."""
        return 2 * (self.nodes - 2) + self.bays - 1

    def element_matrices(self) -> tuple[NDArray, NDArray]:
        """Stiffness and mass matrix of one rail element, each of shape (4, 4)."""
        return element_matrices(
            length=self.element_length,
            bending_stiffness=self.bending_stiffness,
            shear_stiffness=self.shear_stiffness,
            mass_per_length=self.mass_per_length,
            rotary_inertia=self.rotary_inertia,
        )

    def rail_bands(self) -> tuple[NDArray, NDArray]:
        """Stiffness and mass of the free rail without supports, clamped nodes removed.

        Returns
        -------
        stiffness, mass : ndarray, shape (4, 2 * (nodes - 2))
            Lower bands as `scipy.linalg.solveh_banded` takes them: row d holds the d-th subdiagonal.
        """
        size = 2 * self.nodes
        bands = np.zeros((2, HALF_BANDWIDTH + 1, size))
        for matrix, band in zip(self.element_matrices(), bands, strict=True):
            for i in range(4):
                for j in range(i + 1):
                    columns = np.arange(self.nodes - 1) * 2 + j
                    band[i - j, columns] += matrix[i, j]
        bands = bands[:, :, 2:-2].copy()
        for d in range(1, HALF_BANDWIDTH + 1):
            bands[:, d, -d:] = 0.0  # these couple to the clamped end
        return bands[0], bands[1]

    def support_columns(self) -> NDArray:
        """Return the indices of supported deflections among the rail's free degrees of freedom; (bays - 1,)."""
        return 2 * (np.arange(1, self.bays) * self.elements_per_bay - 1)

    def support_stiffness(self, frequency: ArrayLike) -> NDArray:
        """Dynamic stiffness of one support as the rail feels it, pad in series with sleeper on ballast, in N/m.

        Parameters
        ----------
        frequency : array_like, shape (...)
            In Hz.

        Returns
        -------
        ndarray of complex, shape (...)
        """
        omega = 2.0 * np.pi * np.asarray(frequency, dtype=float)
        pad = self.pad_stiffness + 1j * omega * self.pad_damping
        below = self.ballast_stiffness + 1j * omega * self.ballast_damping - self.sleeper_mass * omega**2
        return pad * below / (pad + below)

    def interpolation(self, position: ArrayLike) -> tuple[NDArray, NDArray]:
        """Degrees of freedom and shape functions by which a point of the rail moves.

        Parameters
        ----------
        position : array_like, shape (n,)
            x in m from the middle sleeper.

        Returns
        -------
        columns : ndarray of int, shape (n, 4)
            Indices into the rail's free degrees of freedom; -1 or beyond the last for a clamped node.
        weights : ndarray, shape (n, 4)
            Shape functions; zero for a clamped node.

        Raises
        ------
        ValueError
            If a point lies outside the track.
        """
        along = (np.atleast_1d(np.asarray(position, dtype=float)) + self.half_length) / self.element_length
        if np.any(along < 0.0) or np.any(along > self.nodes - 1):
            raise ValueError(f"position must lie within +-{self.half_length:g} m of the middle sleeper")
        element = np.minimum(along.astype(int), self.nodes - 2)
        weights, _ = shape_functions(along - element, length=self.element_length, phi=self._phi)
        columns = 2 * (element[:, None] - 1) + np.arange(4)
        free = (columns >= 0) & (columns < 2 * (self.nodes - 2))
        return columns, np.where(free, weights, 0.0)

    def _local_compliance(self, x0: float, x: ArrayLike) -> NDArray:
        """Return the static deflection at ``x`` that the nodes don't show; m/N, 0 outside the element of ``x0``."""
        along = (np.concatenate([[x0], np.atleast_1d(x)]) + self.half_length) / self.element_length
        element = np.minimum(along.astype(int), self.nodes - 2)
        inside = along - element
        local = local_compliance(
            inside[0],
            inside[1:],
            length=self.element_length,
            bending_stiffness=self.bending_stiffness,
            shear_stiffness=self.shear_stiffness,
        )
        return np.where(element[1:] == element[0], local, 0.0)

    def bay_local_compliance(self, positions: int) -> NDArray:
        """Return the deflection under a force that the nodes don't show, at the points of `bay_shape_functions`.

        Returns
        -------
        ndarray, shape (positions,)
            m/N; quasi-static, since the element's own resonances lie far above the frequencies of interest.
        """
        along = np.arange(positions) * (self.elements_per_bay / positions)
        inside = along - along.astype(int)
        return local_compliance(
            inside,
            inside,
            length=self.element_length,
            bending_stiffness=self.bending_stiffness,
            shear_stiffness=self.shear_stiffness,
        )

    def bay_shape_functions(self, positions: int) -> NDArray:
        """Shape functions at equidistant points of one bay, from its sleeper on, the next sleeper not included.

        Returns
        -------
        ndarray, shape (positions, 2 (elements_per_bay + 1))
            Weights of the bay's nodal degrees of freedom (w, theta per node).
        """
        along = np.arange(positions) * (self.elements_per_bay / positions)
        element = np.minimum(along.astype(int), self.elements_per_bay - 1)
        weights, _ = shape_functions(along - element, length=self.element_length, phi=self._phi)
        result = np.zeros((positions, 2 * (self.elements_per_bay + 1)))
        np.put_along_axis(result, 2 * element[:, None] + np.arange(4), weights, axis=1)
        return result

    def motion(self, dt: float) -> ChainStepper:
        """Free motion after short unit forces on the bay right of the middle sleeper, in steps of ``dt`` seconds."""
        return ChainStepper(self, dt)

    def receptance(self, x0: float, x: ArrayLike, frequency: ArrayLike) -> NDArray:
        """Vertical receptance between points of the rail (Pieringer 2011, eq. 3.12 before its transform).

        Parameters
        ----------
        x0 : float
            Position of the force in m.
        x : array_like, shape (n,)
            Positions of the response in m.
        frequency : array_like, shape (m,)
            In Hz; 0 gives the static compliance.

        Returns
        -------
        ndarray of complex, shape (m, n)
            Displacement per force in m/N, time factor exp(+i omega t).
        """
        stiffness, mass = self.rail_bands()
        size = stiffness.shape[1]
        frequency = np.atleast_1d(np.asarray(frequency, dtype=float))
        supports = self.support_stiffness(frequency)
        source, source_weight = self.interpolation(x0)
        force = np.zeros(size, dtype=complex)
        inside = source_weight[0] != 0.0
        force[source[0, inside]] = source_weight[0, inside]
        columns, weights = self.interpolation(x)
        columns = np.where(weights != 0.0, columns, 0)
        at_supports = self.support_columns()
        band = np.zeros((2 * HALF_BANDWIDTH + 1, size), dtype=complex)
        result = np.empty((len(frequency), len(columns)), dtype=complex)
        for line, (f, support) in enumerate(zip(frequency, supports, strict=True)):
            lower = stiffness - (2.0 * np.pi * f) ** 2 * mass
            band[HALF_BANDWIDTH:] = lower
            for d in range(1, HALF_BANDWIDTH + 1):
                band[HALF_BANDWIDTH - d, d:] = lower[d, :-d]
            band[HALF_BANDWIDTH, at_supports] += support
            response = solve_banded((HALF_BANDWIDTH, HALF_BANDWIDTH), band, force, check_finite=False)
            result[line] = np.einsum("ij,ij->i", weights, response[columns])
        return result + self._local_compliance(x0, x)

    def static_compliance(self, x0: float, x: ArrayLike) -> NDArray:
        """Return the static deflection at ``x`` per force at ``x0`` in m/N, shape (n,)."""
        stiffness, _ = self.rail_bands()
        stiffness[0, self.support_columns()] += np.real(self.support_stiffness(0.0))
        source, source_weight = self.interpolation(x0)
        force = np.zeros(stiffness.shape[1])
        inside = source_weight[0] != 0.0
        force[source[0, inside]] = source_weight[0, inside]
        deflection = solveh_banded(stiffness, force, lower=True)
        columns, weights = self.interpolation(x)
        nodal = np.einsum("ij,ij->i", weights, deflection[np.where(weights != 0.0, columns, 0)])
        return nodal + self._local_compliance(x0, x)
