"""Finite elements for axisymmetric bodies whose motion varies as cos(n theta) or sin(n theta) around the axis.

With the amplitudes (u_r, u_theta, u_z)(r, z) of the nth harmonic the displacement is

    (u_r cos(n theta), u_theta sin(n theta), u_z cos(n theta)),

and a second family of the same amplitudes, turned by a quarter of a wave, is

    (u_r sin(n theta), -u_theta cos(n theta), u_z sin(n theta)).

The stiffness of harmonic n is K0 + n K1 + n^2 K2, so the elements are integrated once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from skfem import Basis, ElementQuad2, MeshQuad

__all__ = ["AxisymmetricBody", "HarmonicModes"]

_INTEGRATION_ORDER = 5
_FIRST_GUESS = 14  # modes asked for at first


@dataclass(frozen=True)
class HarmonicModes:
    """Modes of one harmonic without damping.

    Parameters
    ----------
    harmonic : int
        Number of nodal diameters n.
    frequency : ndarray, shape (m,)
        Hz, ascending.
    mass : ndarray, shape (m,)
        Modal masses of the whole body in kg.
    shapes : ndarray, shape (m, points, 3)
        Amplitudes (u_r, u_theta, u_z) at the body's points; the longest vector of a mode has length 1.
    """

    harmonic: int
    frequency: NDArray
    mass: NDArray
    shapes: NDArray


class AxisymmetricBody:
    """A body of revolution, held where r is smallest.

    Parameters
    ----------
    mesh : MeshQuad
        Half section; coordinates (r, z) in m.
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    density : float
        kg/m^3.
    held : bool
        Whether all points at the smallest radius are fixed; otherwise the body is free.

    Attributes
    ----------
    points : ndarray, shape (points, 2)
        Coordinates (r, z) of the nodes of the nine-node elements.
    quads : ndarray of int, shape (m, 4)
        Points at the corners of each element, in turn.
    boundary : ndarray of int, shape (sides, 3)
        Points at the two ends and in the middle of each side of the boundary.
    """

    def __init__(
        self,
        mesh: MeshQuad,
        *,
        youngs_modulus: float,
        poisson_ratio: float,
        density: float,
        held: bool = True,
    ) -> None:
        element = ElementQuad2()
        basis = Basis(mesh, element, intorder=_INTEGRATION_ORDER)
        self.points = basis.doflocs.T
        nodal, middle = np.asarray(basis.nodal_dofs)[0], np.asarray(basis.facet_dofs)[0]
        outer = mesh.boundary_facets()
        self.quads = nodal[mesh.t].T
        self.boundary = np.column_stack([*nodal[np.asarray(mesh.facets)[:, outer]], middle[outer]])
        fixed = self.points[:, 0] <= self.points[:, 0].min() + 1e-6 * np.ptp(self.points[:, 0])
        self._free = np.flatnonzero(np.repeat(~fixed, 3)) if held else np.arange(3 * len(self.points))
        self._stiffness, self._mass, self._revolved_mass = self._integrate(
            basis, _elasticity(youngs_modulus, poisson_ratio), density
        )

    @property
    def mass(self) -> float:
        """Mass of the whole body in kg."""
        return 2.0 * np.pi * self._revolved_mass

    def _integrate(
        self, basis: Basis, elasticity: NDArray, density: float
    ) -> tuple[tuple[csc_array, csc_array, csc_array], csc_array, float]:
        """Stiffness parts and mass of the free unknowns per rad, and the mass per rad."""
        shape = np.stack([np.broadcast_to(np.asarray(part[0]), basis.dx.shape) for part in basis.basis])
        gradient = np.stack([np.asarray(part[0].grad) for part in basis.basis])
        r = np.asarray(basis.global_coordinates())[0]
        count, (elements, quadrature) = len(shape), basis.dx.shape
        dr, dz, over_r = gradient[:, 0], gradient[:, 1], shape / r
        # Strains rr, theta theta, z z, r z, r theta, theta z: even @ u + n odd @ u, times cos or sin of n theta.
        even, odd = (np.zeros((6, count, 3, elements, quadrature)) for _ in range(2))
        even[0, :, 0], even[1, :, 0], even[2, :, 2] = dr, over_r, dz
        even[3, :, 0], even[3, :, 2], even[4, :, 1], even[5, :, 1] = dz, dr, dr - over_r, dz
        odd[1, :, 1], odd[4, :, 0], odd[5, :, 2] = over_r, -over_r, -over_r
        even, odd = (np.moveaxis(part.reshape(6, 3 * count, elements, quadrature), 2, 0) for part in (even, odd))
        weight = basis.dx * r

        def product(left: NDArray, right: NDArray) -> NDArray:
            weighted = np.tensordot(elasticity, right, axes=(1, 1)).swapaxes(0, 1) * weight[:, None, None, :]
            left, weighted = (part.swapaxes(1, 2).reshape(elements, 3 * count, -1) for part in (left, weighted))
            return left @ weighted.swapaxes(1, 2)

        mixed = product(even, odd)
        scalar_mass = np.einsum("aeq,beq,eq->eab", shape, shape, density * weight, optimize=True)
        mass = np.einsum("eab,ij->eaibj", scalar_mass, np.eye(3)).reshape(elements, 3 * count, 3 * count)
        dofs = (3 * basis.element_dofs.T[:, :, None] + np.arange(3)).reshape(elements, -1)
        parts = (product(even, even), mixed + mixed.swapaxes(1, 2), product(odd, odd))
        k0, k1, k2 = (self._assemble(part, dofs) for part in parts)
        return (k0, k1, k2), self._assemble(mass, dofs), float(np.sum(density * weight))

    def _assemble(self, blocks: NDArray, dofs: NDArray) -> csc_array:
        size = 3 * len(self.points)
        rows, columns = (np.broadcast_to(index, blocks.shape).ravel() for index in (dofs[:, :, None], dofs[:, None, :]))
        matrix = coo_array((blocks.ravel(), (rows, columns)), shape=(size, size)).tocsr()
        return matrix[self._free][:, self._free].tocsc()

    def stiffness(self, harmonic: int) -> csc_array:
        """Stiffness of a harmonic in the free unknowns (per rad: before the integral over theta), SI."""
        k0, k1, k2 = self._stiffness
        return (k0 + harmonic * k1 + harmonic**2 * k2).tocsc()

    def modes(self, harmonic: int, max_frequency: float) -> HarmonicModes:
        """All modes of a harmonic up to `max_frequency` (Hz).

        For n = 0 the motion in the section and the twist about the axis don't interact; either has its own modes.
        """
        if harmonic == 0:
            twist = self._free % 3 == 1
            families = [np.flatnonzero(~twist), np.flatnonzero(twist)]
        else:
            families = [np.arange(len(self._free))]
        stiffness = self.stiffness(harmonic)
        frequencies, shapes, masses = [], [], []
        for family in families:
            omega2, vectors = _lowest_modes(
                stiffness[family][:, family].tocsc(), self._mass[family][:, family].tocsc(), max_frequency
            )
            full = np.zeros((len(omega2), 3 * len(self.points)))
            full[:, self._free[family]] = vectors.T
            shape = full.reshape(len(omega2), len(self.points), 3)
            largest = np.linalg.norm(shape, axis=2).max(axis=1, initial=0.0)
            # The largest component is positive, so that the sign doesn't depend on the solver.
            upward = shape.max(axis=(1, 2), initial=0.0) >= -shape.min(axis=(1, 2), initial=0.0)
            largest = np.where(upward, largest, -largest)
            frequencies.append(np.sqrt(np.maximum(omega2, 0.0)) / (2.0 * np.pi))
            shapes.append(shape / largest[:, None, None])
            # The vectors have unit mass per rad; the squared cosine's integral is 2 pi for n = 0, else pi.
            masses.append(_around(harmonic) / largest**2)
        order = np.argsort(np.concatenate(frequencies), kind="stable")
        return HarmonicModes(
            harmonic,
            np.concatenate(frequencies)[order],
            np.concatenate(masses)[order],
            np.concatenate(shapes)[order],
        )

    def kinetic_product(self, left: NDArray, right: NDArray) -> NDArray:
        """Integral of density times left . right over the section, per rad, component by component.

        Parameters
        ----------
        left, right : ndarray, shape (m, points, 3)

        Returns
        -------
        ndarray, shape (m, 3)
            kg for dimensionless displacements; points that are fixed don't count.
        """
        flat = [np.asarray(field).reshape(len(field), 3 * len(self.points))[:, self._free] for field in (left, right)]
        product = flat[0] * (self._mass @ flat[1].T).T
        return np.stack([product[:, self._free % 3 == i].sum(axis=1) for i in range(3)], axis=1)

    def harmonic_response(self, harmonic: int, frequency: float, point: NDArray) -> NDArray:
        """Receptance of one harmonic at a point of the section, by solving with the dynamic stiffness.

        Parameters
        ----------
        harmonic : int
        frequency : float
            Hz.
        point : ndarray, shape (points,)
            Weights of the section's points, as `outer_point` returns them.

        Returns
        -------
        ndarray, shape (3, 3)
            (u_r, u_theta, u_z) at theta = 0 under point forces there, m/N: what the harmonic adds to the receptance
            of the whole body without damping. u_theta is that of the second family.
        """
        omega = 2.0 * np.pi * frequency
        dynamic = (self.stiffness(harmonic) - omega**2 * self._mass).tocsc()
        load = np.kron(point[:, None], np.eye(3))[self._free]
        response = load.T @ splu(dynamic).solve(load) / _around(harmonic)
        # u_theta belongs to the other family than u_r and u_z.
        response[1, [0, 2]] = response[[0, 2], 1] = 0.0
        return response

    def outer_point(self, z: float) -> tuple[float, NDArray]:
        """Outermost point of the section at an axial position.

        Parameters
        ----------
        z : float
            m.

        Returns
        -------
        radius : float
            m; NaN where the section has no point at `z`.
        weights : ndarray, shape (points,)
            A field's value there is `weights` times its values at the points.
        """
        # Edges are parabolas: z0 + slope t + bend t^2 for t from 0 to 1.
        z0, z1, zm = self.points[self.boundary.T, 1]
        bend, slope = 2.0 * (z0 + z1 - 2.0 * zm), 4.0 * zm - 3.0 * z0 - z1
        best, weights = float("nan"), np.zeros(len(self.points))
        for i in np.flatnonzero((np.minimum(z0, z1) <= z + 1e-9) & (z <= np.maximum(z0, z1) + 1e-9)):
            for t in np.roots([bend[i], slope[i], z0[i] - z] if bend[i] else [slope[i], z0[i] - z]):
                share = np.clip(t.real, 0.0, 1.0)
                rest = 1.0 - share
                shape = np.array([rest * (1.0 - 2.0 * share), share * (2.0 * share - 1.0), 4.0 * share * rest])
                radius = float(shape @ self.points[self.boundary[i], 0])
                if abs(t - share) < 1e-6 and not radius <= best:
                    best, weights = radius, np.zeros(len(self.points))
                    weights[self.boundary[i]] = shape
        return best, weights


def _around(harmonic: int) -> float:
    """Integral of the squared cosine (or sine) over the circumference."""
    return 2.0 * np.pi if harmonic == 0 else np.pi


def _elasticity(youngs_modulus: float, poisson_ratio: float) -> NDArray:
    """Stress over strain (rr, theta theta, zz, rz, r theta, theta z; engineering shear strains), shape (6, 6)."""
    shear = youngs_modulus / (2.0 * (1.0 + poisson_ratio))
    lame = youngs_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio))
    matrix = np.diag([2.0 * shear] * 3 + [shear] * 3)
    matrix[:3, :3] += lame
    return matrix


def _lowest_modes(stiffness: csc_array, mass: csc_array, max_frequency: float) -> tuple[NDArray, NDArray]:
    """Eigenvalues (rad^2/s^2) up to the frequency and vectors of unit mass (columns), by shift and invert."""
    limit = (2.0 * np.pi * max_frequency) ** 2
    size = stiffness.diagonal().size
    # Below all eigenvalues, so that the smallest are found first; not 0, where a free body's matrix is singular.
    shift = -1e-4 * limit
    factor = splu(
        (stiffness - shift * mass).tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    inverse = LinearOperator(stiffness.shape, matvec=factor.solve, dtype=float)  # type: ignore[call-arg]
    count = min(_FIRST_GUESS, size - 1)
    while True:
        start = np.random.default_rng(0).standard_normal(size)  # seeded: the same result in every run
        omega2, vectors = eigsh(stiffness, k=count, M=mass, sigma=shift, OPinv=inverse, v0=start)
        if omega2.max() > limit or count == size - 1:
            order = np.argsort(omega2)
            order = order[omega2[order] <= limit]
            return omega2[order], vectors[:, order]
        count = min(2 * count, size - 1)
