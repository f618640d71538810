"""Curve squeal with friction that falls with the slip velocity (Pieringer 2011, section 5.3.2, figures 5.9 and 5.10).

Falling friction damps negatively: every axial mode of the wheel grows in sliding, which the stability check says
without a run. In the run one of them wins, and the contact sticks and slips at its frequency; without that mode another
one takes over; without a circumferential mode nothing changes. Their growth rates are so near each other that what
starts the vibration decides which mode wins: with roughness at the limit of ISO 3095 it is a low one. A point contact
with a friction curve, for comparison, is much faster. With --grids the same on finer grids, with and without memory.
"""

import argparse
from pathlib import Path

import numpy as np

from wheelrail.analysis.sliding_case import case_stability
from wheelrail.analysis.squeal import amplitude_spectrum, nearest_mode
from wheelrail.case import case_from_dict, load_case
from wheelrail.interaction.build import build_model, wheel_of
from wheelrail.interaction.friction import largest_friction_of
from wheelrail.interaction.simulate import Simulation
from wheelrail.plotting.falling_friction import spectra_figure
from wheelrail.plotting.squeal import squeal_figure
from wheelrail.progress import progress_bar
from wheelrail.results.sound import write_sound
from wheelrail.wheel.modes import FlexibleWheel

CASE = Path(__file__).parent / "cases" / "squeal_falling_friction.toml"
MAIN, CIRCUMFERENTIAL = "3,0,a", "1,c"
RECORD = ("force_y", "force_z", "slip_fraction", "wheel_disp_y", "solver_residual")
REFERENCE_VELOCITY = 5e-8  # m/s, ISO 1683
DRAWN = ("all modes", f"without ({MAIN})", "with roughness")
ROUGHNESS = {"type": "spectrum", "name": "iso3095-2013-limit", "on": "rail", "seed": 1}


def changed(case, **tables):
    """Return the case with some keys changed, by table."""
    data = case.to_dict()
    for name, keys in tables.items():
        data[name] = {**data[name], **keys}
    return case_from_dict(data)


def on_grid(case, dx, *, memory):
    """Return the case on another grid, with or without friction memory."""
    count = round(case.contact.length / dx)
    count += 1 - count % 2
    data = changed(case, simulation={"dx": dx}, contact={"dy": dx, "length": count * dx, "width": count * dx}).to_dict()
    if not memory:
        for key in ("memory_distance", "memory_speed"):
            del data["friction"][key]
    return case_from_dict(data)


def run(name, case):
    """Run a case; return its outputs and the time step."""
    model, blocks = build_model(case), []
    with progress_bar(name, total=case.simulation.duration) as reached:
        for block in Simulation(model, duration=case.simulation.duration, record=RECORD, block=200):
            blocks.append(block)
            reached(block["time"][-1])
    return {key: np.concatenate([block[key] for block in blocks]) for key in blocks[0]}, model.dt


def measure(name, result, dt, modes):
    """Print main frequency and level of the wheel's lateral velocity at the contact; return frequency and level."""
    late = slice(len(result["time"]) // 2, None)
    velocity, force = np.gradient(result["wheel_disp_y"], dt)[late], result["force_y"][late]
    frequency, amplitude = amplitude_spectrum(velocity, dt=dt)
    main = float(frequency[np.argmax(amplitude)])
    level = 20.0 * np.log10(velocity.std() / REFERENCE_VELOCITY)
    print(
        f"{name:26s} {main:8.1f} Hz ({nearest_mode(modes, main).name}), {level:6.2f} dB; force {force.mean():8.1f} N, "
        f"{force.std():6.1f} N rms; residual {result['solver_residual'].max():.0e}"
    )
    return main, level


def main():
    """Judge stability, run with and without modes, draw, listen, check."""
    parser = argparse.ArgumentParser(description="curve squeal with falling friction")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for pictures and sound")
    parser.add_argument("--grids", action="store_true", help="also dx 0.75 and 0.5 mm; takes half an hour")
    options = parser.parse_args()
    folder = options.output / "squeal_falling_friction"
    folder.mkdir(parents=True, exist_ok=True)
    case = load_case(CASE)
    stability = case_stability(case)
    for mode in stability.unstable:
        print(f"grows      ({mode.name})  {mode.coupled_frequency:7.1f} Hz  {mode.growth_rate:6.1f} 1/s")
    print(f"slope {stability.loop.friction_slope:.3f} s/m at {stability.loop.sliding_speed:.3f} m/s")
    wheel = wheel_of(case)
    assert isinstance(wheel, FlexibleWheel)
    modes = [mode for mode in wheel.modes if mode.shape[1]]

    cases = {
        "all modes": case,
        f"without ({MAIN})": changed(case, wheel={"remove_modes": [MAIN]}),
        f"without ({CIRCUMFERENTIAL})": changed(case, wheel={"remove_modes": [CIRCUMFERENTIAL]}),
        "with roughness": case_from_dict({**case.to_dict(), "excitation": [ROUGHNESS]}),
        "point contact": changed(case, contact={"tangential": "friction-curve"}),
    }
    results, measured = {}, {}
    for name, each in cases.items():
        results[name], dt = run(name, each)
        measured[name] = measure(name, results[name], dt, modes)
    if options.grids:
        for memory in (True, False):
            for dx in (1e-3, 0.75e-3, 0.5e-3):
                name = f"dx {1e3 * dx:g} mm, {'with' if memory else 'without'} memory"
                measure(name, *run(name, on_grid(case, dx, memory=memory)), modes)

    whole = results["all modes"]
    late = slice(len(whole["time"]) // 2, None)
    dt = case.simulation.dx / case.simulation.speed
    squeal_figure(
        time=whole["time"],
        force=whole["force_y"],
        bound=largest_friction_of(case) * whole["force_z"],
        slip_fraction=whole["slip_fraction"],
        frequency=measured["all modes"][0],
        title="Squeal with falling friction: lateral contact force",
    ).savefig(folder / "history.png", dpi=150)
    spectra_figure(
        {name: amplitude_spectrum(results[name]["force_y"][late], dt=dt) for name in DRAWN},
        modes={mode.name: mode.frequency for mode in modes if mode.name.endswith(",0,a")},
        title="Falling friction: spectrum of the lateral force",
    ).savefig(folder / "spectra.png", dpi=150)
    write_sound(folder / "squeal.wav", np.gradient(whole["wheel_disp_y"], dt), dt=dt)
    print(f"pictures and sound  {folder / 'history.png'}, spectra.png, squeal.wav")

    frequency, level = measured["all modes"]
    assert {mode.name for mode in stability.unstable} >= {MAIN}
    assert nearest_mode(modes, frequency).name == MAIN
    assert abs(frequency / next(mode.frequency for mode in modes if mode.name == MAIN) - 1.0) < 5e-3
    assert nearest_mode(modes, measured[f"without ({MAIN})"][0]).name != MAIN
    same, same_level = measured[f"without ({CIRCUMFERENTIAL})"]
    assert abs(same / frequency - 1.0) < 2e-3
    assert abs(same_level - level) < 0.5


if __name__ == "__main__":
    main()
