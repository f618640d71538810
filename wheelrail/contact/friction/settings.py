"""How a run treats slip-velocity dependent friction: law, memory, solver, and which solution it takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .laws import FrictionLaw, falls, law_from_parts
from .memory import FrictionMemory
from .solve import SOLVERS

__all__ = ["BRANCHES", "WITHOUT_MEMORY", "SlipFriction"]

BRANCHES = ("previous", "low-slip", "high-slip")
"""Where the search for a step's solution starts: at the slip of the step before, at full stick, at full slip."""

WITHOUT_MEMORY = (
    "friction falls with the slip velocity and has no memory: the contact may swing from step to step, with results "
    'that depend on the grid; friction.memory_distance cures that ("wheelrail explain" says from which value on)'
)


@dataclass(frozen=True)
class SlipFriction:
    """Slip-velocity dependent friction.

    Parameters
    ----------
    law : FrictionLaw
    memory : FrictionMemory or None
    solver : {"newton", "broyden"}
        As `wheelrail.contact.friction.solve.solve_slip_friction` takes it.
    branch : {"previous", "low-slip", "high-slip"}
        Which solution where there are several: the one that the iteration between contact and law reaches from the
        slip of the step before, from full stick (the one with the least slip) or from full slip (the one with the
        most). From the step before, a run stays on its branch as long as the branch exists.
    find_solutions : bool
        Look for all solutions at every step.
    """

    law: FrictionLaw
    memory: FrictionMemory | None = None
    solver: str = "newton"
    branch: str = "previous"
    find_solutions: bool = False

    def __post_init__(self) -> None:
        if self.solver not in SOLVERS or self.branch not in BRANCHES:
            raise ValueError(f"solver {self.solver!r} or branch {self.branch!r} is not known")

    @property
    def at_rest(self) -> float:
        """Ratio mu / mu_s without slip, with which particles enter the contact."""
        return float(self.law.evaluate(np.zeros(1))[0][0])

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know before a run."""
        return () if self.memory is not None or not falls(self.law) else (WITHOUT_MEMORY,)

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description."""
        memory = None if self.memory is None else {"distance": self.memory.distance, "speed": self.memory.speed}
        return {
            "law": self.law.to_parts(),
            "memory": memory,
            "solver": self.solver,
            "branch": self.branch,
            "find_solutions": self.find_solutions,
        }

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any]) -> SlipFriction:
        """Rebuild it from `to_parts`."""
        memory = meta["memory"]
        return cls(
            law_from_parts(meta["law"]),
            None if memory is None else FrictionMemory(**memory),
            meta["solver"],
            meta["branch"],
            meta["find_solutions"],
        )
