"""From Cattaneo to Carter: a wheel is shifted sideways on the rail, and then rolls with a lateral creepage.

The shift leaves an annulus of slip around a core that sticks (Cattaneo 1938, Mindlin 1949). Rolling carries the
tractions through the contact, until those of steady rolling are left: stick from the leading edge on, slip behind it,
as in Carter's (1926) line contact. Wheel and rail as in Pieringer (2011), section 4.3.
"""

import argparse
from pathlib import Path

import numpy as np

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift, roll, steady_rolling
from wheelrail.plotting.animation import animate_contact, instants_figure
from wheelrail.plotting.contact import contact_figure
from wheelrail.plotting.contact_map import ContactMap
from wheelrail.progress import progress_bar

WHEEL_RADIUS, RAIL_RADIUS, LOAD, FRICTION = 0.39, 0.30, 65e3, 0.3  # m, m, N, -
YOUNGS_MODULUS, POISSON_RATIO = 207e9, 0.3  # Pa, -
ELEMENTS, DX, STEPS = 17, 1e-3, 60  # in each direction, m, steps of rolling
SHIFT, CREEPAGE = 12e-6, 1e-3  # m, -
CREEPAGES = {"creepage_x": 0.0, "creepage_y": CREEPAGE, "creepage_spin": 0.0}
INSTANTS = {0: "Shifted", 5: "5 mm rolled", STEPS: f"{STEPS} mm rolled"}


def main():
    """Shift, roll, draw."""
    parser = argparse.ArgumentParser(description="transient from a tangential shift to steady rolling")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the pictures")
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    grid = HalfSpace(ELEMENTS, ELEMENTS, DX, DX, YOUNGS_MODULUS / (2 * (1 + POISSON_RATIO)), POISSON_RATIO)
    distance = grid.x**2 / (2 * WHEEL_RADIUS) + grid.y**2 / (2 * RAIL_RADIUS)
    normal = solve_normal(NormalProblem(grid, distance, weight=0.0, compliance=1.0, rhs=LOAD))
    shape = (ELEMENTS, ELEMENTS)
    pressure = normal.pressure.reshape(shape)

    # A shift is a step from zero traction, with nothing to carry along.
    shift = np.zeros((2, grid.elements))
    shift[1] = SHIFT
    creep = rigid_shift(grid, **CREEPAGES, distance=DX)
    tractions = np.zeros((2, grid.elements))
    states, forces = [], []
    for step in range(STEPS + 1):
        state = roll(grid, normal, friction=FRICTION, shift=creep if step else shift, previous=tractions)
        tractions = state.tractions
        forces.append((state.force_x, state.force_y))
        fields = {"tractions": tractions.reshape(2, *shape), "slipping": state.slipping.reshape(shape)}
        x, y = grid.x[:ELEMENTS], grid.y[::ELEMENTS]
        states.append(ContactMap(x=x, y=y, pressure=pressure, contact=pressure > 0, friction=FRICTION, **fields))
    forces = np.array(forces)

    title = f"From Cattaneo to Carter: {1e6 * SHIFT:g} µm lateral shift, then {1e2 * CREEPAGE:g} % lateral creepage"
    with progress_bar("animation") as reached:
        animate_contact(
            folder / "cattaneo_to_carter.gif",
            states,
            forces,
            distance=DX * np.arange(STEPS + 1),
            title=title,
            force_limit=FRICTION * LOAD,
            progress=reached,
        )
    figure = instants_figure([states[step] for step in INSTANTS], list(INSTANTS.values()), title=title)
    figure.savefig(folder / "cattaneo_to_carter.png", dpi=200)
    figure = contact_figure(states[-1], title="Lateral creepage 0.1 %, 65 kN, friction 0.3", step=STEPS)
    figure.savefig(folder / "steady_contact.png", dpi=200)
    steady = steady_rolling(grid, normal, friction=FRICTION, **CREEPAGES)
    for step, name in INSTANTS.items():
        state = states[step]
        share = state.slips.sum() / state.contact.sum()
        print(f"{name:<16}lateral force {forces[step, 1]:10.2f} N, {1e2 * share:4.1f} % of the contact slips")
    print(f"{'steady rolling':<16}lateral force {steady.force_y:10.2f} N, {1e2 * steady.slip_fraction:4.1f} %")
    print(f"pictures        {folder / 'cattaneo_to_carter.gif'}, .png and {folder / 'steady_contact.png'}")
    deviation = abs(forces[-1, 1] / steady.force_y - 1.0)
    assert deviation < 1e-4, f"after {STEPS} mm the force differs by {deviation:g} from that of steady rolling"


if __name__ == "__main__":
    main()
