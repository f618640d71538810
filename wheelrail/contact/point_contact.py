"""A point contact with a falling friction curve, for fast runs (Pieringer 2011, section 6.2).

The contact is a creep-force damper, `wheelrail.contact.creep.friction_curve`, in series with the spring of its own
elasticity (Thompson 2009, Railway noise and vibration): in steady rolling the creepage xi of the vehicle goes into the
damper, at high frequency the spring takes the motion. With D the motion of rail against wheel in a step that rolls by
dx, the creepage that slides is

    e = xi + [D + C (F - F')] / dx,     F = F(e),     D = D_0 + M F,

F' the force one step before, C the tangential compliance of the contact ellipse without rolling and without slip
(Mindlin 1949) and M what rail and wheel as a whole yield within the step.

Small lateral vibration about free rolling, against the transient rolling of the half-space (ellipse of 6.2 and 4.7 mm,
33 elements): at wavelengths of 10, 5, 2 and 1 times the contact length |F| is 8, 16, 22 and 2 % smaller, its phase 5
and 6 degrees behind, then 4 and 8 ahead.

Solution
    F = -kappa w(e) with kappa = f(r) / r between 0 and 1 and w linear in e, see the friction curve. For a given kappa
    the equation is linear, so that one scalar equation is left, kappa = f / r at e(kappa), with a solution between 0
    and 1 for certain. Newton's method finds it, kept within a bracket.

Several solutions
    In one direction there is one, if friction is constant or rises. On a falling curve, phi' = -dF/de < 0, there can be
    several where 1 + C phi' / dx < 0, C with M (in two directions: where the determinant of the equation's Jacobian is
    negative). Taken is the first on the way from the e of the step before, in the direction in which alternating
    between equation and curve would go from there; a pair of solutions within a factor of 2 in kappa may be stepped
    over. To the one that is taken the alternation converges, unless the start itself is a solution of the other kind.

    A contact without mass is unstable on the falling part: imposed motion leaves it as exp(x / (C |phi'|)), and
    steps hold it only if dx > 2 C |phi'|. Finer ones let it jump, and what follows depends on dx. A friction memory
    makes the fall take a sliding distance d_c; as dx -> 0 the sum 1 + C phi' / dx is then positive where
    C N (-s d mu_law / ds + mu' - mu_law) < d_c (cf. `wheelrail.contact.friction.laws.steepest_fall`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .creep.contact_spring import tangential_compliance
from .creep.friction_curve import NO_FRICTION, CreepStiffness, CurvePoint, creep_force, creep_stiffness, reduction
from .friction.laws import FrictionLaw
from .friction.memory import FrictionMemory
from .friction.settings import SlipFriction
from .solution import NormalSolution
from .tangential_models import NOTHING, STANDSTILL, Creepages, Motion, TangentialSolution, equivalent_ellipse

__all__ = ["MAXIMUM_ITERATIONS", "PointContact", "SlidingProblem", "SlidingState"]

TOLERANCE = 1e-13  # of the residual
MAXIMUM_ITERATIONS = 100
_LARGEST_STEP = math.log(2.0)  # of ln kappa, until a solution is bracketed
_PATIENCE = 8  # such steps, after which they grow: friction may have vanished altogether


class SlidingState(NamedTuple):
    """Solution of a `SlidingProblem`.

    Attributes
    ----------
    creepage : ndarray, shape (2,)
        e.
    point : CurvePoint
        Force and its derivatives there.
    iterations : int
        Evaluations of the scalar equation.
    residual : float
        Of e = h + B F, over the largest of its terms.
    """

    creepage: NDArray
    point: CurvePoint
    iterations: int
    residual: float


@dataclass(frozen=True)
class SlidingProblem:
    """The equation of one step, e = h + B F(e).

    Parameters
    ----------
    stiffness : CreepStiffness
    load : float
        N, > 0.
    spin : float
        1/m.
    law : FrictionLaw
    static : float
        mu_s, > 0.
    speed : float
        v in m/s.
    dt : float
        s.
    given : ndarray, shape (2,)
        h = xi + (D_0 - C F') / dx.
    yielding : ndarray, shape (2, 2)
        B = (C + M) / dx in 1/N; its symmetric part positive semi-definite, as it is of passive bodies.
    memory : FrictionMemory, optional
    previous : float
        mu', with memory: the coefficient one step before.
    """

    stiffness: CreepStiffness
    load: float
    spin: float
    law: FrictionLaw
    static: float
    speed: float
    dt: float
    given: NDArray
    yielding: NDArray
    memory: FrictionMemory | None = None
    previous: float = 0.0

    def coefficient(self, slip_speed: float) -> tuple[float, float]:
        """Return mu and d mu / ds in s/m at s in m/s."""
        speed = np.array([slip_speed])
        ratio, slope = self.law.evaluate(speed)
        mu, slope = self.static * ratio, self.static * slope
        if self.memory is not None:
            mu, slope, _ = self.memory.follow(mu, slope, speed, previous=np.array([self.previous]), dt=self.dt)
        return float(mu[0]), float(slope[0])

    def curve(self, creepage: NDArray) -> CurvePoint:
        """Evaluate force and derivatives at e, shape (2,)."""
        x, y = creepage.tolist()
        coefficient, slope = self.coefficient(self.speed * math.hypot(x, y))
        return creep_force(
            self.stiffness,
            creepage_x=x,
            creepage_y=y,
            spin=self.spin,
            load=self.load,
            coefficient=coefficient,
            slope=slope,
            speed=self.speed,
        )

    def determinant(self, creepage: NDArray) -> float:
        """Return det(1 - B dF/de) at e, shape (2,): for one direction alone 1 + C phi' / dx.

        Negative at a solution from which the alternation between equation and curve runs away. Positive everywhere:
        there is one solution.
        """
        return float(np.linalg.det(np.eye(2) - self.yielding @ self.curve(creepage).jacobian))

    def residual(self, creepage: NDArray, force: NDArray) -> float:
        """Violation of the equation over its largest term."""
        yielded = self.yielding @ force
        scale = max(np.abs(creepage).max(), np.abs(self.given).max(), np.abs(yielded).max())
        return float(np.abs(creepage - self.given - yielded).max() / scale) if scale > 0.0 else 0.0

    def solve(self, creepage: NDArray) -> SlidingState:
        """Find the solution next to a creepage, shape (2,); see the module on which one that is."""
        (b_xx, b_xy), (b_yx, b_yy) = self.yielding.tolist()
        c_x, c_y, c_s, _ = self.stiffness
        h_x, h_y = self.given.tolist()
        of_spin = c_s * self.spin
        a_xx, a_xy, a_yx, a_yy = b_xx * c_x, b_xy * c_y, b_yx * c_x, b_yy * c_y
        trace, det = a_xx + a_yy, a_xx * a_yy - a_xy * a_yx

        def at(share: float) -> tuple[float, float, float, float, float]:
            """Creepage of a share, ln(share / (f / r)), its slope over ln share, and the residual."""
            # (1 + kappa B D) e = h - kappa B w_0, Cramer's rule
            r_x, r_y = h_x - share * b_xy * of_spin, h_y - share * b_yy * of_spin
            below = 1.0 + share * (trace + share * det)
            m_xx, m_yy = 1.0 + share * a_xx, 1.0 + share * a_yy
            e_x = (m_yy * r_x - share * a_xy * r_y) / below
            e_y = (m_xx * r_y - share * a_yx * r_x) / below
            w_x, w_y = c_x * e_x, c_y * e_y + of_spin
            size, total = math.hypot(w_x, w_y), math.hypot(e_x, e_y)
            mu, slope = self.coefficient(self.speed * total)
            bound = max(mu * self.load, NO_FRICTION * size)
            ratio = size / bound if size > 0.0 else 0.0
            factor, bend = reduction(ratio)
            # (1 + kappa B D) de = -B w d kappa
            y_x, y_y = b_xx * w_x + b_xy * w_y, b_yx * w_x + b_yy * w_y
            d_x = -(m_yy * y_x - share * a_xy * y_y) / below
            d_y = -(m_xx * y_y - share * a_yx * y_x) / below
            d_ratio = 0.0
            if size > 0.0:
                d_ratio = (w_x * c_x * d_x + w_y * c_y * d_y) / (size * bound)
            if total > 0.0 and mu * self.load >= bound:
                d_ratio -= ratio * slope * self.speed * (e_x * d_x + e_y * d_y) / (total * mu)
            scale = max(abs(e_x), abs(e_y), abs(h_x), abs(h_y))
            violated = abs(factor - share) * max(abs(y_x), abs(y_y))
            residual = violated / scale if scale > 0.0 else 0.0
            return e_x, e_y, math.log(share / factor), 1.0 - share / factor * bend * d_ratio, residual

        z = math.log(max(self.curve(creepage).factor, NO_FRICTION))
        low, high, step = -math.inf, math.inf, 0.0
        best, smallest, count = (0.0, 0.0), math.inf, 0
        while count < MAXIMUM_ITERATIONS:
            e_x, e_y, value, slope, residual = at(math.exp(z))
            count += 1
            if residual < smallest:
                best, smallest = (e_x, e_y), residual
            if residual <= TOLERANCE:
                break
            if value < 0.0:
                low = z
            else:
                high = z
            last = abs(step)
            step = -value / slope if slope > 0.0 else math.copysign(max(abs(value), 2.0 * last), -value)
            if low > -math.inf and high < math.inf:
                # Newton's step if it stays in the bracket and the steps shrink, else halve the bracket.
                if slope <= 0.0 or not low < z + step < high or abs(step) > 0.5 * last:
                    step = 0.5 * (low + high) - z
            else:
                step = math.copysign(min(abs(step), _LARGEST_STEP * 2.0 ** max(count - _PATIENCE, 0)), step)
            before, z = z, min(z + step, 0.0)
            if z == before:  # as near as numbers can tell
                break
        e = np.array(best)
        point = self.curve(e)
        return SlidingState(e, point, count, self.residual(e, point.force))


@dataclass(frozen=True)
class PointContact:
    """Falling friction curve with contact spring.

    Memory, 5 numbers: force F on the rail (x and y, N), sliding creepage e (x and y), friction coefficient mu. Without
    a normal force they are 0, 0 and that of the law at s = 0.

    Parameters
    ----------
    shear_modulus : float
        Pa, of both bodies.
    poisson_ratio : float
    law : FrictionLaw
        Over s = v |e|.
    friction_memory : FrictionMemory or None
        One coefficient for the whole contact, which follows the law over the distance that the contact slides.
    """

    shear_modulus: float
    poisson_ratio: float
    law: FrictionLaw
    friction_memory: FrictionMemory | None = None
    kind = "friction-curve"

    @property
    def memory(self) -> int:
        """Numbers that it keeps from step to step."""
        return 5

    @property
    def _friction(self) -> SlipFriction:
        return SlipFriction(self.law, self.friction_memory)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know before a run."""
        return self._friction.remarks

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description."""
        return {
            "kind": self.kind,
            "shear_modulus": self.shear_modulus,
            "poisson_ratio": self.poisson_ratio,
            "friction": self._friction.to_parts(),
        }

    def begin(
        self, normal: NormalSolution, creepages: Creepages, *, friction: float, dx: float, dt: float
    ) -> TangentialSolution:
        """Steady rolling: all of the creepage slides, and the coefficient is that of the law."""
        if normal.force <= 0.0 or friction == 0.0:
            return self._free(friction)
        problem = SlidingProblem(
            creep_stiffness(**self._ellipse(normal)),
            float(normal.force),
            creepages.spin,
            self.law,
            friction,
            dx / dt,
            dt,
            np.zeros(2),
            np.zeros((2, 2)),
        )
        e = np.array([creepages.x, creepages.y])
        return self._solution(SlidingState(e, problem.curve(e), 1, 0.0), dx)

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
        """Solve one step of dx (m) in dt (s); ``memory`` of shape (5,)."""
        if normal.force <= 0.0 or friction == 0.0:
            return self._free(friction)
        ellipse = self._ellipse(normal)
        spring = np.array(tangential_compliance(**ellipse))
        force, creepage, coefficient = memory[:2], memory[2:4], float(memory[4])
        yielding = np.diag(spring)
        if motion.compliance is not None:
            yielding = yielding + motion.compliance
        given = np.array([creepages.x + motion.x / dx, creepages.y + motion.y / dx]) - spring * force / dx
        problem = SlidingProblem(
            creep_stiffness(**ellipse),
            float(normal.force),
            creepages.spin,
            self.law,
            friction,
            dx / dt,
            dt,
            given,
            yielding / dx,
            self.friction_memory,
            coefficient,
        )
        return self._solution(problem.solve(creepage), dx)

    def _ellipse(self, normal: NormalSolution) -> dict[str, float]:
        """Ellipse of the contact, and the material."""
        semi_axis_x, semi_axis_y = equivalent_ellipse(normal)
        return {
            "semi_axis_x": semi_axis_x,
            "semi_axis_y": semi_axis_y,
            "shear_modulus": self.shear_modulus,
            "poisson_ratio": self.poisson_ratio,
        }

    def _free(self, friction: float) -> TangentialSolution:
        at_rest = friction * float(self.law.evaluate(np.zeros(1))[0][0])
        return NOTHING._replace(memory=np.array([0.0, 0.0, 0.0, 0.0, at_rest]))

    def _solution(self, state: SlidingState, dx: float) -> TangentialSolution:
        """Results of a step.

        The stick area of Vermeulen and Johnson is an ellipse of the contact's proportions, smaller by the factor
        1 - tau, tau = r / 3: F = mu N [1 - (1 - tau)^3]. So 1 - (1 - tau)^2 of the area slips.
        """
        point = state.point
        tau = min(point.ratio / 3.0, 1.0)
        force_x, force_y = point.force.tolist()
        return TangentialSolution(
            force_x,
            force_y,
            point.moment_spin,
            tau * (2.0 - tau),
            point.work_per_length * dx,
            state.iterations,
            state.residual,
            np.array([force_x, force_y, *state.creepage, point.coefficient]),
        )
