"""Tangential contact as the interaction uses it: transient rolling, or a creep-force law without memory.

Every model answers `begin`, its steady state at the start of a run, and `step`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .creep.fastsim import fastsim
from .creep.kalker_coefficients import AXIS_RATIO
from .creep.linear import linear_creep_force
from .half_space import HalfSpace
from .rolling import RollingState, rigid_shift, roll, steady_rolling
from .solution import NormalSolution

__all__ = [
    "CreepForceLaw",
    "Creepages",
    "Motion",
    "TangentialModel",
    "TangentialSolution",
    "TransientRolling",
    "equivalent_ellipse",
]


class Creepages(NamedTuple):
    """Creepages of one step: rail relative to wheel over the speed; spin in 1/m."""

    x: float
    y: float
    spin: float


class Motion(NamedTuple):
    """How rail and wheel as a whole move against each other in one step, beyond the creepages.

    Attributes
    ----------
    x, y : float
        Rail less wheel, by the forces of the steps before, m (Pieringer 2011, eqs. 3.50 and 3.51).
    compliance : ndarray, shape (2, 2), or None
        What the force of this step adds to it, m/N; None: nothing.
    """

    x: float = 0.0
    y: float = 0.0
    compliance: NDArray | None = None


STANDSTILL = Motion()


class TangentialSolution(NamedTuple):
    """Tangential contact in one step.

    Attributes
    ----------
    force_x, force_y : float
        On the rail, N.
    moment_spin : float
        N m.
    slip_fraction : float
        Slipping share of the contact area.
    friction_work : float
        Work of friction over the rolled distance dx, J.
    iterations : int
    residual : float
    memory : ndarray or None
        What the next step needs; None if nothing.
    friction_method : int
        What found the friction coefficients: place in `wheelrail.contact.friction.problem.METHODS`; 0 if they are
        given.
    friction_solutions : int
        Number of solutions that were found, if they were looked for, else 0.
    friction_force_spread : float
        Largest difference between their tangential forces, N.
    """

    force_x: float
    force_y: float
    moment_spin: float
    slip_fraction: float
    friction_work: float
    iterations: int
    residual: float
    memory: NDArray | None
    friction_method: int = 0
    friction_solutions: int = 0
    friction_force_spread: float = 0.0


NOTHING = TangentialSolution(0.0, 0.0, 0.0, 0.0, 0.0, 0, 0.0, None)


def equivalent_ellipse(normal: NormalSolution) -> tuple[float, float]:
    """Semi-axes in m of an ellipse of the contact's area and proportions, these within the range of Kalker's table.

    A contact of a few elements, just before it opens, can have any proportions.
    """
    product = normal.area / math.pi
    ratio = min(max(normal.length / normal.width, AXIS_RATIO[0]), AXIS_RATIO[-1])
    return math.sqrt(product * ratio), math.sqrt(product / ratio)


class TangentialModel(Protocol):
    """A tangential contact model, without state."""

    @property
    def kind(self) -> str:
        """Name in the case file."""
        ...

    @property
    def memory(self) -> int:
        """Numbers that it keeps from step to step."""
        ...

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know before a run."""
        ...

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description with its ``kind``, for a file."""
        ...

    def begin(
        self, normal: NormalSolution, creepages: Creepages, *, friction: float, dx: float, dt: float
    ) -> TangentialSolution:
        """Solve steady rolling."""
        ...

    def step(
        self,
        normal: NormalSolution,
        creepages: Creepages,
        *,
        friction: float,
        dx: float,
        dt: float,
        memory: NDArray,
        motion: Motion = STANDSTILL,
    ) -> TangentialSolution:
        """Solve one step of dx (m) in dt (s); ``memory`` is that of the step before, shape (memory,)."""
        ...


@dataclass(frozen=True)
class TransientRolling:
    """Kalker's transient rolling on the grid of a half-space contact.

    Memory: the tractions, shape (2, n), and for pictures which elements slip (1 or 0), shape (n,).
    """

    half_space: HalfSpace
    kind: str = "transient"

    @property
    def memory(self) -> int:
        """Numbers that it keeps from step to step."""
        return 3 * self.half_space.elements

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know before a run."""
        return ()

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description; the grid is that of the normal contact."""
        return {"kind": self.kind}

    def _solution(self, state: RollingState) -> TangentialSolution:
        return TangentialSolution(
            state.force_x,
            state.force_y,
            state.moment_spin,
            state.slip_fraction,
            state.friction_work,
            state.iterations,
            state.residual,
            np.concatenate([state.tractions.reshape(-1), state.slipping.astype(float)]),
        )

    def _free(self) -> TangentialSolution:
        return NOTHING._replace(memory=np.zeros(self.memory))

    def begin(
        self, normal: NormalSolution, creepages: Creepages, *, friction: float, dx: float, dt: float
    ) -> TangentialSolution:
        """Solve steady rolling; without creepage there are no tractions."""
        del dx, dt
        field = normal.field
        if field is None or len(field.contact) == 0 or friction == 0.0 or not any(creepages):
            return self._free()
        x, y, spin = creepages
        return self._solution(
            steady_rolling(self.half_space, field, friction=friction, creepage_x=x, creepage_y=y, creepage_spin=spin)
        )

    def step(
        self,
        normal: NormalSolution,
        creepages: Creepages,
        *,
        friction: float,
        dx: float,
        dt: float,
        memory: NDArray,
        motion: Motion = STANDSTILL,
    ) -> TangentialSolution:
        """Solve one transient step."""
        del dx, dt
        grid, field = self.half_space, normal.field
        if field is None or len(field.contact) == 0 or friction == 0.0:
            return self._free()
        x, y, spin = creepages
        shift = rigid_shift(grid, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=grid.dx)
        shift[0] += motion.x
        shift[1] += motion.y
        previous = memory[: 2 * grid.elements].reshape(2, -1)
        return self._solution(
            roll(grid, field, friction=friction, shift=shift, previous=previous, compliance=motion.compliance)
        )


@dataclass(frozen=True)
class CreepForceLaw:
    """A steady creep-force law on the contact ellipse of the step: ``fastsim`` or ``linear``.

    ``linear`` is Kalker's linear theory, which knows no friction limit. Steady laws hold for creepages that hardly
    change while the wheel rolls by a contact length; so they take the vehicle's creepages alone, and their forces move
    wheel and rail without the vibration acting back on them. Vibration in the slip needs transient rolling.
    """

    kind: str
    shear_modulus: float
    poisson_ratio: float

    @property
    def memory(self) -> int:
        """Nothing is kept from step to step."""
        return 0

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know before a run."""
        return ()

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description."""
        return {"kind": self.kind, "shear_modulus": self.shear_modulus, "poisson_ratio": self.poisson_ratio}

    def begin(
        self, normal: NormalSolution, creepages: Creepages, *, friction: float, dx: float, dt: float
    ) -> TangentialSolution:
        """Evaluate the law."""
        return self.step(normal, creepages, friction=friction, dx=dx, dt=dt, memory=np.zeros(0))

    def step(
        self,
        normal: NormalSolution,
        creepages: Creepages,
        *,
        friction: float,
        dx: float,
        dt: float,
        memory: NDArray,
        motion: Motion = STANDSTILL,
    ) -> TangentialSolution:
        """Evaluate the law."""
        del dt, memory, motion
        if normal.force <= 0.0 or not any(creepages) or (self.kind == "fastsim" and friction == 0.0):
            return NOTHING
        x, y, spin = creepages
        semi_axis_x, semi_axis_y = equivalent_ellipse(normal)
        ellipse: dict[str, Any] = {
            "semi_axis_x": semi_axis_x,
            "semi_axis_y": semi_axis_y,
            "shear_modulus": self.shear_modulus,
            "poisson_ratio": self.poisson_ratio,
        }
        slip = 0.0
        if self.kind == "linear":
            force = linear_creep_force(creepage_x=x, creepage_y=y, spin=spin, **ellipse)
        else:
            solution = fastsim(
                creepage_x=x,
                creepage_y=y,
                spin=spin,
                load=normal.force,
                friction_coefficient=friction,
                **ellipse,
            )
            force, slip = solution.force, solution.slip_fraction
        work = -(force.force_x * x + force.force_y * y + force.moment_spin * spin) * dx
        return TangentialSolution(force.force_x, force.force_y, force.moment_spin, slip, work, 1, 0.0, None)
