"""Matrices of a rail's cross-section for waves along it: semi-analytical finite elements (Gavric 1995).

Displacements vary as exp(i (omega t - k x)) along the rail and are interpolated by nine-node quadrilaterals in its
section (Pieringer 2011, eq. 3.18-3.20). With the axial displacement written as i times the unknown the stiffness
K0 + k K1 + k^2 K2 and the mass are real and symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csr_matrix
from skfem import Basis, BilinearForm, ElementQuad2, MeshQuad2

from .safe_mesh import add_pad, foot_weights, head_weights, pad_ends
from .section import RailSection
from .waveguide_settings import ELEMENT_SIZE

__all__ = ["Material", "Pad", "SectionMatrices", "section_matrices"]

_QUADRATURE = 6


@dataclass(frozen=True, kw_only=True)
class Material:
    """Isotropic elastic material.

    Parameters
    ----------
    youngs_modulus : float
        N/m2.
    poisson_ratio : float
    density : float
        kg/m3.
    loss_factor : float
        The modulus in a frequency domain is that times (1 + i loss_factor).
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    loss_factor: float

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants (lambda, mu) in N/m2."""
        mu = 0.5 * self.youngs_modulus / (1.0 + self.poisson_ratio)
        return 2.0 * mu * self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio), mu


@dataclass(frozen=True, kw_only=True)
class Pad:
    """Continuous elastic layer under the foot, its own underside fixed.

    Parameters
    ----------
    material : Material
    thickness : float
        m.
    width : float, optional
        m; the whole flat underside if left out.
    """

    material: Material
    thickness: float
    width: float | None = None


@dataclass(frozen=True, eq=False)
class SectionMatrices:
    """Matrices of a section, real and symmetric, for u_x = i * (axial unknown).

    Unknowns are in the order: all axial ones (x'), all lateral ones (y', towards the field side), all downward ones
    (z'). Forces in the axial direction are -i times the true ones, so that forces do work on their unknowns.

    Parameters
    ----------
    stiffness_parts : tuple of (K0, K1, K2), each csr_matrix
        Of the rail and, if there is one, the pad, without loss; K(k) = K0 + k K1 + k^2 K2, N/m2.
    loss_factors : tuple of float
        Of the same regions.
    mass : csr_matrix
        kg/m.
    head_rows : ndarray, shape (3, n)
        Displacements (x', y', z') at the contact on the head; the axial one is -i times the true one.
    foot_rows : ndarray, shape (4, n)
        Means of (x', y', z') over the foot's underside (on the pad, if there is one) and its roll about x'.
    axial, lateral, vertical : slice
        Where the unknowns of the three directions are.
    mesh : MeshQuad2
        Rail first, then pad; y up.
    node : ndarray of int, shape (n / 3,)
        Node (column of ``mesh.doflocs``) of each unknown of one direction.
    rail_elements : int
        Number of the rail's elements.
    """

    stiffness_parts: tuple[tuple[csr_matrix, csr_matrix, csr_matrix], ...]
    loss_factors: tuple[float, ...]
    mass: csr_matrix
    head_rows: NDArray
    foot_rows: NDArray
    mesh: MeshQuad2
    node: NDArray
    rail_elements: int

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(self.head_rows[0])

    @property
    def supported(self) -> bool:
        """Whether the section rests on something fixed."""
        return len(self.node) < self.mesh.doflocs.shape[1]

    @property
    def axial(self) -> slice:
        """Unknowns of the axial direction."""
        return slice(0, self.size // 3)

    @property
    def lateral(self) -> slice:
        """Unknowns of the lateral direction."""
        return slice(self.size // 3, 2 * (self.size // 3))

    @property
    def vertical(self) -> slice:
        """Unknowns of the vertical direction, down."""
        return slice(2 * (self.size // 3), self.size)

    def combined(self, *, lossy: bool) -> tuple[csr_matrix, csr_matrix, csr_matrix]:
        """Return K0, K1, K2 of the whole section; with complex moduli if ``lossy``."""
        factors = [1.0 + 1j * loss if lossy else 1.0 for loss in self.loss_factors]
        first, second, third = (
            sum(factor * parts[i] for factor, parts in zip(factors, self.stiffness_parts, strict=True))
            for i in range(3)
        )
        return first, second, third  # type: ignore[return-value]

    def displacement(self, shape: NDArray) -> NDArray:
        """Spread a wave's unknowns over all nodes: shape (n,) to (nodes, 3), the fixed nodes with zeros."""
        result = np.zeros((self.mesh.doflocs.shape[1], 3), dtype=shape.dtype)
        result[self.node] = shape.reshape(3, -1).T
        return result


def section_matrices(
    section: RailSection, *, material: Material, pad: Pad | None, contact_position: float, size: float = ELEMENT_SIZE
) -> SectionMatrices:
    """Assemble the matrices of a rail's section, free or on a pad.

    Parameters
    ----------
    section : RailSection
    material : Material
        Of the rail.
    pad : Pad or None
        None for a free rail.
    contact_position : float
        Lateral position of the contact on the head, m, + to the field side of the wheel.
    size : float
        Side of the quadrilaterals, m.

    Returns
    -------
    SectionMatrices

    Raises
    ------
    ValueError
        If the contact isn't on the head's top or the pad is wider than the foot.
    """
    section.check_contact_position(contact_position)
    ends = pad_ends(section, pad.width if pad else None)
    rail = section.mesh(size, ends)
    mesh = rail if pad is None else add_pad(rail, ends, pad.thickness, size)
    regions: list[tuple[Material, NDArray]] = [(material, np.arange(rail.nelements))]
    if pad is not None:
        regions.append((pad.material, np.arange(rail.nelements, mesh.nelements)))
    assembled = [_assemble(mesh, elements, each) for each, elements in regions]
    nodes = mesh.doflocs.shape[1]
    fixed = np.zeros(nodes, dtype=bool)
    if pad is not None:
        fixed = mesh.doflocs[1] <= -pad.thickness * (1.0 - 1e-9)
    node = np.flatnonzero(~fixed)
    free = np.concatenate([node, node + nodes, node + 2 * nodes])
    parts = tuple(tuple(csr_matrix(matrix[free][:, free]) for matrix in stiffness) for stiffness, _ in assembled)
    mass = sum(mass for _, mass in assembled)
    head = head_weights(mesh, contact_position)[node]
    mean, roll = (weights[node] for weights in foot_weights(mesh, ends))
    zero = np.zeros_like(head)
    return SectionMatrices(
        stiffness_parts=parts,  # type: ignore[arg-type]
        loss_factors=tuple(each.loss_factor for each, _ in regions),
        mass=csr_matrix(mass[free][:, free]),  # type: ignore[index]
        head_rows=np.kron(np.eye(3), head),
        foot_rows=np.vstack([np.kron(np.eye(3), mean), np.concatenate([zero, zero, roll])]),
        mesh=mesh,
        node=node,
        rail_elements=rail.nelements,
    )


def _assemble(
    mesh: MeshQuad2, elements: NDArray, material: Material
) -> tuple[tuple[csr_matrix, csr_matrix, csr_matrix], csr_matrix]:
    """Stiffness parts and mass of one region."""
    basis = Basis(mesh, ElementQuad2(), elements=elements, intorder=_QUADRATURE)
    # z' points down, y of the mesh up.
    s = BilinearForm(lambda u, v, _: u * v).assemble(basis)
    yy = BilinearForm(lambda u, v, _: u.grad[0] * v.grad[0]).assemble(basis)
    zz = BilinearForm(lambda u, v, _: u.grad[1] * v.grad[1]).assemble(basis)
    yz = BilinearForm(lambda u, v, _: -u.grad[1] * v.grad[0]).assemble(basis)  # row d/dy', column d/dz'
    y = BilinearForm(lambda u, v, _: u.grad[0] * v).assemble(basis)  # column differentiated
    z = BilinearForm(lambda u, v, _: -u.grad[1] * v).assemble(basis)
    la, mu = material.lame
    cross = la * yz + mu * yz.T
    stiffness0 = bmat(
        [
            [mu * (yy + zz), None, None],
            [None, (la + 2.0 * mu) * yy + mu * zz, cross],
            [None, cross.T, (la + 2.0 * mu) * zz + mu * yy],
        ],
        format="csr",
    )
    axial_y, axial_z = la * y - mu * y.T, la * z - mu * z.T
    empty = csr_matrix(s.shape)
    stiffness1 = bmat([[empty, axial_y, axial_z], [axial_y.T, None, None], [axial_z.T, None, None]], format="csr")
    stiffness2 = bmat([[(la + 2.0 * mu) * s, None, None], [None, mu * s, None], [None, None, mu * s]], format="csr")
    mass = material.density * bmat([[s, None, None], [None, s, None], [None, None, s]], format="csr")
    return (stiffness0, stiffness1, stiffness2), csr_matrix(mass)  # type: ignore[return-value]
