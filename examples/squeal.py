"""Curve squeal at constant friction (Pieringer 2011, section 5.3.1): history, stick/slip cycle, spectrum and sound.

The wheel slides over the rail with a lateral creepage of -1 %, the contact 20 mm towards the field side of the tread.
Lateral and vertical motion of the wheel are coupled there, and some of its modes draw energy from the sliding: which
ones says the stability check, without any run. In the run they grow out of a corrugation of 0.1 um until the contact
sticks and slips. Positive creepage, the second run, gives nothing.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from wheelrail.analysis.sliding_case import case_stability
from wheelrail.analysis.squeal import nearest_mode, squeal_measures
from wheelrail.case import load_case
from wheelrail.interaction.build import build_model, wheel_of
from wheelrail.interaction.simulate import Simulation, stand_alone_inputs
from wheelrail.plotting.squeal import squeal_figure, squeal_spectrum_figure
from wheelrail.progress import progress_bar
from wheelrail.results.sound import write_sound
from wheelrail.wheel.modes import FlexibleWheel

CASE = Path(__file__).parent / "cases" / "squeal.toml"
RECORD = ("force_y", "force_z", "slip_fraction", "wheel_disp_y")


def run(model, creepage, duration):
    """Roll on with a lateral creepage; return the recorded outputs."""
    inputs = replace(stand_alone_inputs(model), creepage_y=creepage)
    blocks = []
    with progress_bar(f"lateral creepage {100.0 * creepage:+g} %", total=duration) as reached:
        for block in Simulation(model, duration=duration, record=RECORD, inputs=inputs, block=500):
            blocks.append(block)
            reached(block["time"][-1])
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def main():
    """Judge stability, run, draw, listen, check."""
    parser = argparse.ArgumentParser(description="curve squeal at constant friction")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for pictures and sound")
    parser.add_argument("--duration", type=float, default=0.8, help="s of rolling, 0.8 or more")
    options = parser.parse_args()
    folder = options.output / "squeal"
    folder.mkdir(parents=True, exist_ok=True)
    case = load_case(CASE)
    for mode in case_stability(case).unstable:
        print(f"grows      ({mode.name})  {mode.coupled_frequency:7.1f} Hz  {mode.growth_rate:6.1f} 1/s")
    model, wheel = build_model(case), wheel_of(case)
    assert isinstance(wheel, FlexibleWheel)
    creepage = model.start_inputs.creepage_y
    friction, dt = model.parameters.friction_coefficient, model.dt
    squeal = run(model, creepage, options.duration)
    quiet = run(model, -creepage, options.duration)

    late = slice(int(0.75 * len(squeal["time"])), None)
    modes = [mode for mode in wheel.modes if mode.shape[1]]
    for name, result in (("squeal", squeal), ("quiet", quiet)):
        measures = squeal_measures(force_y=result["force_y"][late], slip_fraction=result["slip_fraction"][late], dt=dt)
        mode = nearest_mode(modes, measures.main_frequency)
        line = f"{name:10s} sticks in {100.0 * measures.stick_share:4.1f} % of the steps"
        line += f", lateral force {measures.force_rms:7.2f} N rms"
        print(line + f", {measures.main_frequency:.0f} Hz, mode ({mode.name})" * (measures.stick_share > 0.0))
        if name == "squeal":
            share, frequency, squealing = measures.stick_share, measures.main_frequency, mode
        else:
            assert measures.stick_share == 0.0, "stick/slip at a positive creepage"
    squeal_figure(
        time=squeal["time"],
        force=squeal["force_y"],
        bound=friction * squeal["force_z"],
        slip_fraction=squeal["slip_fraction"],
        frequency=frequency,
        title="Squeal at constant friction: lateral contact force",
    ).savefig(folder / "squeal_history.png", dpi=150)
    squeal_spectrum_figure(
        force=squeal["force_y"][late],
        dt=dt,
        modes={mode.name: mode.frequency for mode in modes if mode.name.endswith(",0,a")},
        title="Squeal: spectrum of the lateral force with the wheel's axial modes",
    ).savefig(folder / "squeal_spectrum.png", dpi=150)
    velocity = np.gradient(squeal["wheel_disp_y"], dt)
    full_scale = write_sound(folder / "squeal.wav", velocity, dt=dt)
    print(f"sound      {folder / 'squeal.wav'} (lateral velocity of the wheel, full scale {full_scale:.3f} m/s)")
    print(f"pictures   {folder / 'squeal_history.png'}, {folder / 'squeal_spectrum.png'}")
    assert share > 0.1, f"only {share:.1%} of the steps stick"
    assert abs(frequency / squealing.frequency - 1.0) < 3e-3, f"{frequency:.1f} Hz is not a mode of the wheel"
    assert squealing.name == "5,0,a"


if __name__ == "__main__":
    main()
