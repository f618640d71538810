"""The flexible wheel and the waveguide rail: modes, waves, receptances and Green's functions in three directions.

The wheel is the synthetic section of 780 mm with its contact 20 mm towards the field side, the rail 60E1 on a
continuous pad and on sleepers, its contact 10 mm beside the centre. On sleepers the rail has its pinned-pinned
resonances, vertical and lateral.
"""

import argparse
from pathlib import Path

import numpy as np

from wheelrail.case import case_from_dict, load_case
from wheelrail.greens.modal_discretisation import discretise_modes
from wheelrail.interaction.build import track_of, wheel_of
from wheelrail.interaction.tracks import greens_of
from wheelrail.plotting.greens_functions import greens_components_figure
from wheelrail.plotting.rail_waves import dispersion_figure, wave_shapes_figure
from wheelrail.plotting.receptances import receptance_components_figure
from wheelrail.plotting.wheel_modes import wheel_modes_figure
from wheelrail.track.dispersion import cut_on_frequencies, disperse
from wheelrail.track.safe_matrices import Material, section_matrices
from wheelrail.track.section_sources import load_section as load_rail
from wheelrail.track.waveguide import WaveguideTrack
from wheelrail.wheel.flexible import wheel_shapes
from wheelrail.wheel.modes import FlexibleWheel
from wheelrail.wheel.section import load_section as load_wheel

CASE = Path(__file__).parent / "cases" / "squeal.toml"
STEEL = {"youngs_modulus": 207e9, "poisson_ratio": 0.3, "density": 7860.0}
RAIL_STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0, loss_factor=0.01)
CUT_ONS = np.array([1302.0, 3882.0, 5046.0, 5145.0])  # Hz, by an independent code for this steel
DRAWN = ("0,0,a", "2,0,a", "3,0,a", "5,0,a", "7,0,a", "0,1,a", "2,1,a", "0,r", "1,r", "2,r", "3,r", "2,c")


def main():
    """Compute, draw, check."""
    parser = argparse.ArgumentParser(description="flexible wheel and waveguide rail")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the pictures")
    folder = parser.parse_args().output / "flexible"
    folder.mkdir(parents=True, exist_ok=True)

    def save(figure, name):
        figure.savefig(folder / f"{name}.png", dpi=150)
        print(f"picture    {folder / name}.png")

    shapes = wheel_shapes(load_wheel("synthetic-c20"), **STEEL, max_frequency=7e3)
    save(wheel_modes_figure(shapes, names=DRAWN), "wheel_modes")

    free = section_matrices(load_rail("60e1"), material=RAIL_STEEL, pad=None, contact_position=0.0)
    waves = disperse(free, np.linspace(0.0, 45.0, 46), number=8)
    cut_ons = cut_on_frequencies(free)
    cut_ons = cut_ons[cut_ons > 10.0]
    print("cut-ons    " + ", ".join(f"{f:.0f}" for f in cut_ons[:4]) + " Hz of the free 60E1 rail")
    save(dispersion_figure(waves, cut_ons=cut_ons, highest=7e3, title="Waves in a free 60E1 rail"), "rail_dispersion")
    save(wave_shapes_figure(free, waves, wavenumber=10.0, title="Free 60E1 rail: waves of 0.63 m"), "rail_waves")

    case = load_case(CASE)
    # Off the rail's centre as well, where vertical forces turn the rail.
    case, sleepers = (
        case_from_dict(case.to_dict() | {"track": {"preset": name, "contact_position": 10e-3}}, folder=case.folder)
        for name in ("thesis-waveguide-60e1", "waveguide-60e1-sleepers")
    )
    wheel, pad, discrete = wheel_of(case), track_of(case), track_of(sleepers)
    assert isinstance(wheel, FlexibleWheel)
    assert isinstance(pad, WaveguideTrack)
    assert isinstance(discrete, WaveguideTrack)
    frequency = np.geomspace(50.0, 7e3, 1200)
    save(
        receptance_components_figure(
            frequency=frequency,
            receptances={
                "wheel": wheel.receptance(frequency),
                "rail on pad": pad.receptance(frequency),
                "rail at midspan": discrete.receptance(frequency, 0.3),
                "rail over a sleeper": discrete.receptance(frequency, 0.0),
            },
            title="Point receptances at the contact",
        ),
        "receptances",
    )
    dt = case.simulation.dx / case.simulation.speed
    greens = greens_of(case)
    assert greens is not None
    modes = wheel.all_modes
    response = discretise_modes(
        mass=[mode.mass for mode in modes],
        stiffness=[mode.stiffness for mode in modes],
        damping=[mode.damping for mode in modes],
        shapes=wheel.shapes,
        dt=dt,
    )
    save(
        greens_components_figure(
            functions={
                "wheel": response.values(600),
                "rail, moving with the contact": greens.values[0].transpose(2, 1, 0)[:600],
            },
            dt=dt,
            shown=5e-3,
            title="Green's functions at the contact",
        ),
        "greens_functions",
    )
    error = np.abs(cut_ons[:4] / CUT_ONS - 1.0).max()
    assert error < 5e-3, f"cut-on frequencies are off by {error:.2%}"


if __name__ == "__main__":
    main()
