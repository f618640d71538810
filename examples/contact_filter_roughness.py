"""Contact filter on roughness that differs across the contact (Pieringer 2011, section 5.1, Paper III).

Seven parallel lines of wheel roughness 2 mm apart, each with the same spectrum, from the same all across to nothing in
common: the half-space looks at all of them, the Winkler bedding and the Hertz spring at one, in turn. The filter is the
level of the contact force over that of the Hertz spring without filter.

The thesis: models on one line agree with each other; the three-dimensional one gives forces several dB lower where the
roughness is not correlated across the contact, and the same where it is.
"""

import argparse
from pathlib import Path

import numpy as np

from wheelrail.analysis.contact_filter import contact_filter_of
from wheelrail.analysis.contact_filter_models import averaging_filter, enclosing_filters
from wheelrail.case import parse_case
from wheelrail.interaction.build import hertz_of
from wheelrail.plotting.style import BLUE, GREEN, GREY, INK, ORANGE, legend, log_axis, new_figure
from wheelrail.progress import progress_bar

LINES = (-6e-3, -4e-3, -2e-3, 0.0, 2e-3, 4e-3, 6e-3)
COHERENCES = {"0": "the same all across", "1": "c = 1", '"none"': "nothing in common"}
TRANSIENT = 0.05  # s

CASE = """
[simulation]
speed = 27.777777777777778  # 100 km/h
dx = 1e-3
duration = 0.35
start_position = 0.0
[wheel]
preset = "thesis-2dof"
[track]
preset = "thesis-discrete"
[contact]
normal = "half-space"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
dy = 1e-3
length = 25e-3
width = 19e-3
[load]
preload = 65e3
coupling = "load"
[[excitation]]
type = "spectrum"
name = "cnossos-wheel-cast-iron-tread"
on = "wheel"
seed = 3
lines = {lines}
coherence = {coherence}
"""


def figure(filters, flat, theory, band, folder):
    picture, (axis,) = new_figure("Contact filter on roughness", rows=1, height=4.2)
    first = next(iter(filters.values()))["half-space"]
    axis.fill_between(first.centres, *band, color="#E4E4E4", label="CNOSSOS, 25 and 100 kN, 920 mm")
    axis.plot(first.centres, theory, color=INK, linewidth=0.8, label="average over the nominal contact")
    axis.plot(first.centres, flat, "--", color=GREY, label="bedding, one line (mean of seven)")
    for (name, found), colour in zip(filters.items(), (BLUE, GREEN, ORANGE), strict=True):
        axis.plot(first.centres, found["half-space"].levels, color=colour, label=f"half-space, {COHERENCES[name]}")
    log_axis(axis, 63.0, 5000.0)
    axis.set_ylabel("force level re Hertz, not filtered / dB")
    axis.set_ylim(-25.0, 2.0)
    legend(axis, loc="lower left")
    folder.mkdir(parents=True, exist_ok=True)
    picture.savefig(folder / "contact_filter_roughness.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("output"), help="folder for the picture")
    folder = parser.parse_args().output
    filters = {}
    with progress_bar("contact filter", total=len(COHERENCES)) as reached:
        for coherence in COHERENCES:
            case = parse_case(CASE.format(lines=list(LINES), coherence=coherence))
            filters[coherence] = contact_filter_of(case, transient=TRANSIENT, lateral=LINES)
            reached(len(filters))
    hertz = hertz_of(case)
    wide = filters["0"]["half-space"]
    flat = np.mean([found["winkler"].levels for found in filters.values()], axis=0)
    theory = averaging_filter(wide.wavelengths, half_length=hertz.semi_axis_x)
    low, high = (table.at(wide.wavelengths) for table in enclosing_filters(load=65e3, wheel_diameter=0.92))
    figure(filters, flat, theory, (low, high), folder)

    audible = (wide.centres > 90.0) & (wide.centres < 1.3e3)  # waves longer than the first dip of the bedding
    same = np.abs(wide.levels - filters["0"]["winkler"].levels)[audible].max()
    none = filters['"none"']
    lower = (none["winkler"].levels - none["half-space"].levels)[audible]
    from_theory = np.abs(flat - theory)[audible].max()
    print("half-space against bedding, 100 Hz to 1.25 kHz:")
    print(f"  the same all across      {same:.1f} dB apart at most")
    print(
        f"  nothing in common        {lower.mean():.1f} dB lower on the average, {lower.min():.1f} to {lower.max():.1f}"
    )
    print(f"bedding against the average over the nominal contact: {from_theory:.1f} dB apart at most")
    assert same < 1.0
    assert lower.min() > 1.0
    assert from_theory < 1.0


if __name__ == "__main__":
    main()
