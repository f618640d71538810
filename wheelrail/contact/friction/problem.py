"""Tangential contact whose traction bound depends on the slip velocity (Pieringer 2011, section 3.6.2).

    |p_I| <= mu_I p3_I,     S_I = 0 where |p_I| < mu_I p3_I,     else p_I = -mu_I p3_I S_I / |S_I|,
    mu_I = f(s_I),     s_I = |S_I| / dt

with f the friction law, or what a friction memory makes of it. For given coefficients the contact has one solution that
depends continuously on them, so with a continuous law there is at least one altogether (Brouwer's theorem); there can
be several.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..half_space import HalfSpace
from ..tangential import TangentialProblem, TangentialState, influence_matrix, solve_tangential
from .laws import FrictionLaw
from .memory import FrictionMemory

__all__ = ["METHODS", "TOLERANCE", "Evaluation", "SlipFrictionProblem", "SlipFrictionState"]

TOLERANCE = 1e-10  # of the residual
METHODS = ("none", "newton", "broyden", "fixed-point")
"""What found a solution; the place in the list is the number on the port."""


class Evaluation(NamedTuple):
    """What the equations say of some tractions.

    Attributes
    ----------
    slip, trial : ndarray, shape (2, k)
        Slip S in m and trial tractions p - S / A_11 in Pa.
    size, bound : ndarray, shape (k,)
        Of the trial tractions, and what friction allows, Pa.
    coefficient, slope : ndarray
        f(s) and its slope, see `SlipFrictionProblem.coefficient`.
    residual : float
    """

    slip: NDArray
    trial: NDArray
    size: NDArray
    bound: NDArray
    coefficient: NDArray
    slope: NDArray
    residual: float


class SlipFrictionState(NamedTuple):
    """Solution of a tangential contact problem with slip-velocity dependent friction.

    Attributes
    ----------
    tractions, slip : ndarray, shape (2, k)
        Pa and m, as in `wheelrail.contact.tangential.TangentialState`.
    slipping : ndarray of bool, shape (k,)
    coefficient : ndarray, shape (k,)
        mu = f(s) at the slip of the solution.
    iterations : int
        Solutions of the contact for given coefficients and Newton steps, together.
    residual : float
        Largest violation of the contact conditions with f(s) as coefficient, over the largest bound: both equations at
        once.
    method : str
        Which of `METHODS` found it.
    """

    tractions: NDArray
    slip: NDArray
    slipping: NDArray
    coefficient: NDArray
    iterations: int
    residual: float
    method: str


@dataclass(frozen=True)
class SlipFrictionProblem:
    """A tangential contact problem over the k elements in contact, friction included.

    Parameters
    ----------
    half_space : HalfSpace
    contact : ndarray of int, shape (k,)
        Elements in contact.
    pressure : ndarray, shape (k,)
        p3 in Pa.
    shift : ndarray, shape (2, k)
        h = W - u' in m, as for `wheelrail.contact.tangential.TangentialProblem`.
    dt : float
        s.
    law : FrictionLaw
    static : float
        mu_s.
    memory : FrictionMemory, optional
    previous : ndarray, shape (k,), optional
        With memory: coefficients of the particles one step before.
    compliance : ndarray, shape (2, 2), optional
        Of rail and wheel as a whole, m/N.
    carried : ndarray, shape (2 k, 2 k), optional
        For steady rolling: the matrix A' of the step before, whose tractions are then those of this step.
    upstream : ndarray of int, shape (k,), optional
        For steady rolling with memory: place among the contact elements of the one upstream, -1 if there is none; the
        elements have to come row by row in rolling direction, as those of a `HalfSpace` do. ``previous`` then is what
        particles enter the contact with.
    """

    half_space: HalfSpace
    contact: NDArray
    pressure: NDArray
    shift: NDArray
    dt: float
    law: FrictionLaw
    static: float
    memory: FrictionMemory | None = None
    previous: NDArray | None = None
    compliance: NDArray | None = None
    carried: NDArray | None = None
    upstream: NDArray | None = None

    @cached_property
    def matrix(self) -> NDArray:
        """A, or A - A' in steady rolling; shape (2 k, 2 k)."""
        matrix = influence_matrix(self.with_coefficient(np.ones(len(self.contact))))
        return matrix if self.carried is None else matrix - self.carried

    def with_coefficient(self, coefficient: NDArray) -> TangentialProblem:
        """Return the problem for given coefficients, shape (k,)."""
        return TangentialProblem(
            self.half_space, self.contact, coefficient * self.pressure, self.shift, self.compliance
        )

    def solve_for(self, coefficient: NDArray, guess: NDArray, *, gradient_steps: int = 3) -> TangentialState:
        """Solve the contact for given coefficients, shape (k,), from tractions nearby, shape (2, k)."""
        return solve_tangential(
            self.with_coefficient(coefficient),
            guess,
            self.matrix,
            symmetric=self.carried is None,
            gradient_steps=gradient_steps,
        )

    def speed(self, slip: NDArray) -> NDArray:
        """Return slip velocities in m/s of slip distances in m, shape (2, k)."""
        return np.hypot(slip[0], slip[1]) / self.dt

    def coefficient(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Evaluate f.

        Parameters
        ----------
        speed : ndarray, shape (k,)
            Slip velocities, m/s.

        Returns
        -------
        tuple of ndarray
            mu, shape (k,), and d mu / ds in s/m: shape (k,), or (k, k) where it depends on the slip of other elements.
        """
        ratio, slope = self.law.evaluate(speed)
        mu, slope = self.static * ratio, self.static * slope
        if self.memory is None:
            return mu, slope
        assert self.previous is not None
        if self.upstream is not None:
            return self._along_the_rows(mu, slope, speed)
        return self.memory.follow(mu, slope, speed, previous=self.previous, dt=self.dt)[:2]

    def _along_the_rows(self, mu: NDArray, slope: NDArray, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Steady rolling: each particle brings what it had one element upstream."""
        assert self.memory is not None
        assert self.upstream is not None
        assert self.previous is not None
        result, derivative = np.empty_like(mu), np.zeros((len(mu), len(mu)))
        for i in range(len(mu) - 1, -1, -1):
            above = self.upstream[i]
            before = self.previous[i] if above < 0 else result[above]
            one = slice(i, i + 1)
            value, bend, theta = self.memory.follow(
                mu[one], slope[one], speed[one], previous=np.array([before]), dt=self.dt
            )
            result[i] = value[0]
            if above >= 0:
                derivative[i] = theta[0] * derivative[above]
            derivative[i, i] += bend[0]
        return result, derivative

    def evaluate(self, tractions: NDArray) -> Evaluation:
        """Evaluate the equations for tractions in Pa, shape (2, k)."""
        matrix = self.matrix
        slip = (matrix @ tractions.reshape(-1)).reshape(tractions.shape) + self.shift
        trial = tractions - slip / matrix[0, 0]
        size = np.hypot(trial[0], trial[1])
        coefficient, slope = self.coefficient(self.speed(slip))
        bound = coefficient * self.pressure
        difference = tractions - trial * (bound / np.maximum(np.maximum(size, bound), np.finfo(float).tiny))
        # Over the bounds at rest where friction has vanished altogether.
        scale = float(bound.max()) or self.static * float(self.pressure.max())
        residual = float(np.abs(difference).max()) / scale
        return Evaluation(slip, trial, size, bound, coefficient, slope, residual)

    def state(self, tractions: NDArray, iterations: int, method: str) -> SlipFrictionState:
        """Return tractions that are taken for the solution, in Pa, shape (2, k), with what belongs to them."""
        at = self.evaluate(tractions)
        slipping = at.size > at.bound
        return SlipFrictionState(
            tractions,
            np.where(slipping, at.slip, 0.0),
            slipping,
            at.coefficient,
            iterations,
            at.residual,
            method,
        )
