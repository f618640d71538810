"""Friction that falls with the slip velocity, quasi-static (Pieringer 2011, section 5.3.2): the two problems, one cure.

Without memory the contact swings from step to step, the more so the finer the grid is, and single steps have several
solutions. With a friction memory of 3 um the force is constant and converges with the grid.
"""

import argparse
from pathlib import Path

import numpy as np

from wheelrail.contact.friction.laws import KraftLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.problem import SlipFrictionProblem
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.friction.solutions import find_solutions
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift
from wheelrail.contact.slip_dependent_rolling import entering, roll_slip_dependent
from wheelrail.plotting.falling_friction import (
    CentreLine,
    centre_lines_figure,
    force_by_grid_figure,
    friction_laws_figure,
)
from wheelrail.progress import progress_bar

WHEEL_RADIUS, RAIL_RADIUS, LOAD, STATIC = 0.39, 0.30, 65e3, 0.3  # m, m, N, -
YOUNGS_MODULUS, POISSON_RATIO = 207e9, 0.3  # Pa, -
SPEED, CREEPAGE = 50.0 / 3.6, 5e-3  # m/s, -
MEMORY = FrictionMemory(distance=3e-6, speed=1e-3)  # m, m/s
STEPS = {1e-3: 80, 0.5e-3: 120, 0.25e-3: 120}  # of each grid spacing in m


class Rolling:
    """Rolling from zero traction on one grid."""

    def __init__(self, dx, friction):
        across = 2 * round(8e-3 / dx) + 1
        self.grid = HalfSpace(across, across, dx, dx, YOUNGS_MODULUS / (2 * (1 + POISSON_RATIO)), POISSON_RATIO)
        gap = self.grid.x**2 / (2 * WHEEL_RADIUS) + self.grid.y**2 / (2 * RAIL_RADIUS)
        self.normal = solve_normal(NormalProblem(self.grid, gap, weight=0.0, compliance=1.0, rhs=LOAD))
        self.friction, self.dt = friction, dx / SPEED
        self.shift = rigid_shift(self.grid, creepage_x=0.0, creepage_y=CREEPAGE, creepage_spin=0.0, distance=dx)
        self.tractions = np.zeros((2, self.grid.elements))
        self.speed = np.zeros(self.grid.elements)
        self.coefficient = entering(self.grid, friction, STATIC)
        self.force, self.residual = [], 0.0

    def problem(self):
        """Return the problem of the next step, without memory."""
        contact = self.normal.contact
        h = (self.shift - self.grid.carried_displacement(self.tractions))[:, contact]
        return SlipFrictionProblem(
            self.grid, contact, self.normal.pressure[contact], h, self.dt, self.friction.law, STATIC
        )

    def step(self):
        """Roll on by dx."""
        state = roll_slip_dependent(
            self.grid,
            self.normal,
            friction=self.friction,
            static=STATIC,
            dt=self.dt,
            shift=self.shift,
            previous=self.tractions,
            speed=self.speed,
            coefficient=self.coefficient,
        )
        self.tractions, self.speed, self.coefficient = state.rolling.tractions, state.speed, state.coefficient
        self.force.append(state.rolling.force_y)
        self.residual = max(self.residual, state.rolling.residual)

    def centre_line(self, label, tractions=None, speed=None):
        """Return the contact along y = 0; by default that of the last step."""
        grid = self.grid
        row = slice((grid.my // 2) * grid.mx, (grid.my // 2 + 1) * grid.mx)
        p = self.tractions if tractions is None else tractions
        s = self.speed if speed is None else speed
        bound = STATIC * self.friction.at_rest * self.normal.pressure
        return CentreLine(label, grid.x[row], np.hypot(*p)[row], bound[row], s[row])


def several_solutions(rolling, steps):
    """Roll on until a step has several solutions; return them as centre lines, and their forces."""
    for _ in range(steps):
        problem, contact = rolling.problem(), rolling.normal.contact
        found = find_solutions(problem, rolling.tractions[:, contact], rolling.speed[contact])
        if len(found) > 1:
            lines, forces = [], {}
            for each in found:
                tractions, speed = np.zeros((2, rolling.grid.elements)), np.zeros(rolling.grid.elements)
                tractions[:, contact], speed[contact] = each.state.tractions, problem.speed(each.state.slip)
                forces[each.name] = rolling.grid.element_area * float(tractions[1].sum())
                name = f"{each.name}, {1e-3 * forces[each.name]:.1f} kN" + ", repelling" * each.repelling
                lines.append(rolling.centre_line(name, tractions, speed))
            return lines, forces
        rolling.step()
    return [], {}


def main():
    """Roll without and with memory, look for several solutions, draw, check."""
    parser = argparse.ArgumentParser(description="falling friction, thesis section 5.3.2")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for pictures")
    parser.add_argument("--fine", action="store_true", help="also dx = 0.25 mm; takes some ten minutes")
    options = parser.parse_args()
    folder = options.output / "falling_friction"
    folder.mkdir(parents=True, exist_ok=True)
    spacings = [1e-3, 0.5e-3] + [0.25e-3] * options.fine
    printed, normalised = SlipFriction(KraftLaw(False)), SlipFriction(KraftLaw(True))

    speed = np.linspace(0.0, 1.5, 301)
    laws = {
        "as printed": (speed, STATIC * KraftLaw(False).evaluate(speed)[0]),
        "normalised": (speed, STATIC * KraftLaw(True).evaluate(speed)[0]),
    }
    friction_laws_figure(laws, title="Kraft's friction law, static coefficient 0.3").savefig(folder / "laws.png")

    runs = {}
    for name, friction in (
        ("as printed", printed),
        ("normalised", normalised),
        ("normalised, memory 3 um", SlipFriction(KraftLaw(True), MEMORY)),
    ):
        for dx in spacings:
            rolling, steps = Rolling(dx, friction), STEPS[dx]
            cycle = []
            with progress_bar(f"{name}, dx {1e3 * dx:g} mm", total=steps) as reached:
                for step in range(steps):
                    rolling.step()
                    if step >= steps - 9:
                        label = f"step {step - steps + 10}, {1e-3 * rolling.force[-1]:.1f} kN"
                        cycle.append(rolling.centre_line(label))
                    reached(step + 1)
            runs[name, dx] = rolling, np.array(rolling.force), cycle
            late = runs[name, dx][1][steps // 2 :]
            print(
                f"{name:24s} dx {1e3 * dx:4g} mm  lateral force {late.mean():9.1f} N, {late.min():9.1f} to "
                f"{late.max():9.1f} N, residual {rolling.residual:.0e}"
            )

    drawn, end = {}, min(STEPS[dx] * dx / SPEED for dx in spacings)
    for dx in spacings:
        rolling, force, _ = runs["as printed", dx]
        time = rolling.dt * np.arange(1, len(force) + 1)
        shown = (time > end - 0.8e-3) & (time <= end)
        drawn[f"dx {1e3 * dx:g} mm"] = (time[shown], force[shown])
    title = "Falling friction as printed, quasi-static: lateral force"
    force_by_grid_figure(drawn, title=title).savefig(folder / "force_by_grid.png")
    _, _, cycle = runs["as printed", spacings[-1]]
    title = f"Consecutive steps, dx {1e3 * spacings[-1]:g} mm: centre line of the contact"
    centre_lines_figure(cycle, title=title).savefig(folder / "cycle.png")

    forces = {}
    # The step before a jump; with --fine that of the thesis, figure 5.8.
    for name, friction, dx, before in [("normalised", normalised, 0.5e-3, 9), ("as printed", printed, 0.25e-3, 16)][
        : 1 + options.fine
    ]:
        rolling = Rolling(dx, friction)
        for _ in range(before):
            rolling.step()
        lines, forces[name] = several_solutions(rolling, 12)
        for which, force in forces[name].items():
            print(f"step {len(rolling.force)} at dx {1e3 * dx:g} mm, {name}: {which:10s} {force:9.1f} N")
        title = f"Solutions of step {len(rolling.force)}, dx {1e3 * dx:g} mm, law {name}"
        figure = centre_lines_figure(lines, title=title, columns=len(lines))
        figure.savefig(folder / f"solutions_{name.replace(' ', '_')}.png")
    print(f"pictures                 {folder / 'laws.png'}, force_by_grid.png, cycle.png, solutions_*.png")

    swing = {dx: float(np.ptp(runs["as printed", dx][1][STEPS[dx] // 2 :])) for dx in spacings}
    assert all(fine > coarse for coarse, fine in zip(swing.values(), list(swing.values())[1:], strict=False))
    with_memory = [runs["normalised, memory 3 um", dx][1] for dx in spacings]
    assert all(np.ptp(force[-20:]) < 1e-6 * abs(force[-1]) for force in with_memory), "the force is not constant"
    assert abs(with_memory[0][-1] / -16581.0 - 1.0) < 1e-3, "differs from the published code"
    assert all(set(found) == {"low-slip", "middle", "high-slip"} for found in forces.values())


if __name__ == "__main__":
    main()
