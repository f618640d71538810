"""What every normal contact model answers."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

from .normal import NormalState

__all__ = ["NormalContact", "NormalSolution"]


class NormalSolution(NamedTuple):
    """Solution of the normal contact in one step.

    Attributes
    ----------
    force : float
        F_3 in N, >= 0.
    approach : float
        Rigid approach of the bodies, roughness not counted, in m.
    stiffness : float
        Tangent dF_3 / d(approach) in N/m.
    length, width : float
        Contact length and width in m.
    area : float
        m2.
    pressure_max : float
        Pa.
    iterations : int
        Evaluations of the contact law.
    residual : float
        Of the coupled equation, relative to its largest term.
    field : NormalState or None
        Pressures and contact elements, of models that have them.
    """

    force: float
    approach: float
    stiffness: float
    length: float
    width: float
    area: float
    pressure_max: float
    iterations: int
    residual: float
    field: NormalState | None = None


class NormalContact(Protocol):
    """A normal contact model, without state."""

    @property
    def nodes(self) -> int:
        """Number of roughness nodes that the model looks at, odd, centred on the nominal contact point."""
        ...

    @property
    def rows(self) -> int:
        """Number of lines across at which it looks at the heights."""
        ...

    @property
    def lateral_offsets(self) -> NDArray:
        """Positions of these lines from the nominal contact point, m, shape (rows,)."""
        ...

    @property
    def memory(self) -> int:
        """Numbers that it keeps from step to step, as a warm start."""
        ...

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description with its ``kind``, and the arrays, for a file."""
        ...

    def solve(
        self,
        roughness: NDArray,
        *,
        weight: float,
        compliance: float,
        rhs: float,
        guess: float,
        memory: NDArray | None = None,
    ) -> NormalSolution:
        """Solve ``weight * approach + compliance * force = rhs`` over the given roughness.

        Parameters
        ----------
        roughness : ndarray, shape (nodes,) or (rows, nodes)
            Combined heights in m; one row holds for all.
        weight, compliance, rhs, guess : float
            As `wheelrail.contact.newton.solve_approach` takes them.
        memory : ndarray, shape (memory,), optional
            What the step before left.
        """
        ...
