"""The point contact: equation of a step, spring and damper, several solutions, memory, energy."""

from __future__ import annotations

import cmath
import json
import math

import numpy as np
import pytest

from wheelrail.contact.creep.contact_spring import tangential_compliance
from wheelrail.contact.creep.friction_curve import creep_stiffness, steady_creep_force
from wheelrail.contact.friction.laws import (
    ConstantLaw,
    ExponentialLaw,
    FrictionLaw,
    KraftLaw,
    PolachLaw,
    TableLaw,
)
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.parts import tangential_model
from wheelrail.contact.point_contact import PointContact, SlidingProblem
from wheelrail.contact.rolling import rigid_shift, roll
from wheelrail.contact.solution import NormalSolution
from wheelrail.contact.spring import HertzSpring
from wheelrail.contact.tangential_models import Creepages, Motion, TangentialSolution

G, NU = 80e9, 0.3
LOAD, STATIC, SPEED, DX = 65e3, 0.3, 14.0, 1e-3
FALLING = ExponentialLaw(0.4, 0.1)
MEMORY = FrictionMemory(distance=50e-6, speed=1e-3)


def normal(load: float = LOAD, axis_ratio: float = 1.3) -> NormalSolution:
    """An ellipse that grows as Hertz's."""
    if load <= 0.0:
        return NormalSolution(0.0, -1e-5, 0.0, 0.0, 0.0, 0.0, 0.0, 1, 0.0)
    c = 5.4e-3 * (load / LOAD) ** (1.0 / 3.0)
    a, b = c * math.sqrt(axis_ratio), c / math.sqrt(axis_ratio)
    return NormalSolution(load, 8e-5, 1e9, 2.0 * a, 2.0 * b, math.pi * a * b, 1.5 * load / (math.pi * a * b), 1, 0.0)


def ellipse(solution: NormalSolution) -> dict[str, float]:
    return {
        "semi_axis_x": 0.5 * solution.length,
        "semi_axis_y": 0.5 * solution.width,
        "shear_modulus": G,
        "poisson_ratio": NU,
    }


def compliance(solution: NormalSolution) -> np.ndarray:
    return np.diag(tangential_compliance(**ellipse(solution)))


def curve(law: FrictionLaw, creepages: Creepages):
    """The steady curve under the nominal load."""
    return steady_creep_force(
        creep_stiffness(**ellipse(normal())),
        creepage_x=creepages.x,
        creepage_y=creepages.y,
        spin=creepages.spin,
        load=LOAD,
        law=law,
        static=STATIC,
        speed=SPEED,
    )


def begin(model: PointContact, creepages: Creepages, dx: float = DX) -> TangentialSolution:
    return model.begin(normal(), creepages, friction=STATIC, dx=dx, dt=dx / SPEED)


def step(model, creepages, memory, motion=(0.0, 0.0), *, dx=DX, load=LOAD, friction=STATIC, given=None):
    return model.step(
        normal(load),
        creepages,
        friction=friction,
        dx=dx,
        dt=dx / SPEED,
        memory=memory,
        motion=Motion(motion[0], motion[1], given),
    )


def kept(solution: TangentialSolution) -> np.ndarray:
    """What the next step takes: force, creepage, coefficient."""
    assert solution.memory is not None
    return solution.memory


# The equation of a step.


@pytest.mark.parametrize("law", [ConstantLaw(), FALLING, KraftLaw(normalise=False)])
@pytest.mark.parametrize("memory", [None, MEMORY])
def test_steady_rolling_is_the_curve(law, memory):
    creepages, model = Creepages(1e-3, -4e-3, 0.2), PointContact(G, NU, law, memory)
    expected = curve(law, creepages)
    state = begin(model, creepages)
    assert np.array_equal(np.array([state.force_x, state.force_y]), expected.force)
    assert state.residual == 0.0
    # From another creepage it gets there too; 3 mm: steps are stable on the falling part.
    other = kept(begin(model, Creepages(-1e-3, 2e-3, 0.0), dx=3e-3))
    for _ in range(300):
        other = kept(step(model, creepages, other, dx=3e-3))
    for forces, limit in ((kept(step(model, creepages, kept(state))), 1e-14), (other, 1e-12)):
        # 4e-16 from the start, 7e-16 from elsewhere
        assert np.abs(forces[:2] - expected.force).max() < limit * np.hypot(*expected.force)
        assert np.abs(forces[2:4] - creepages[:2]).max() < limit * math.hypot(*creepages[:2])
        assert forces[4] == pytest.approx(expected.coefficient, rel=limit)


def test_full_sliding():
    for memory in (None, MEMORY):
        model = PointContact(G, NU, FALLING, memory)
        state = step(model, Creepages(0.02, -0.03, 0.0), kept(begin(model, Creepages(0.02, -0.03, 0.0))))
        mu = STATIC * float(FALLING.evaluate(np.array([SPEED * math.hypot(0.02, 0.03)]))[0][0])
        assert math.hypot(state.force_x, state.force_y) == pytest.approx(mu * LOAD, rel=1e-14)
        assert state.slip_fraction == 1.0
        assert state.friction_work == pytest.approx(-(state.force_x * 0.02 - state.force_y * 0.03) * DX, rel=1e-13)


def test_slipping_area_grows_from_none_to_all():
    model = PointContact(G, NU, ConstantLaw())
    shares = [begin(model, Creepages(0.0, y, 0.0)).slip_fraction for y in np.geomspace(1e-6, 0.02, 60)]
    assert np.all(np.diff(shares) >= 0.0)
    assert shares[0] < 1e-3
    assert shares[-1] == 1.0
    state = begin(model, Creepages(0.0, 2e-3, 0.0))
    # F = mu N (1 - c^3), stick area c^2
    assert (1.0 - state.slip_fraction) ** 1.5 == pytest.approx(1.0 + state.force_y / (STATIC * LOAD), rel=1e-12)


@pytest.mark.parametrize("dx", [1e-3, 1e-5])
@pytest.mark.parametrize("memory", [None, FrictionMemory(20e-6, 1e-3)])
@pytest.mark.parametrize(
    "law",
    [
        ConstantLaw(),
        FALLING,
        KraftLaw(normalise=False),
        PolachLaw(0.0, 30.0),
        TableLaw((0.0, 0.1, 0.2), (0.5, 0.9, 0.3)),
    ],
)
def test_random_steps_satisfy_the_equation(law, memory, dx):
    """Loads from 1 N to 100 kN and none, any creepages, motions up to 0.1 mm in a step, soft wheels and rails."""
    rng = np.random.default_rng(3)
    model, dt = PointContact(G, NU, law, memory), dx / SPEED
    state = begin(model, Creepages(0.0, -0.01, 0.0), dx)
    worst, most = 0.0, 0
    for _ in range(300):
        load = float(rng.choice([0.0, 1.0, 100.0, LOAD, 100e3], p=[0.05, 0.05, 0.1, 0.6, 0.2]))
        contact = normal(load, 10.0 ** rng.uniform(-0.8, 0.8))
        random = rng.normal(size=3) * 10.0 ** rng.uniform(-6.0, -1.5, 3) * rng.integers(0, 2, 3)
        creepages = Creepages(float(random[0]), float(random[1]), float(10.0 * random[2]))
        root = rng.normal(size=(2, 2))
        soft = root @ root.T * 10.0 ** rng.uniform(-12.0, -8.0) if rng.random() < 0.7 else None
        shift = rng.normal(size=2) * 10.0 ** rng.uniform(-10.0, -4.0, 2)
        motion = Motion(float(shift[0]), float(shift[1]), soft)
        before = kept(state)
        state = model.step(contact, creepages, friction=STATIC, dx=dx, dt=dt, memory=before, motion=motion)
        after = kept(state)
        if load == 0.0:
            continue
        force, e, mu = after[:2], after[2:4], after[4]
        # the equation, from the results alone
        moved = shift + (0.0 if soft is None else soft @ force)
        terms = [creepages[:2], moved / dx, compliance(contact) @ force / dx, compliance(contact) @ before[:2] / dx]
        violated = e - terms[0] - terms[1] - terms[2] + terms[3]
        worst = max(worst, np.abs(violated).max() / max(np.abs(term).max() for term in [e, *terms]))
        most = max(most, state.iterations)
        assert state.residual < 1e-11
        # friction
        s = np.array([SPEED * math.hypot(*e)])
        expected = STATIC * law.evaluate(s)[0]
        if memory is not None:
            expected = memory.follow(expected, expected, s, previous=before[4:], dt=dt)[0]
        assert mu == pytest.approx(expected[0], rel=1e-13, abs=1e-300)
        assert np.hypot(*force) <= mu * load * (1.0 + 1e-14)
        # work of the contact, spin included
        work = -(force @ e + state.moment_spin * creepages.spin) * dx
        assert state.friction_work >= 0.0
        scale = abs(state.moment_spin * creepages.spin) + np.abs(force * e).sum()
        assert state.friction_work == pytest.approx(work, rel=1e-12, abs=1e-14 * scale * dx)
    assert worst < 1e-11  # 6e-13
    assert most <= 60  # 42; 5 to 9 on average


def test_loss_of_contact_and_no_friction():
    model = PointContact(G, NU, KraftLaw(normalise=False), MEMORY)
    creepages = Creepages(0.0, -0.01, 0.1)
    memory = kept(begin(model, creepages))
    at_rest = STATIC * 0.7
    free = step(model, creepages, memory, load=0.0)
    assert free[:7] == (0.0, 0.0, 0.0, 0.0, 0.0, 0, 0.0)
    assert kept(free) == pytest.approx([0.0, 0.0, 0.0, 0.0, at_rest])
    assert model.begin(normal(0.0), creepages, friction=STATIC, dx=DX, dt=DX / SPEED)[:7] == free[:7]
    without = step(model, creepages, memory, friction=0.0)
    assert without[:7] == free[:7]
    assert not np.any(kept(without))
    # Back in contact the spring is not strained: it takes up the first shift.
    again = step(model, Creepages(0.0, 1e-6, 0.0), kept(free))
    stiffness = creep_stiffness(**ellipse(normal())).y
    expected = -1e-6 / (1.0 / stiffness + compliance(normal())[1, 1] / DX)
    assert again.force_y == pytest.approx(expected, rel=1e-3)


def test_nothing_moves():
    model = PointContact(G, NU, FALLING)
    still = Creepages(0.0, 0.0, 0.0)
    state = step(model, still, kept(begin(model, still)))
    assert state[:5] == (0.0, 0.0, 0.0, 0.0, 0.0)
    assert state.residual == 0.0


def test_parts():
    for memory in (None, MEMORY):
        model = PointContact(G, NU, FALLING, memory)
        spring = HertzSpring(1e11, (1e-4, 1e-4), 1, np.ones(1), None, LOAD)
        assert tangential_model(json.loads(json.dumps(model.to_parts())), spring) == model
        assert bool(model.remarks) == (memory is None)
        assert model.to_parts()["kind"] == model.kind == "friction-curve"
        assert len(kept(begin(model, Creepages(0.0, 1e-3, 0.0)))) == model.memory


# Small vibration about steady rolling.


def response(model: PointContact, creepages: Creepages, wavelength_steps: int, dx: float, amplitude: float) -> complex:
    """Lateral force over lateral displacement of rail against wheel, from a run of steps."""
    steady = begin(model, creepages, dx)
    factor = cmath.exp(2j * math.pi / wavelength_steps)
    memory, total, periods = kept(steady), 0.0j, 40
    for n in range(1, periods * wavelength_steps + 1):
        shift = amplitude * (factor**n - factor ** (n - 1)).real
        memory = kept(step(model, creepages, memory, (0.0, shift), dx=dx))
        if n > (periods - 1) * wavelength_steps:
            total += (memory[1] - steady.force_y) * factor**-n
    return 2.0 * total / (wavelength_steps * amplitude)


def slopes(law: FrictionLaw, creepage_y: float) -> tuple[float, float]:
    """phi' = -dF_y / de_y with the coefficient held, and what the fall of friction adds to it, N."""
    whole = curve(law, Creepages(0.0, creepage_y, 0.0))
    held = steady_creep_force(
        creep_stiffness(**ellipse(normal())),
        creepage_x=0.0,
        creepage_y=creepage_y,
        spin=0.0,
        load=LOAD,
        law=ConstantLaw(),
        static=whole.coefficient,
        speed=SPEED,
    ).jacobian[1, 1]
    return -float(held), float(held - whole.jacobian[1, 1])


def analytic(held: float, fall: float, derivative: complex, delay: complex = 1.0) -> complex:
    """Damper phi' / v and spring 1 / C in series; ``derivative`` over the rolled distance, 1/m.

    A friction memory multiplies the fall by ``delay``.
    """
    slope = held + delay * fall
    return -derivative * slope / (1.0 + derivative * slope * float(compliance(normal())[1, 1]))


@pytest.mark.parametrize("wavelength", [1.0, 30e-3, 5e-3])  # damper, both, spring
@pytest.mark.parametrize("steps", [20, 40])
def test_vibration_is_that_of_spring_and_damper(wavelength, steps):
    creepage, dx = -1e-3, wavelength / steps
    model, (held, fall) = PointContact(G, NU, ConstantLaw()), slopes(ConstantLaw(), creepage)
    assert fall == 0.0
    run = response(model, Creepages(0.0, creepage, 0.0), steps, dx, 1e-6 * dx)
    turn = 2.0 * math.pi / steps
    discrete = analytic(held, fall, (1.0 - cmath.exp(-1j * turn)) / dx)
    assert abs(run / discrete - 1.0) < 2e-9  # 9e-10, with the square of the amplitude
    continuous = analytic(held, fall, 1j * turn / dx)
    assert abs(run / continuous - 1.0) < 0.5 * turn  # half a step late in the damper: 0.495, 0.28 and 0.06 of turn


@pytest.mark.parametrize(
    ("lengths", "size", "phase"), [(10, -0.11, -5.3), (5, -0.19, -5.7), (2, -0.25, 4.8), (1, -0.05, 7.7)]
)
def test_vibration_against_the_half_space(lengths, size, phase):
    """What a single spring and damper make of free rolling; coarse grid, 17 elements over the contact length."""
    hertz = hertz_contact(
        curvature_x=1 / 0.46, curvature_y=1 / 0.3, youngs_modulus=2.0 * (1.0 + NU) * G, poisson_ratio=NU, load=LOAD
    )
    a, b, elements = hertz.semi_axis_x, hertz.semi_axis_y, 17
    dx = 2.0 * a / elements
    grid = HalfSpace(elements + 4, elements + 4, dx, 2.0 * b / elements, G, NU)
    state = solve_normal(NormalProblem(grid, 0.5 * (grid.x**2 / 0.46 + grid.y**2 / 0.3), 0.0, 1.0, LOAD))
    steps, periods = lengths * elements, 2 + 6 // lengths
    factor, tractions, total = cmath.exp(2j * math.pi / (lengths * elements)), np.zeros((2, grid.elements)), 0.0j
    for n in range(1, periods * steps + 1):
        moved = 1e-9 * (factor**n - factor ** (n - 1)).real
        shift = rigid_shift(grid, creepage_x=0.0, creepage_y=moved, creepage_spin=0.0, distance=1.0)
        rolled = roll(grid, state, friction=1e4, shift=shift, previous=tractions)
        tractions = rolled.tractions
        if n > (periods - 1) * steps:
            total += rolled.force_y * factor**-n
    exact = 2.0 * total / (steps * 1e-9)
    same = {"semi_axis_x": a, "semi_axis_y": b, "shear_modulus": G, "poisson_ratio": NU}
    damper, derivative = creep_stiffness(**same).y, (1.0 - factor**-1) / dx
    point = -derivative * damper / (1.0 + derivative * damper * tangential_compliance(**same)[1])
    assert abs(point / exact) - 1.0 == pytest.approx(size, abs=0.01)
    assert math.degrees(cmath.phase(point / exact)) == pytest.approx(phase, abs=0.3)


def test_vibration_on_the_falling_curve():
    """Without memory: a negative damper, in steps long enough to hold it."""
    creepage, dx, steps = -0.02, 5e-3, 40
    held, fall = slopes(FALLING, creepage)
    assert held == 0.0
    assert -0.5 < compliance(normal())[1, 1] * fall / dx < 0.0
    run = response(PointContact(G, NU, FALLING), Creepages(0.0, creepage, 0.0), steps, dx, 1e-5 * dx)
    turn = 2.0 * math.pi / steps
    discrete = analytic(held, fall, (1.0 - cmath.exp(-1j * turn)) / dx)
    assert abs(run / discrete - 1.0) < 1e-8  # 3e-9
    velocity = run / (1j * turn / dx)
    assert velocity.real > 0.0  # the force drives the motion


@pytest.mark.parametrize("dx", [1e-3, 1e-4])
def test_vibration_with_memory(dx):
    """The fall of friction comes late, 1 / (1 + p d_c / |e|)."""
    creepage, steps = -0.02, 40
    held, fall = slopes(FALLING, creepage)
    run = response(PointContact(G, NU, FALLING, MEMORY), Creepages(0.0, creepage, 0.0), steps, dx, 1e-5 * dx)
    turn = 2.0 * math.pi / steps
    z, theta = cmath.exp(-1j * turn), MEMORY.distance / (MEMORY.distance + abs(creepage) * dx)
    discrete = analytic(held, fall, (1.0 - z) / dx, (1.0 - theta) / (1.0 - theta * z))
    assert abs(run / discrete - 1.0) < 1e-8  # 2e-9
    p = 1j * turn / dx
    continuous = analytic(held, fall, p, 1.0 / (1.0 + p * MEMORY.distance / abs(creepage)))
    assert abs(run / continuous - 1.0) < 0.5 * turn  # 0.46 and 0.13 of turn


# Falling friction: several solutions, and memory.


def problem(creepage_y: float, dx: float, memory: FrictionMemory | None) -> SlidingProblem:
    """A step at whose end steady sliding goes on."""
    point = curve(FALLING, Creepages(0.0, creepage_y, 0.0))
    yielding = compliance(normal()) / dx
    return SlidingProblem(
        creep_stiffness(**ellipse(normal())),
        LOAD,
        0.0,
        FALLING,
        STATIC,
        SPEED,
        dx / SPEED,
        np.array([0.0, creepage_y]) - yielding @ point.force,
        yielding,
        memory,
        point.coefficient,
    )


def solutions(step_problem: SlidingProblem) -> list[float]:
    """All lateral creepages between 0 and 0.2, from a scan."""
    e = np.concatenate([[0.0], np.geomspace(1e-6, 0.2, 5000)])
    g = np.empty_like(e)
    for i, value in enumerate(e):
        at = np.array([0.0, value])
        g[i] = (at - step_problem.given - step_problem.yielding @ step_problem.curve(at).force)[1]
    return [float(0.5 * (e[i] + e[i + 1])) for i in np.flatnonzero(np.sign(g[1:]) != np.sign(g[:-1]))]


def test_several_solutions_and_which_is_taken():
    step_problem = problem(0.01, 1e-4, None)
    roots = solutions(step_problem)
    assert len(roots) == 3
    assert roots[1] == pytest.approx(0.01, rel=2e-3)
    signs = [math.copysign(1.0, step_problem.determinant(np.array([0.0, root]))) for root in roots]
    assert signs == [1.0, -1.0, 1.0]
    for start, expected in ((0.0, 0), (0.5 * roots[0], 0), (0.0099, 0), (0.0101, 2), (roots[2], 2), (0.5, 2)):
        state = step_problem.solve(np.array([0.0, start]))
        assert state.residual < 1e-13
        assert state.creepage[1] == pytest.approx(roots[expected], rel=2e-3)  # of the scan
        assert step_problem.determinant(state.creepage) > 0.0


def test_the_determinant_is_one_plus_the_slope_of_the_curve():
    for dx in (1e-3, 1e-4):
        step_problem = problem(0.01, dx, None)
        held, fall = slopes(FALLING, 0.01)
        c = tangential_compliance(**ellipse(normal()))[1]
        along = 1.0 + c * (held + fall) / dx
        assert along > 0.0 if dx == 1e-3 else along < 0.0
        at = np.array([0.0, 0.01])
        across = 1.0 - step_problem.yielding[0, 0] * step_problem.curve(at).jacobian[0, 0]
        assert step_problem.determinant(at) == pytest.approx(along * across, rel=1e-12)


def test_memory_leaves_one_solution():
    """In steps at which there are three without."""
    # C N (-s d mu / ds) < d_c
    s = np.geomspace(1e-3, 10.0, 2000)
    fall = float(np.max(-STATIC * s * FALLING.evaluate(s)[1]))
    limit = tangential_compliance(**ellipse(normal()))[1] * LOAD * fall
    assert limit == pytest.approx(4.17e-6, rel=1e-2)
    assert limit < MEMORY.distance
    for dx in (1e-4, 1e-5, 1e-6):
        for creepage in (0.01, 0.02):
            assert problem(creepage, dx, None).determinant(np.array([0.0, creepage])) < 0.0
            with_memory = problem(creepage, dx, MEMORY)
            assert len(solutions(with_memory)) == 1
            for e in np.geomspace(1e-5, 0.2, 200):
                assert with_memory.determinant(np.array([0.0, e])) > 0.0


def test_steps_jump_without_memory():
    """Pushed by 0.1 nm towards less slip, the contact without memory leaves sliding at once."""
    dx, creepages = 1e-5, Creepages(0.0, -0.01, 0.0)
    for memory, jumps in ((None, True), (MEMORY, False)):
        model = PointContact(G, NU, FALLING, memory)
        after = step(model, creepages, kept(begin(model, creepages, dx)), (0.0, 1e-10), dx=dx)
        assert after.residual < 1e-12
        slip = kept(after)[3] / -0.01
        # 0.18 without; with memory 1 - 1.1e-3, the push of 1e-5 / 0.01 and a little more
        assert (slip < 0.5) if jumps else abs(slip - 1.0) < 2e-3


@pytest.mark.parametrize("parts", [10, 100])
def test_memory_relaxes_exponentially_over_the_sliding_distance(parts):
    """Bodies so stiff that all of the creepage slides at any time."""
    law, static, creepage = PolachLaw(0.3, 10.0), 0.3, 0.02
    model = PointContact(1e24, NU, law, MEMORY)
    dx = MEMORY.distance / creepage / parts
    memory = kept(begin(model, Creepages(0.0, -1e-4, 0.0), dx))
    first = float(memory[4])
    last = static * float(law.evaluate(np.array([SPEED * creepage]))[0][0])
    for n in range(1, 3 * parts + 1):
        memory = kept(step(model, Creepages(0.0, -creepage, 0.0), memory, dx=dx))
        left = (float(memory[4]) - last) / (first - last)
        assert left == pytest.approx((1.0 + 1.0 / parts) ** -n, rel=1e-12)  # 3e-14
        assert memory[1] == pytest.approx(memory[4] * LOAD, rel=1e-9)
        assert abs(left - math.exp(-n / parts)) < 0.2 / parts  # 0.18 / parts: first order
