"""A quarter vehicle as co-simulation master of the default FMU, through FMPy.

Car body, bogie and wheel on their suspensions are stepped every millisecond. The vehicle gives the FMU the load that it
puts on the wheel (``wheel_force_z``) and takes the mean contact force (``force_z_mean``); the FMU does 22 steps of
wheel, contact and track dynamics in between. A gust takes load off the wheel and gives it back.

The FMU's wheel hangs on the primary suspension, whose upper end it takes as fixed. So the load is the static one plus
what the bogie's motion puts through the suspension, k_S z_bogie + c_S z'_bogie; the wheel's own share is the FMU's.
The vehicle model's wheel, which sees nothing but mean forces, must therefore move as the FMU's does.
"""

import argparse
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from matplotlib.figure import Figure
from scipy.linalg import expm

from fmu_src.build import build_fmu
from wheelrail.case import default_case_text, parse_case
from wheelrail.progress import progress_bar

CAR_BODY, BOGIE = 5600.0, 650.0  # kg, shares of one wheel
SECONDARY_STIFFNESS, SECONDARY_DAMPING = 600e3, 25e3  # N/m, N s/m
GUST, GUST_START, GUST_END = -12e3, 0.3, 1.1  # N, s, s
STEP, DURATION = 1e-3, 2.0  # s
LINEAR = 2  # input_extrapolation: the load goes on changing between two communication points as it did before


def vehicle(wheel_mass, k1, c1, step):
    """Exact transition of (z_car, z_bogie, z_wheel and their velocities) over a step under (gust, -force)."""
    k2, c2 = SECONDARY_STIFFNESS, SECONDARY_DAMPING
    couple = lambda a, b: np.array([[a, -a, 0.0], [-a, a + b, -b], [0.0, -b, b]])  # noqa: E731
    mass = np.diag([CAR_BODY, BOGIE, wheel_mass])
    system = np.zeros((8, 8))
    system[:3, 3:6] = np.eye(3)
    system[3:6, :6] = -np.linalg.solve(mass, np.hstack([couple(k2, k1), couple(c2, c1)]))
    system[3, 6], system[5, 7] = 1.0 / CAR_BODY, 1.0 / wheel_mass
    transition = expm(system * step)
    return transition[:6, :6], transition[:6, 6:]


def run(fmu_path, case, reached):
    """Drive the FMU; return the columns of what happened at the communication points."""
    wheel, preload = case.wheel, case.load.preload
    k1, c1 = wheel.suspension_stiffness, wheel.suspension_damping
    transition, influence = vehicle(wheel.mass, k1, c1, STEP)
    description = read_model_description(fmu_path)
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    outputs = ["force_z_mean", "force_z_min", "force_z_max", "wheel_disp_z"]
    fmu = FMU2Slave(
        guid=description.guid,
        unzipDirectory=extract(fmu_path),
        modelIdentifier=description.modelName,
        instanceName="wheel",
    )
    fmu.instantiate()
    fmu.setInteger([reference["input_extrapolation"]], [LINEAR])
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    state, rows = np.zeros(6), []
    for n in range(round(DURATION / STEP)):
        time = n * STEP
        load = preload + k1 * state[1] + c1 * state[4]
        fmu.setReal([reference["wheel_force_z"]], [load])
        fmu.doStep(time, STEP)
        mean, low, high, wheel_displacement = fmu.getReal([reference[name] for name in outputs])
        phase = (time - GUST_START) / (GUST_END - GUST_START)
        gust = 0.5 * GUST * (1.0 - np.cos(2.0 * np.pi * phase)) if 0.0 < phase < 1.0 else 0.0
        state = transition @ state + influence @ [gust, preload - mean]
        reached(time)
        rows.append((time + STEP, load, mean, low, high, wheel_displacement, *state[:3]))
    fmu.terminate()
    fmu.freeInstance()
    return np.array(rows).T


def draw(columns, path):
    """Picture of loads and displacements."""
    time, load, mean, low, high, fmu_wheel, car, bogie, wheel = columns
    figure = Figure(figsize=(8.0, 8.0), layout="constrained")
    top, middle, bottom = figure.subplots(3, sharex=True, height_ratios=[2, 1, 1])
    top.fill_between(time, low / 1e3, high / 1e3, color="#9ecae1", label="contact force, extremes within 1 ms")
    top.plot(time, mean / 1e3, color="#08519c", lw=0.7, label="contact force, mean over 1 ms")
    top.plot(time, load / 1e3, color="#d95f02", lw=1.8, label="load on the wheel")
    top.set(ylabel="force in kN", title="Default FMU under a quarter vehicle: a gust takes load off the wheel")
    top.margins(y=0.2)
    top.legend(loc="lower right", ncols=3, fontsize=8)
    middle.plot(time, 1e3 * car, color="#1b9e77", label="car body")
    middle.plot(time, 1e3 * bogie, color="#7570b3", label="bogie")
    middle.set(ylabel="displacement\nin mm, down")
    middle.legend(loc="lower right", fontsize=8)
    bottom.plot(time, 1e3 * fmu_wheel, color="#9ecae1", label="wheel, in the FMU")
    bottom.plot(time, 1e3 * wheel, color="#d95f02", ls="--", lw=1.0, label="wheel, in the vehicle model")
    bottom.set(xlabel="time in s", ylabel="displacement\nin mm, down", xlim=(0.0, time[-1]))
    bottom.legend(loc="lower right", fontsize=8)
    for axes in (top, middle, bottom):
        axes.grid(alpha=0.3)
    figure.savefig(path, dpi=150)


def main():
    """Build, run, summarise, draw."""
    parser = argparse.ArgumentParser(description="quarter vehicle on the default FMU")
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the FMU and the picture")
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    case = parse_case(default_case_text())
    with progress_bar("moving Green's functions") as reached:
        fmu = build_fmu(case, folder, reached)
    with progress_bar("co-simulation", total=DURATION) as reached:
        columns = run(fmu, case, reached)
    time, load, mean, low, high, fmu_wheel, _, bogie, wheel = columns
    draw(columns, folder / "quarter_vehicle.png")
    np.savetxt(
        folder / "quarter_vehicle.csv",
        columns.T,
        delimiter=",",
        comments="",
        header="time_s,load_N,force_mean_N,force_min_N,force_max_N,fmu_wheel_m,car_body_m,bogie_m,wheel_m",
    )
    deviation = np.abs(wheel - fmu_wheel).max()
    print(f"FMU                    {fmu}")
    print(f"simulated              {time[-1]:g} s at {3.6 * case.simulation.speed:.0f} km/h, {len(time)} steps of 1 ms")
    print(f"load on the wheel      {load.min() / 1e3:.1f} ... {load.max() / 1e3:.1f} kN")
    print(
        f"contact force          {low.min() / 1e3:.1f} ... {high.max() / 1e3:.1f} kN, mean {mean.mean() / 1e3:.2f} kN"
    )
    print(f"bogie                  {1e3 * bogie.min():.2f} ... {1e3 * bogie.max():.2f} mm")
    print(f"wheel, FMU - vehicle   {1e6 * deviation:.1f} um at most, of {1e3 * np.ptp(fmu_wheel):.2f} mm")
    print(f"picture                {folder / 'quarter_vehicle.png'}")
    # The vehicle knows the mean force only and holds the load for 1 ms: the two wheels may not drift apart.
    assert deviation < 20e-6, f"the wheel of the FMU and that of the vehicle differ by {deviation:g} m"


if __name__ == "__main__":
    main()
