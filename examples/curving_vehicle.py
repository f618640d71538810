"""A vehicle in a transition curve as co-simulation master of a rolling contact FMU, through FMPy.

The vehicle gives creepages, load and lateral shift at every communication step, as a vehicle dynamics program would,
and receives the contact forces; inside, Kalker's transient rolling contact is solved at every millimetre. Entering the
curve the wheelset gets an angle of attack (lateral creepage, some spin), the load moves to the outer wheel, and a short
braking pulse adds longitudinal creepage.
"""

import argparse
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from matplotlib.figure import Figure

from fmu_src.build import build_fmu
from wheelrail.case import load_case
from wheelrail.progress import progress_bar

CASE = Path(__file__).parent / "cases" / "rolling_contact.toml"
STEP, DURATION = 1e-3, 0.4  # s; 13.9 internal steps each
INPUTS = ["creepage_x", "creepage_y", "creepage_spin", "wheel_force_z", "lateral_shift"]
OUTPUTS = ["force_x", "force_y", "force_z", "moment_spin", "slip_fraction", "friction_power", "solver_residual"]


def ramp(time, begin, end):
    """Smooth transition from 0 to 1."""
    s = np.clip((time - begin) / (end - begin), 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


def vehicle(time):
    """Return what the vehicle gives at a time: creepages (rail relative to wheel over v), load in N, shift in m."""
    curve = ramp(time, 0.05, 0.25)
    braking = ramp(time, 0.28, 0.29) - ramp(time, 0.33, 0.34)
    return [2e-3 * braking, 4e-3 * curve, 0.3 * curve, 65e3 + 20e3 * curve, 6e-3 * curve]


def run(path, reached):
    """Drive the FMU; return time, inputs and outputs at the communication points, one row each."""
    description = read_model_description(path)
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    fmu = FMU2Slave(
        guid=description.guid,
        unzipDirectory=extract(path),
        modelIdentifier=description.modelName,
        instanceName="outer wheel",
    )
    fmu.instantiate()
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.setReal([reference[name] for name in INPUTS], vehicle(0.0))
    fmu.exitInitializationMode()
    rows = []
    for n in range(round(DURATION / STEP)):
        given = vehicle((n + 1) * STEP)
        fmu.setReal([reference[name] for name in INPUTS], given)
        fmu.doStep(n * STEP, STEP)
        rows.append([(n + 1) * STEP, *given, *fmu.getReal([reference[name] for name in OUTPUTS])])
        reached((n + 1) * STEP)
    fmu.terminate()
    fmu.freeInstance()
    return np.array(rows)


def draw(rows, path):
    """Picture of what was given and what came back."""
    time, xi, eta, spin, load, _, fx, fy, fz, moment, slip, power, _ = rows.T
    figure = Figure(figsize=(8.0, 8.0), layout="constrained")
    axes = figure.subplots(4, sharex=True)
    axes[0].plot(time, 100.0 * xi, label="longitudinal, %", color="#0072b2")
    axes[0].plot(time, 100.0 * eta, label="lateral, %", color="#d55e00")
    axes[0].plot(time, spin, label="spin, 1/m", color="#009e73")
    axes[0].set(ylabel="creepage", title="Rolling contact FMU under a vehicle that enters a curve and brakes")
    axes[1].plot(time, 1e-3 * load, color="black", ls="--", label="load")
    axes[1].plot(time, 1e-3 * fz, color="#56b4e9", lw=3, alpha=0.6, label="normal force")
    axes[1].set(ylabel="kN")
    axes[2].plot(time, 1e-3 * fx, label="longitudinal", color="#0072b2")
    axes[2].plot(time, 1e-3 * fy, label="lateral", color="#d55e00")
    axes[2].plot(time, -0.3e-3 * fz, color="black", ls=":", label="friction limit")
    axes[2].set(ylabel="force on the rail, kN")
    axes[3].plot(time, 1e-3 * power, label="friction power, kW", color="#cc79a7")
    axes[3].plot(time, slip, label="slipping share", color="#009e73")
    axes[3].plot(time, 0.01 * moment, label="spin moment, 100 N m", color="#e69f00")
    axes[3].set(xlabel="time in s", xlim=(0.0, time[-1]))
    for panel in axes:
        panel.legend(fontsize=8, loc="best")
        panel.grid(alpha=0.3)
    figure.savefig(path, dpi=150)


def main():
    """Build, run, draw, check."""
    parser = argparse.ArgumentParser(description="vehicle in a transition curve on a rolling contact FMU")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the FMU and the picture")
    folder = parser.parse_args().output / "curving"
    folder.mkdir(parents=True, exist_ok=True)
    fmu = build_fmu(load_case(CASE), folder)
    with progress_bar("co-simulation", total=DURATION) as reached:
        rows = run(fmu, reached)
    draw(rows, folder / "curving_vehicle.png")
    time, xi, eta, spin, _, _, fx, fy, fz, moment, _, power, residual = rows.T
    steady = (time > 0.265) & (time < 0.28)  # the curve is entered, the brake not yet applied
    speed = 50.0 / 3.6
    # The rigid shift of a step is taken where it ends (Pieringer 2011, eq. 3.49): spin acts dx / 2 off its mean.
    work = -(fx * xi + fy * (eta - 0.5e-3 * spin) + moment * spin)[steady] * speed
    balance = np.abs(work / power[steady] - 1.0).max()
    print(f"lateral force          {1e-3 * fy[steady].mean():.2f} kN in the curve, {fy[-1] / fz[-1]:.3f} of the load")
    print(f"while braking          {1e-3 * fx.min():.2f} kN longitudinally")
    print(f"friction power         {1e-3 * power.max():.2f} kW at most; force times creepage to {balance:.1e}")
    print(f"largest residual       {residual.max():.1e}")
    print(f"picture                {folder / 'curving_vehicle.png'}")
    assert balance < 1e-6, f"friction power misses force times creepage by {balance:g}"


if __name__ == "__main__":
    main()
