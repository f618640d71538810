"""Green's functions against direct time integration, after Pieringer (2011), section 4.1, figures 4.1 to 4.3.

A freight wheel of 488.5 kg rolls at 106 km/h over sleepers 0.6 m apart: smooth, over a sinusoid and over a rough line.
The same track, wheel and Hertz spring are integrated directly in time. The thesis leaves the preload and the track's
data open; here they are those of its other chapters. What the clamped ends send back reaches the wheel as it is in the
direct integration; the moving Green's functions have it as it is in the middle bay. 240 bays instead of 70 weaken it.

Takes about two minutes. Writes output/thesis_4_1_*.png.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from wheelrail.analysis.third_octave import third_octave
from wheelrail.case import parse_case
from wheelrail.contact.spring import HertzSpring
from wheelrail.interaction.build import build_model, track_of, wheel_of
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model import Model
from wheelrail.reference.direct_integration import hertz_law, integrate_interaction
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.rigid import RigidWheel

LOAD, SPEED, DX, SPACING = 65e3, 106 / 3.6, 1e-3, 0.6
CASE = """
[simulation]
speed = 29.444444444444443
dx = 1e-3
duration = {duration}
start_position = 0.0
[wheel]
model = "rigid-1dof"
radius = 0.46
mass = 488.5
suspension_stiffness = 0.0
suspension_damping = 0.0
[track]
preset = "thesis-discrete"
sleeper_spacing = 0.6
bays = {bays}
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
length = 19e-3
prefilter = "average"
[load]
preload = 65e3
coupling = "load"
{excitation}
"""
EXCITATIONS = {
    "smooth": "",
    "sinusoid": '[[excitation]]\ntype = "sinusoid"\namplitude = 10e-6\nwavelength = 0.05',
    "broadband": '[[excitation]]\ntype = "spectrum"\nname = "iso3095-2013-limit"\non = "rail"\nseed = 1',
}


@dataclass(frozen=True)
class Comparison:
    """Contact force in N of both methods at the same places x in m."""

    x: NDArray
    greens: NDArray
    direct: NDArray

    @property
    def difference(self) -> float:
        """Rms difference over the second half of the run, as share of the dynamic force's rms."""
        half = len(self.x) // 2  # the direct integration starts at rest: its transient has to fade
        return float(np.std((self.greens - self.direct)[half:]) / np.std(self.direct[half:]))


def felt_roughness(model: Model, steps: int) -> Callable[[float], float]:
    """Roughness that the Hertz spring feels along the run, as a smooth function of x."""
    contact = model.contact
    assert isinstance(contact, HertzSpring)
    margin, half = 10, contact.nodes // 2
    line = np.zeros(steps + 2 * (margin + half) + 1)
    for source in model.lines:
        source.add_window(-margin - half, line)
    felt = [contact.equivalent_roughness(line[i : i + contact.nodes]) for i in range(steps + 2 * margin + 1)]
    spline = CubicSpline(DX * np.arange(-margin, steps + margin + 1), felt)
    return lambda x: float(spline(x))


def compare(excitation: str, *, bays: int = 240, sleeper_bays: int = 16, refinement: int = 4) -> Comparison:
    """Run both methods; the direct integration in steps of dt / ``refinement``."""
    steps = round(sleeper_bays * SPACING / DX)
    case = parse_case(CASE.format(duration=steps * DX / SPEED, bays=bays, excitation=EXCITATIONS[excitation]))
    model, track, wheel = build_model(case), track_of(case), wheel_of(case)
    assert isinstance(model.contact, HertzSpring)
    assert isinstance(track, DiscreteTrack)
    assert isinstance(wheel, RigidWheel)
    forces: list[float] = []
    run = CoSimulation(model)
    run.recorder = lambda _time, _x, _y, force: forces.append(force)
    run.advance(steps * model.dt)
    direct = integrate_interaction(
        track,
        wheel,
        law=hertz_law(model.contact.constant, felt_roughness(model, steps)),
        preload=LOAD,
        speed=SPEED,
        start=0.0,
        dt=model.dt / refinement,
        steps=refinement * steps,
    )
    return Comparison(DX * np.arange(steps + 1), np.array(forces), direct.force[::refinement])


def plot(name: str, result: Comparison, folder: Path) -> None:
    """Force over the last two bays, and third-octave levels over the second half of the run."""
    mpl.rcParams.update({"font.size": 8, "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 300})
    figure, (left, right) = plt.subplots(1, 2, figsize=(6.7, 2.5), layout="constrained")
    shown = result.x >= result.x[-1] - 2 * SPACING
    bays = (result.x[shown] - result.x[shown][0]) / SPACING
    styles = (("direct integration", result.direct, "C0-", 2.0), ("Green's functions", result.greens, "k--", 0.9))
    for label, force, style, width in styles:
        left.plot(bays, 1e-3 * force[shown], style, linewidth=width, label=label)
        spectrum = third_octave(force[len(force) // 2 :], spacing=DX / SPEED, highest=5e3)
        right.semilogx(spectrum.centres, spectrum.level(reference=1.0), style, linewidth=width, marker=".")
    left.set(xlabel="position / sleeper spacing", ylabel="contact force / kN", xlim=(0, 2))
    right.set(xlabel="third-octave band / Hz", ylabel="force level / dB re 1 N")
    right.set_xticks([31.5, 63, 125, 250, 500, 1000, 2000, 4000], ["31.5", "63", "125", "250", "500", "1k", "2k", "4k"])
    right.minorticks_off()
    figure.legend(*left.get_legend_handles_labels(), loc="outside upper center", ncols=2, frameon=False)
    folder.mkdir(exist_ok=True)
    figure.savefig(folder / f"thesis_4_1_{name}.png")
    plt.close(figure)


def main() -> None:
    differences = []
    for name in EXCITATIONS:
        result = compare(name)
        plot(name, result, Path("output"))
        differences.append(result.difference)
        print(f"{name:10s} rms difference {100 * result.difference:.2f} % of the dynamic force")
    assert max(differences) < 0.02


if __name__ == "__main__":
    mpl.use("Agg")
    main()
