"""Exact time stepping of the track after unit impulses, for the moving Green's functions.

Between two instants the track moves freely, so its state (displacements and velocities) at t + dt is a constant matrix,
exp(A dt), times that at t. In dt a disturbance crosses little more than one bay, hence the matrix is block banded, and
since the bays are alike every row of blocks away from the ends is the same. A step is then a handful of small dense
products, exact to rounding for the finite element model whatever dt is: no time integration error, no numerical damping
and no response before the impulse.

A cell is one bay: the node over the sleeper, the nodes up to the next sleeper (not included), and the sleeper.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, expm

if TYPE_CHECKING:
    from .discrete import DiscreteTrack

__all__ = ["ChainStepper"]

BLOCK_TOLERANCE = 1e-13  # scaled blocks below it are rounding noise of the matrix exponential and left out
MAXIMUM_REACH = 8  # bays that a disturbance may cross in one step
MOST_SUB_STEPS = 1024  # by then a finer mesh would cost less


@dataclass(frozen=True)
class _Cells:
    """Matrices of a few neighbouring cells, clamped beyond both ends."""

    mass: NDArray
    damping: NDArray
    stiffness: NDArray


def _assemble(track: DiscreteTrack, cells: int, *, clamped_start: bool) -> _Cells:
    """Assemble ``cells`` cells; the node after the last one is clamped, the first node only if ``clamped_start``."""
    per_bay = track.elements_per_bay
    nodes = cells * per_bay
    width = 2 * per_bay + 1  # degrees of freedom of a cell, its sleeper last
    size = cells * width
    mass, damping, stiffness = (np.zeros((size + 2, size + 2)) for _ in range(3))
    element_stiffness, element_mass = track.element_matrices()
    # The clamped node beyond the end takes the two extra rows, dropped below.
    first = [width * (node // per_bay) + 2 * (node % per_bay) for node in range(nodes)] + [size]
    start = -1 if not clamped_start else 0
    for element in range(start, nodes):
        dofs = [first[element] if element >= 0 else size, 0, first[element + 1], 0]
        dofs[1], dofs[3] = dofs[0] + 1, dofs[2] + 1
        at = np.ix_(dofs, dofs)
        stiffness[at] += element_stiffness
        mass[at] += element_mass
    for cell in range(cells):
        rail, sleeper = width * cell, width * cell + width - 1
        for matrix, pad, ballast in (
            (stiffness, track.pad_stiffness, track.ballast_stiffness),
            (damping, track.pad_damping, track.ballast_damping),
        ):
            matrix[np.ix_([rail, sleeper], [rail, sleeper])] += pad * np.array([[1.0, -1.0], [-1.0, 1.0]])
            matrix[sleeper, sleeper] += ballast
        mass[sleeper, sleeper] += track.sleeper_mass
    parts = [matrix[:size, :size] for matrix in (mass, damping, stiffness)]
    if clamped_start:
        for matrix in parts:
            matrix[:2, :] = matrix[:, :2] = 0.0
        parts[0][[0, 1], [0, 1]] = 1.0  # keeps the mass matrix invertible; these two never move
    return _Cells(*parts)


def _system_matrix(cells: _Cells, dt: float) -> NDArray:
    """Return A dt for states (u, v dt): so scaled, they have like size, as expm needs to be accurate."""
    size = len(cells.mass)
    factor = cho_factor(cells.mass)
    return np.block(
        [
            [np.zeros((size, size)), np.eye(size)],
            [-(dt**2) * cho_solve(factor, cells.stiffness), -dt * cho_solve(factor, cells.damping)],
        ]
    )


def _propagator(cells: _Cells, width: int, dt: float) -> NDArray:
    """exp(A dt) as blocks [cell to, cell from], each (2 width, 2 width), for states (u, v dt)."""
    size = len(cells.mass)
    count = size // width
    blocks = expm(_system_matrix(cells, dt)).reshape(2, count, width, 2, count, width)
    return blocks.transpose(1, 4, 0, 2, 3, 5).reshape(count, count, 2 * width, 2 * width)


class ChainStepper:
    """Motion of the track after short unit forces on each degree of freedom of the bay right of the middle sleeper.

    Parameters
    ----------
    track : DiscreteTrack
    dt : float
        Time step in s.

    Attributes
    ----------
    reach : int
        Number of bays that a step reaches to either side.
    """

    def __init__(self, track: DiscreteTrack, dt: float) -> None:
        self.track = track
        self.width = 2 * track.elements_per_bay + 1
        self.cells = track.bays
        self.middle = track.bays // 2
        sub_steps = 1
        while True:
            reach = self._build(dt / sub_steps)
            if reach is not None:
                break
            sub_steps *= 2
            if sub_steps > MOST_SUB_STEPS:
                raise ValueError(
                    f"elements_per_bay = {track.elements_per_bay} is too coarse for a time step of {dt:g} s; "
                    "use more elements per bay"
                )
        self.reach = reach
        self.sub_steps = sub_steps
        self._falling, self._rising = self._ramps(dt / sub_steps)
        self.state = np.zeros((self.cells, 2 * track.elements_per_bay + 2, 2 * self.width))

    def _build(self, dt: float) -> int | None:
        """Find how far a step reaches; build the blocks. None if it reaches too far."""
        limit = min(MAXIMUM_REACH, (self.cells - 2) // 2)
        patch = _propagator(_assemble(self.track, 2 * limit + 3, clamped_start=False), self.width, dt)
        centre = limit + 1
        # Rotations times the element length compare with deflections; sleepers and velocities (times dt) are alike.
        unit = np.ones(self.width)
        unit[1 : 2 * self.track.elements_per_bay : 2] = self.track.element_length
        unit = np.concatenate([unit, unit])
        scaled = np.abs(patch[centre]) * unit[:, None] / unit
        size = scaled.max(axis=(1, 2)) / scaled.max()
        far = np.nonzero(size > BLOCK_TOLERANCE)[0]
        reach = int(np.max(np.abs(far - centre)))
        if reach > limit:
            return None
        # Stored transposed, [distance, from, to], since a state holds its degrees of freedom last.
        self._blocks = patch[centre, centre - reach : centre + reach + 1].transpose(0, 2, 1).copy()
        ends = 2 * reach + 2
        start = _propagator(_assemble(self.track, ends, clamped_start=True), self.width, dt)
        stop = _propagator(_assemble(self.track, ends, clamped_start=False), self.width, dt)
        self._start = start[:reach, : 2 * reach].transpose(0, 1, 3, 2).copy()
        self._stop = stop[-reach:, -2 * reach :].transpose(0, 1, 3, 2).copy()
        return reach

    def _ramps(self, dt: float) -> tuple[NDArray, NDArray]:
        """States after one step under a unit force that falls from 1 to 0, and that rises from 0 to 1.

        Each has shape (patch, sources, 2 width), the patch of cells centred on the middle one.
        """
        patch = 2 * self.reach + 3
        cells = _assemble(self.track, patch, clamped_start=False)
        size = len(cells.mass)
        rail = np.arange(2 * self.track.elements_per_bay)
        sources = np.concatenate([rail, self.width + np.arange(2)]) + self.width * (patch // 2)
        count = len(sources)
        unit = np.zeros((size, count))
        unit[sources, np.arange(count)] = 1.0
        # exp of the system augmented by the force and its slope (Van Loan 1978): the columns of the augmentation are
        # the integrals of exp(A (dt - t)) B times 1 and times t / dt.
        system = np.zeros((2 * size + 2 * count,) * 2)
        system[: 2 * size, : 2 * size] = _system_matrix(cells, dt)
        system[size : 2 * size, 2 * size : 2 * size + count] = dt**2 * cho_solve(cho_factor(cells.mass), unit)
        system[2 * size : 2 * size + count, 2 * size + count :] = np.eye(count)
        integrals = expm(system)[: 2 * size, 2 * size :]
        constant, rising = integrals[:, :count], integrals[:, count:]

        def by_cells(columns: NDArray) -> NDArray:
            return columns.reshape(2, patch, self.width, count).transpose(1, 3, 0, 2).reshape(patch, count, -1)

        return by_cells(constant - rising), by_cells(rising)

    def _force_from_to(self, first: float, last: float) -> None:
        """Add the effect of forces that went linearly from ``first`` to ``last`` within the sub-step just taken."""
        patch = self._falling.shape[0]
        at = self.middle - patch // 2
        self.state[at : at + patch] += first * self._falling + last * self._rising

    def start_hat(self) -> None:
        """Bring the state to the peak of a force that rises linearly from 0 to 1 within one step."""
        self.state[:] = 0.0
        for i in range(self.sub_steps):
            self._sub_step()
            self._force_from_to(i / self.sub_steps, (i + 1) / self.sub_steps)

    def finish_hat(self) -> None:
        """Advance by one step in which the force falls linearly from 1 to 0."""
        for i in range(self.sub_steps):
            self._sub_step()
            self._force_from_to(1.0 - i / self.sub_steps, 1.0 - (i + 1) / self.sub_steps)

    def start_impulse(self, dt: float) -> None:
        """Set the state right after impulses of size ``dt`` (1 N during dt)."""
        # The inverse mass matrix decays by two decades per node: a patch of nine bays holds it to rounding.
        patch = 9
        mass = _assemble(self.track, patch, clamped_start=False).mass
        rail = np.arange(2 * self.track.elements_per_bay)
        sources = np.concatenate([rail, self.width + np.arange(2)]) + self.width * (patch // 2)
        unit = np.zeros((len(mass), len(sources)))
        unit[sources, np.arange(len(sources))] = dt
        velocity = cho_solve(cho_factor(mass), unit).reshape(patch, self.width, -1)
        self.state[:] = 0.0
        at = self.middle - patch // 2
        self.state[at : at + patch, :, self.width :] = dt / self.sub_steps * velocity.transpose(0, 2, 1)

    def step(self) -> None:
        """Advance by one time step without force."""
        for _ in range(self.sub_steps):
            self._sub_step()

    def _sub_step(self) -> None:
        old, reach, cells = self.state, self.reach, self.cells
        inner = cells - 2 * reach
        shape = (-1, 2 * self.width)
        new = np.empty_like(old)
        middle = new[reach : cells - reach].reshape(shape)
        np.matmul(old[:inner].reshape(shape), self._blocks[0], out=middle)
        for distance in range(1, 2 * reach + 1):
            middle += old[distance : distance + inner].reshape(shape) @ self._blocks[distance]
        for blocks, cells_from, cells_to in (
            (self._start, old[: 2 * reach], new[:reach]),
            (self._stop, old[-2 * reach :], new[-reach:]),
        ):
            np.einsum("tfij,fsi->tsj", blocks, cells_from, out=cells_to, optimize=True)
        self.state = new

    def bay_response(self, bay: int) -> NDArray:
        """Displacements of the nodes of one bay, both its ends included.

        Parameters
        ----------
        bay : int
            0 is the bay right of the middle sleeper.

        Returns
        -------
        ndarray, shape (2 (elements_per_bay + 1), sources)
            m per N.
        """
        cell = self.middle + bay
        rail = 2 * self.track.elements_per_bay
        here = self.state[cell, :, :rail]
        following = self.state[cell + 1, :, :2] if cell + 1 < self.cells else np.zeros((len(here), 2))
        return np.concatenate([here, following], axis=1).T
