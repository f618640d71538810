"""Transient rolling with slip-velocity dependent friction, as the interaction uses it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .friction.problem import METHODS
from .friction.settings import SlipFriction
from .half_space import HalfSpace
from .rolling import rigid_shift
from .slip_dependent_rolling import SlipDependentState, entering, roll_slip_dependent, steady_rolling_slip_dependent
from .solution import NormalSolution
from .tangential_models import NOTHING, STANDSTILL, Creepages, Motion, TangentialSolution

__all__ = ["SlipDependentRolling"]


@dataclass(frozen=True)
class SlipDependentRolling:
    """Kalker's transient rolling with a friction coefficient for each element.

    Memory: that of `wheelrail.contact.tangential_models.TransientRolling`, then slip velocities (m/s) and friction
    coefficients, each of shape (n,).
    """

    half_space: HalfSpace
    friction: SlipFriction
    kind: str = "transient"

    @property
    def memory(self) -> int:
        """Numbers that it keeps from step to step."""
        return 5 * self.half_space.elements

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know before a run."""
        return self.friction.remarks

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description; the grid is that of the normal contact."""
        return {"kind": self.kind, "friction": self.friction.to_parts()}

    def coefficients(self, memory: NDArray) -> NDArray:
        """Return the friction coefficients that a memory of shape (memory,) holds, shape (n,)."""
        return memory[4 * self.half_space.elements :]

    def begin(
        self, normal: NormalSolution, creepages: Creepages, *, friction: float, dx: float, dt: float
    ) -> TangentialSolution:
        """Solve steady rolling; without creepage there are no tractions."""
        del dx
        field = normal.field
        if field is None or len(field.contact) == 0 or friction == 0.0 or not any(creepages):
            return self._free(friction)
        x, y, spin = creepages
        state = steady_rolling_slip_dependent(
            self.half_space,
            field,
            friction=self.friction,
            static=friction,
            dt=dt,
            creepage_x=x,
            creepage_y=y,
            creepage_spin=spin,
        )
        return self._solution(state)

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
        del dx
        grid, field = self.half_space, normal.field
        if field is None or friction == 0.0:
            return self._free(friction)
        n = grid.elements
        x, y, spin = creepages
        shift = rigid_shift(grid, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=grid.dx)
        shift[0] += motion.x
        shift[1] += motion.y
        state = roll_slip_dependent(
            grid,
            field,
            friction=self.friction,
            static=friction,
            dt=dt,
            shift=shift,
            previous=memory[: 2 * n].reshape(2, n),
            speed=memory[3 * n : 4 * n],
            coefficient=memory[4 * n :],
            compliance=motion.compliance,
        )
        return self._solution(state)

    def _free(self, friction: float) -> TangentialSolution:
        memory = np.zeros(self.memory)
        memory[4 * self.half_space.elements :] = entering(self.half_space, self.friction, friction)
        return NOTHING._replace(memory=memory)

    def _solution(self, state: SlipDependentState) -> TangentialSolution:
        rolling = state.rolling
        return TangentialSolution(
            rolling.force_x,
            rolling.force_y,
            rolling.moment_spin,
            rolling.slip_fraction,
            rolling.friction_work,
            rolling.iterations,
            rolling.residual,
            np.concatenate(
                [rolling.tractions.reshape(-1), rolling.slipping.astype(float), state.speed, state.coefficient]
            ),
            METHODS.index(state.method),
            state.solutions,
            state.force_spread,
        )
