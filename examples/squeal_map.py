"""Where a wheel squeals: friction, lateral creepage and position of the contact (Pieringer 2011, Paper V, figure 5.5).

Cases of constant friction: 6 coefficients by 9 creepages at 2 lateral positions with --full, 108 as in the thesis; a
quarter of them by default. A point contact with a constant coefficient stands for the transient rolling contact: it is
ten times faster, and the stability of sliding is the same; with --transient the thesis' contact runs (hours).

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
    "friction.coefficient": [0.1, 0.2, 0.3, 0.4, 0.6],
    "creepage.y": [-1e-2, -0.6e-2, -0.4e-2, -0.2e-2, 1e-2],
}
POINT_CONTACT = {"contact.normal": "hertz", "contact.tangential": "friction-curve"}
DURATION, JUDGED = 1.2, 1.0  # s


def cycles(run):
    """Frequency of the stick/slip cycles, Hz; 0 where they don't come regularly."""
    part = {name: run.outputs[name][run.settled] for name in ("slip_fraction", "force_y", "force_z")}
    found = stick_slip(
        slip_fraction=part["slip_fraction"], in_contact=part["force_z"], force=part["force_y"], dt=run.dt
    )
    return {"cycle_frequency": found.frequency if found.regular() else 0.0}


def squeal_study(vary, *, transient):
    data = {
        "title": "Squeal at constant friction",
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


def figure(data, names, folder):
    positions = data["wheel_contact_position"].values
    picture, axes = new_figure(
        "Stick/slip at constant friction", rows=len(positions), height=1.2 + 2.6 * len(positions)
    )
    for axis, position in zip(axes, positions, strict=True):
        part = data.sel(wheel_contact_position=position)
        squeals = part["cycle_frequency"].values > 0.0
        axis.pcolormesh(squeals, cmap=ListedColormap(["#FFFFFF", "#F2B28C"]), edgecolors=GREY, linewidth=0.5)
        for row, column in np.argwhere(squeals):
            text = names(float(part["cycle_frequency"][row, column]))
            axis.text(column + 0.5, row + 0.5, text, ha="center", va="center", fontsize=7, color=INK)
        axis.set_xticks(np.arange(squeals.shape[1]) + 0.5, [f"{100 * eta:g}" for eta in part["creepage_y"].values])
        axis.set_yticks(np.arange(squeals.shape[0]) + 0.5, [f"{mu:g}" for mu in part["friction_coefficient"].values])
        axis.grid(visible=False)
        axis.set_ylabel("Friction coefficient")
        axis.set_title(f"contact {1e3 * position:+g} mm from the tread's centre, + field side", fontsize=9)
    axes[-1].set_xlabel("Lateral creepage / %  (coloured: stick/slip, with its mode)")
    picture.savefig(folder / "squeal_map.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the picture and the data")
    parser.add_argument("--full", action="store_true", help="108 cases; some minutes")
    parser.add_argument("--transient", action="store_true", help="with transient rolling contact; hours")
    parser.add_argument("--workers", type=int, help="worker processes; left out: one for each core")
    options = parser.parse_args()
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    study = squeal_study(ALL if options.full else SOME, transient=options.transient)
    path = folder / "squeal_map.nc"
    with progress_bar("squeal map", total=len(study.points)) as reached:
        summary = run_study(
            study, path, workers=options.workers, measure=cycles, progress=lambda _, done: reached(done)
        )
    wheel = wheel_of(load_case(HERE / CASE))
    assert isinstance(wheel, FlexibleWheel)

    def mode(frequency):
        return nearest_mode(wheel.modes, frequency).name

    with xr.open_dataset(path) as opened:
        data = opened.load()
    figure(data, mode, folder)
    field = data.sel(wheel_contact_position=20e-3)
    squeals = field["cycle_frequency"] > 0.0
    print(
        f"{len(study.points)} cases, {len(summary.failures)} failed, {summary.models} models, {summary.wall_time:.0f} s"
    )
    for mu in field["friction_coefficient"].values:
        row = field["cycle_frequency"].sel(friction_coefficient=mu)
        found = [
            f"{100 * eta:+g} %: ({mode(f)}) {f:.0f} Hz"
            for eta, f in zip(row["creepage_y"].values, row.values, strict=True)
            if f
        ]
        print(f"friction {mu:g}, contact at +20 mm: {', '.join(found) or 'no stick/slip'}")
    assert not summary.failures
    assert bool(squeals.sel(friction_coefficient=0.3, creepage_y=-1e-2))
    assert not squeals.sel(creepage_y=1e-2).any()
    assert not squeals.sel(friction_coefficient=0.1).any()


if __name__ == "__main__":
    main()
