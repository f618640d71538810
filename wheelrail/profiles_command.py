"""The command ``wheelrail profiles``: where the wheels of a wheelset touch their rails as it moves sideways."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from wheelrail.analysis_report import AnalysisReport, check_folder, write_figure, write_table
from wheelrail.case import Case
from wheelrail.errors import ParameterError
from wheelrail.interaction.profiles import profile_geometry_of
from wheelrail.plotting.profiles import contact_over_shift_figure, profiles_figure
from wheelrail.profile.wheelset import equivalent_conicity, wheelset_contact

__all__ = ["profiles_report"]

_STEP = 0.5e-3  # m
_DRAWN = 401  # points of a curve
_CONICITY_AT = 3e-3  # m, EN 15302
_COLUMNS = (
    "lateral_mm",
    "wheel_right_mm",
    "rail_right_mm",
    "angle_right_rad",
    "wheel_left_mm",
    "rail_left_mm",
    "angle_left_rad",
    "radius_difference_mm",
)


def profiles_report(
    case: Case,
    folder: str | os.PathLike[str],
    *,
    stem: str,
    largest: float,
    gauge: float,
    flange_back_spacing: float,
    flange_back_position: float,
) -> AnalysisReport:
    """Contact of a wheelset with the profiles of a case, and of its right wheel over the lateral shift.

    Written are ``_wheelset.csv``, ``_profiles.png`` and ``_contact.png``.

    Parameters
    ----------
    case : Case
    folder : path-like
        Where files go.
    stem : str
        Their names' beginning.
    largest : float
        Largest displacement of the wheelset to either side, m.
    gauge, flange_back_spacing, flange_back_position : float
        As for `wheelrail.profile.wheelset.wheelset_contact`, m.

    Returns
    -------
    AnalysisReport

    Raises
    ------
    WheelrailError
        If the case has no profiles, they don't touch, or a file can't be written.
    """
    folder = Path(folder)
    check_folder(folder)
    if case.contact.wheel_profile is None:
        raise ParameterError(
            "contact.wheel_profile", "", "the case has no profiles; give wheel_profile, rail_profile and inclination"
        )
    for option, value, low, high in (
        ("--largest", largest, 1e-3, 0.05),
        ("--gauge", gauge, 0.5, 2.0),
        ("--back-spacing", flange_back_spacing, 0.5, 2.0),
        ("--back-position", flange_back_position, -0.2, 0.0),
    ):
        if not low <= value <= high:
            raise ParameterError(option, value, f"must be {low:g} to {high:g} m")
    geometry, notes = profile_geometry_of(case)
    count = max(round(largest / _STEP), 1)
    lateral = np.arange(-count, count + 1) * _STEP
    wheelset = wheelset_contact(
        geometry,
        lateral=lateral,
        gauge=gauge,
        flange_back_spacing=flange_back_spacing,
        flange_back_position=flange_back_position,
    )
    columns = [1e3 * lateral]
    for left in (False, True):
        columns += [1e3 * wheelset.values(name, left=left) for name in ("y_wheel", "y_rail")]
        columns.append(wheelset.values("angle", left=left))
    columns.append(1e3 * wheelset.radius_difference)
    table = np.array(columns).T
    rows = [
        geometry.description,
        f"gauge {1e3 * gauge:g} mm, flange backs {1e3 * flange_back_spacing:g} mm apart",
        "",
        f"{'wheelset':>9}{'right wheel':>13}{'rail':>9}{'angle':>9}{'left wheel':>13}{'rail':>9}{'angle':>9}"
        f"{'radius diff.':>14}",
        f"{'mm':>9}{'mm':>13}{'mm':>9}{'rad':>9}{'mm':>13}{'mm':>9}{'rad':>9}{'mm':>14}",
    ]
    rows += [
        f"{y:9.1f}{a:13.2f}{b:9.2f}{c:9.4f}{d:13.2f}{e:9.2f}{f:9.4f}{g:14.3f}" for y, a, b, c, d, e, f, g in table[::2]
    ]
    if largest > _CONICITY_AT:
        conicity = equivalent_conicity(
            lateral=lateral, radius_difference=wheelset.radius_difference, amplitude=_CONICITY_AT
        )
        rows += ["", f"equivalent conicity at {1e3 * _CONICITY_AT:g} mm             {conicity:.3f}"]
    rows.append(f"lateral_shift of a centred wheelset   {1e3 * wheelset.centred_shift:+.2f} mm")
    title = case.title or stem
    shift = case.contact.lateral_shift
    fine = np.linspace(lateral[0], lateral[-1], _DRAWN)
    files = (
        write_table(folder / f"{stem}_wheelset.csv", _COLUMNS, ([f"{v:.6g}" for v in row] for row in table)),
        write_figure(folder / f"{stem}_profiles.png", profiles_figure(geometry, shift=shift, title=title)),
        write_figure(
            folder / f"{stem}_contact.png",
            contact_over_shift_figure(geometry, shifts=wheelset.centred_shift + fine, title=title),
        ),
    )
    return AnalysisReport("\n".join(rows), tuple(notes), files)
