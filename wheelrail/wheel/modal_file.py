"""Modes of a wheel from another program: a table, or mode shapes in a universal file.

**Table** (text, see `wheelrail.numerics.column_file`), one mode per row::

    name, frequency [Hz], damping_ratio, shape_x [1/sqrt(kg)], shape_y [1/sqrt(kg)], shape_z [1/sqrt(kg)]
    "2,0,a", 412.6, 1e-4, 0.0, 0.0513, 0.0022

``frequency`` in Hz or kHz; ``damping_ratio`` (share of the critical damping, or in %) or ``loss_factor`` (twice that);
``shape_x``, ``shape_y``, ``shape_z``: displacement at the contact in the frame of the package, x' in rolling direction,
y' to the field side, z' down. The scale of the shapes is stated in one of two ways: the shapes without a unit and a
column ``modal_mass [kg]``, or mass-normalised shapes in 1/sqrt(kg), or 1/sqrt(t) from a model in mm, t and s. Names are
optional; an asterisk marks the partner of a mode turned by a quarter of a wave around the wheel, which has a row of its
own. Without a damping column the user gives the damping.

**Universal file**: data sets 55 with normal modes or first-order complex modes, units from data set 164. A complex mode
is turned to the phase in which it is most nearly real; how nearly is measured by its modal phase collinearity
|phi^T phi|^2 / (phi^H phi)^2 over all nodes (Pappa, Elliott and Schenk 1993), and a mode below 0.95 is
refused: from there on more than 1.3 % of its motion is out of phase, which real modes can't show.

Rigid-body motion belongs to the suspension in the case, so modes below a lowest frequency are left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..errors import DataFileError, ParameterError
from .damping import damping_ratios
from .modal_table import FileMode, table_modes
from .modal_universal import universal_modes
from .modes import FlexibleWheel, Mode
from .universal_file import is_universal

__all__ = ["read_modes"]


def read_modes(
    path: Path | str,
    *,
    node: int | None = None,
    axes: Sequence[str] | None = None,
    units: str | None = None,
    damping: float | str | Mapping[str, float | str] | None = None,
    mass_normalised: bool = False,
    lowest: float = 1.0,
    highest: float | None = None,
) -> tuple[FlexibleWheel, list[str]]:
    """Read the modes of a wheel.

    Parameters
    ----------
    path : Path or str
        Table or universal file; which of them follows from its first line.
    node : int, optional
        Universal file: the contact node; needed if there are several.
    axes : sequence of 3 str
        Universal file: its axes in rolling direction, to the field side and down, as in ("x", "-z", "y").
    units : {"m-kg-s", "mm-t-s", "mm-kg-s"}, optional
        Universal file: its units, instead of those that it says itself.
    damping : float, "thesis" or mapping, optional
        Damping ratios of modes for which the file gives none, as for `wheelrail.wheel.damping.damping_ratios`.
    mass_normalised : bool
        Universal file: shapes without a modal mass are mass-normalised in the file's units.
    lowest : float
        Modes below, in Hz, are left out as rigid-body motion.
    highest : float, optional
        Modes above, in Hz, are left out.

    Returns
    -------
    wheel : FlexibleWheel
        Without rigid-body modes; modes in the order of frequency.
    notes : list of str
        What was done and left out.

    Raises
    ------
    DataFileError
        The file can't be read or used; the message says where, which value and what is allowed.
    ParameterError
        An argument that isn't allowed, or doesn't apply to this kind of file.
    """
    path = Path(path)
    notes: list[str] = []
    if is_universal(path):
        found = universal_modes(path, node, axes, units, mass_normalised, notes)
    else:
        for name, value in (("node", node), ("axes", axes), ("units", units)):
            if value is not None:
                raise ParameterError(name, value, f"it belongs to a universal file; {path} is a table, which says it")
        found = table_modes(path)
    kept = [mode for mode in found if mode.frequency >= lowest and (highest is None or mode.frequency <= highest)]
    low = sum(mode.frequency < lowest for mode in found)
    if low:
        notes.append(
            f"{path.name}: {low} mode{'s' * (low > 1)} below {lowest:g} Hz left out; rigid-body motion comes from the "
            "suspension"
        )
    if len(found) - low > len(kept):
        notes.append(f"{path.name}: {len(found) - low - len(kept)} modes above {highest:g} Hz left out")
    if not kept:
        frequencies = [mode.frequency for mode in found]
        raise DataFileError(
            f"{path}: none of its {len(found)} modes ({min(frequencies):g} Hz to {max(frequencies):g} Hz) lies between "
            f"{lowest:g} Hz and {math.inf if highest is None else highest:g} Hz"
        )
    modes = _damped(path, kept, damping)
    undamped = sum(mode.damping == 0.0 for mode in modes)
    if undamped:
        notes.append(f"{path.name}: {undamped} modes without any damping")
    return FlexibleWheel(tuple(sorted(modes, key=lambda mode: mode.frequency))), notes


def _damped(path: Path, found: Sequence[FileMode], damping: float | str | Mapping | None) -> list[Mode]:
    """Make the modes, with the user's damping where the file has none."""
    without = [mode.name for mode in found if mode.ratio is None]
    if without and damping is None:
        raise DataFileError(
            f"{path}: no (viscous) damping of {len(without)} modes (the first is {without[0]}); give it in the file, "
            "or for all modes together: damping"
        )
    if damping is not None and not without:
        raise ParameterError("damping", damping, f"{path} gives the damping of every mode; leave one of the two out")
    try:
        ratios = damping_ratios(without, damping) if damping is not None else {}
    except ValueError as error:
        raise DataFileError(f"{path}: {error}") from None
    return [
        Mode.with_frequency(
            name=mode.name,
            mass=mode.mass,
            frequency=mode.frequency,
            damping_ratio=ratios[mode.name] if mode.ratio is None else mode.ratio,
            shape=mode.shape,
        )
        for mode in found
    ]
