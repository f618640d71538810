"""Where a wheel squeals: friction, lateral creepage and position of the contact (Pieringer 2011, Paper V, figure 5.5).

Cases of constant friction: 6 coefficients by 9 creepages at 2 lateral positions with --full, 108 as in the thesis; 16
of them by default. Then lateral positions of the contact with both signs of the creepage. A point contact with
a constant coefficient stands for the transient rolling contact: it is ten times faster, and the stability of sliding is
the same; with --transient the thesis' contact runs (hours).

The thesis: stick/slip only for negative creepage of 0.6 % or more and a friction of 0.3 or more, with the contact
towards the field side of the tread; its main frequency is that of an axial mode without nodal circles. Here too, with
another wheel; it begins at a friction of 0.2, and it needs a creepage that saturates the contact.
"""

import argparse
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap

from wheelrail.analysis.squeal import nearest_mode
from wheelrail.analysis.stick_slip import stick_slip
from wheelrail.case import load_case
from wheelrail.interaction.build import wheel_of
from wheelrail.plotting.style import GREY, INK, new_figure
from wheelrail.progress import progress_bar
from wheelrail.study import run_study, study_from_dict
from wheelrail.wheel.modes import FlexibleWheel

HERE = Path(__file__).parent
CASE = "cases/squeal.toml"
ALL = {
    "wheel.contact_position": [20e-3, 0.0],
    "friction.coefficient": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
    "creepage.y": [-1e-2, -0.8e-2, -0.6e-2, -0.4e-2, -0.2e-2, 0.2e-2, 0.4e-2, 0.6e-2, 1e-2],
}
SOME = {
    "wheel.contact_position": [20e-3],
    "friction.coefficient": [0.1, 0.2, 0.3, 0.6],
    "creepage.y": [-1e-2, -0.6e-2, -0.2e-2, 1e-2],
}
ALL_POSITIONS = {"wheel.contact_position": [-20e-3, -10e-3, 0.0, 10e-3, 20e-3], "creepage.y": [-1e-2, 1e-2]}
SOME_POSITIONS = {**ALL_POSITIONS, "wheel.contact_position": [-20e-3, 0.0, 20e-3]}
POINT_CONTACT = {"contact.normal": "hertz", "contact.tangential": "friction-curve"}
DURATION, JUDGED = 1.2, 1.0  # s


def cycles(run):
    """Frequency of the stick/slip cycles, Hz; 0 where they don't come regularly."""
    part = {name: run.outputs[name][run.settled] for name in ("slip_fraction", "force_y", "force_z")}
    found = stick_slip(
        slip_fraction=part["slip_fraction"], in_contact=part["force_z"], force=part["force_y"], dt=run.dt
    )
    return {"cycle_frequency": found.frequency if found.regular() else 0.0}


def squeal_study(title, vary, *, transient):
    data = {
        "title": title,
        "case": CASE,
        # A stronger start than 0.1 um, so that what grows is there within a second.
        "set": {
            "simulation.duration": DURATION,
            "excitation.1.amplitude": 1e-6,
            **({} if transient else POINT_CONTACT),
        },
        "vary": vary,
        "results": {"from": JUDGED, "outputs": ["force_y", "force_z", "slip_fraction"], "statistics": ["std"]},
    }
    return study_from_dict(data, folder=HERE)


def table(axis, cells, across, down, labels):
    """Colour the cells with stick/slip and write their modes into them."""
    axis.pcolormesh(
        cells > 0.0, cmap=ListedColormap(["#FFFFFF", "#F2B28C"]), vmin=0, vmax=1, edgecolors=GREY, linewidth=0.5
    )
    for row, column in np.argwhere(cells > 0.0):
        text = labels(cells[row, column])
        axis.text(column + 0.5, row + 0.5, text, ha="center", va="center", fontsize=7, color=INK)
    axis.set_xticks(np.arange(cells.shape[1]) + 0.5, across)
    axis.set_yticks(np.arange(cells.shape[0]) + 0.5, down)
    axis.grid(visible=False)


def figure(friction, place, mode, folder):
    positions = friction["wheel_contact_position"].values
    picture, axes = new_figure(
        "Stick/slip at constant friction", rows=len(positions) + 1, height=2.8 * len(positions) + 2.6
    )
    percent = [f"{100 * eta:g}" for eta in friction["creepage_y"].values]
    for axis, position in zip(axes, positions, strict=False):
        cells = friction["cycle_frequency"].sel(wheel_contact_position=position).values
        table(axis, cells, percent, [f"{mu:g}" for mu in friction["friction_coefficient"].values], mode)
        axis.set_ylabel("Friction coefficient")
        axis.set_xlabel("Lateral creepage / %")
        axis.set_title(f"contact {1e3 * position:+g} mm from the tread's centre, + field side", fontsize=9)
    cells = place["cycle_frequency"].transpose("creepage_y", "wheel_contact_position").values
    places = [f"{1e3 * y:+g}" for y in place["wheel_contact_position"].values]
    table(axes[-1], cells, places, [f"{100 * eta:g}" for eta in place["creepage_y"].values], mode)
    axes[-1].set_ylabel("Lateral creepage / %")
    axes[-1].set_xlabel("Contact from the tread's centre / mm, + field side (coloured: stick/slip, with its mode)")
    axes[-1].set_title("friction 0.3", fontsize=9)
    picture.savefig(folder / "squeal_map.png")


def sentence(row, name, mode):
    found = zip(row[name].values, row.values, strict=True)
    cells = [f"{100 * value:+g} %: ({mode(frequency)}) {frequency:.0f} Hz" for value, frequency in found if frequency]
    return ", ".join(cells) or "no stick/slip"


def computed(name, study, path, workers):
    """Run a study and return its data set."""
    with progress_bar(name, total=len(study.points)) as reached:
        summary = run_study(study, path, workers=workers, measure=cycles, progress=lambda _, done: reached(done))
    print(
        f"{name}: {len(study.points)} cases, {len(summary.failures)} failed, {summary.models} models, "
        f"{summary.wall_time:.0f} s"
    )
    assert not summary.failures
    with xr.open_dataset(path) as opened:
        return opened.load()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the picture and the data")
    parser.add_argument("--full", action="store_true", help="108 cases; some minutes")
    parser.add_argument("--transient", action="store_true", help="with transient rolling contact; hours")
    parser.add_argument("--workers", type=int, help="worker processes; left out: one for each core")
    options = parser.parse_args()
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    positions = ALL_POSITIONS if options.full else SOME_POSITIONS
    map_study = squeal_study("Squeal map", ALL if options.full else SOME, transient=options.transient)
    place_study = squeal_study("Squeal and lateral position", positions, transient=options.transient)
    friction = computed("friction and creepage", map_study, folder / "squeal_map.nc", options.workers)
    place = computed("lateral position", place_study, folder / "squeal_position.nc", options.workers)
    wheel = wheel_of(load_case(HERE / CASE))
    assert isinstance(wheel, FlexibleWheel)

    def mode(frequency):
        return nearest_mode(wheel.modes, frequency).name

    figure(friction, place, mode, folder)
    field = friction["cycle_frequency"].sel(wheel_contact_position=20e-3)
    for mu in field["friction_coefficient"].values:
        print(f"friction {mu:g}, contact at +20 mm: {sentence(field.sel(friction_coefficient=mu), 'creepage_y', mode)}")
    for y in place["wheel_contact_position"].values:
        row = place["cycle_frequency"].sel(wheel_contact_position=y)
        print(f"friction 0.3, contact at {1e3 * y:+g} mm: {sentence(row, 'creepage_y', mode)}")
    assert field.sel(friction_coefficient=0.3, creepage_y=-1e-2) > 0.0
    assert not (field.sel(creepage_y=1e-2) > 0.0).any()
    assert not (field.sel(friction_coefficient=0.1) > 0.0).any()


if __name__ == "__main__":
    main()
