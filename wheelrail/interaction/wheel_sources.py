"""Where a flexible wheel of a case comes from: a section, a file with modes, or receptances."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..case import Case
from ..case.wheel_sections import WHEEL_SECTIONS
from ..numerics.disk_cache import recall, remember
from ..wheel.modal_file import read_modes
from ..wheel.modes import FlexibleWheel, Mode, rigid_modes
from ..wheel.receptance_file import PointReceptance, read_receptance

__all__ = ["MeasuredWheel", "data_digest", "flexible_wheel_of"]

ALGORITHM = 1  # of the modes of a section, raised whenever the same input gives other numbers
FIT_ALGORITHM = 1  # of the modes fitted to receptances, likewise
_FILE_KEYS = ("node", "axes", "units")
_RECEPTANCE_KEYS = (*_FILE_KEYS, "reference_node", "quantity")
_POOR_FIT = 0.1  # deviation, rms over the rms of the receptances
_RIGID_KEYS = (
    "mass",
    "suspension_stiffness",
    "suspension_damping",
    "lateral_mass",
    "lateral_stiffness",
    "lateral_damping",
    "roll_inertia",
    "roll_stiffness",
    "roll_damping",
    "roll_arm_y",
    "roll_arm_z",
)


@dataclass(frozen=True, eq=False)
class MeasuredWheel:
    """A wheel that is known by its receptances at the contact.

    Parameters
    ----------
    measured : PointReceptance
    low_frequency : {"static", "free"}
        What goes on below the first line; the motion of a free body is replaced by `rigid`.
    rigid : tuple of Mode
        Rigid-body motions on the suspension, which come on top.
    notes : tuple of str
        What was found in the file.
    """

    measured: PointReceptance
    low_frequency: str
    rigid: tuple[Mode, ...]
    notes: tuple[str, ...]

    def held(self) -> MeasuredWheel:
        """Return the wheel without rigid-body motions."""
        return replace(self, rigid=())

    def receptance(self, frequency: ArrayLike) -> NDArray:
        """Receptances, shape (nf, 3, 3), m/N.

        Those that are given are linear between the lines and constant beyond them. The rigid-body motions come on top,
        unless those of the free body are in them already.
        """
        f, lines = np.atleast_1d(np.asarray(frequency, dtype=float)), self.measured
        flat = lines.values.reshape(len(lines.frequency), 9)
        values = np.array([np.interp(f, lines.frequency, column) for column in flat.T]).T.reshape(-1, 3, 3)
        return values if self.low_frequency == "free" else values + FlexibleWheel((), self.rigid).receptance(f)


def flexible_wheel_of(case: Case) -> FlexibleWheel | MeasuredWheel:
    """Make the wheel of a case whose ``wheel.model`` is "flexible".

    Raises
    ------
    DataFileError, ParameterError, ValueError
        If its keys do not go with its section or file.
    """
    given: Any = case.wheel
    keys: dict[str, Any] = {key: getattr(given, key) for key in _RIGID_KEYS}
    rigid = () if given.mass is None else rigid_modes(**keys)
    if given.receptances is not None and given.receptances_as == "functions":
        measured, notes = _receptances(case)
        return MeasuredWheel(measured, given.low_frequency, rigid, tuple(notes))
    if given.receptances is not None:
        wheel = _fitted(case)
    elif given.modes is not None:
        wheel, notes = read_modes(
            case.data_path(given.modes),
            **{key: getattr(given, key) for key in _FILE_KEYS},
            damping=given.damping,
            mass_normalised=bool(given.mass_normalised),
            highest=given.max_frequency,
        )
        wheel = replace(wheel, notes=tuple(notes))
    else:
        wheel = FlexibleWheel(_section_modes(case))
    return replace(wheel.without(given.remove_modes), rigid=rigid)


def data_digest(case: Case, name: str, presets: tuple[str, ...]) -> str:
    """Identify a section: the name of one that comes with the program, or the hash of a file's content."""
    if name.lower() in presets:
        return name.lower()
    return _file_digest(case.data_path(name))


def _file_digest(path: Path) -> str:
    return hashlib.blake2b(path.read_bytes(), digest_size=16).hexdigest()


def _receptances(case: Case) -> tuple[PointReceptance, list[str]]:
    given: Any = case.wheel
    return read_receptance(case.data_path(given.receptances), **{key: getattr(given, key) for key in _RECEPTANCE_KEYS})


def _fitted(case: Case) -> FlexibleWheel:
    """Modes fitted to the receptances, from the cache or computed."""
    given: Any = case.wheel
    path = case.data_path(given.receptances)
    content = {"kind": "modes of receptances", "algorithm": FIT_ALGORITHM, "low_frequency": given.low_frequency}
    content |= {key: getattr(given, key) for key in _RECEPTANCE_KEYS}
    # Its name, because the notes tell it.
    content |= {"file": _file_digest(path) if path.is_file() else None, "name": path.name}
    found = recall(content)
    if found is not None:
        values, arrays = found
        return FlexibleWheel(_modes_of(values, arrays), notes=tuple(values["notes"]))
    from ..wheel.modal_fit import fit_modes

    measured, notes = _receptances(case)
    try:
        fit = fit_modes(measured, low_frequency=given.low_frequency)
    except ValueError as error:
        raise ValueError(f'{path}: {error}; receptances_as = "functions" takes them without modes') from error
    notes += fit.notes
    if fit.deviation > _POOR_FIT:
        notes.append('the modes fit badly; receptances_as = "functions" takes the receptances without modes')
    if given.low_frequency == "free" and fit.body_accelerance[2, 2] > 0.0:
        notes.append(f"by the receptances the free body's mass is {1.0 / fit.body_accelerance[2, 2]:.4g} kg vertically")
    remember(
        content,
        description=f"wheel {path.name}: {len(fit.wheel.modes)} modes of receptances",
        values={**_names_of(fit.wheel.modes), "notes": notes},
        arrays=_arrays_of(fit.wheel.modes),
    )
    return replace(fit.wheel, notes=tuple(notes))


def _names_of(modes: tuple[Mode, ...]) -> dict[str, Any]:
    return {"names": [mode.name for mode in modes]}


def _arrays_of(modes: tuple[Mode, ...]) -> dict[str, NDArray]:
    return {"modes": np.array([[m.mass, m.stiffness, m.damping, *m.shape] for m in modes]).reshape(-1, 6)}


def _modes_of(values: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> tuple[Mode, ...]:
    """Modes from what the cache keeps of them."""
    return tuple(
        Mode(name, mass, stiffness, damping, (x, y, z))
        for name, (mass, stiffness, damping, x, y, z) in zip(values["names"], arrays["modes"].tolist(), strict=True)
    )


def _section_modes(case: Case) -> tuple[Mode, ...]:
    """Modes of the section at the contact, from the cache or computed."""
    given: Any = case.wheel
    names = ("youngs_modulus", "poisson_ratio", "density", "max_frequency", "contact_position", "damping")
    settings: dict[str, Any] = {name: getattr(given, name) for name in names}
    section = data_digest(case, given.section, WHEEL_SECTIONS)
    content = {"kind": "wheel modes", "algorithm": ALGORITHM, "section": section, **settings}
    content["element_size"] = given.element_size
    found = recall(content)
    if found is not None:
        return _modes_of(*found)
    # Finite elements are imported when they are needed only: they take long.
    from ..wheel.flexible import flexible_wheel
    from ..wheel.section import load_section

    wheel = flexible_wheel(
        section=load_section(given.section, case.folder, element_size=given.element_size), **settings, rigid=()
    )
    remember(
        content,
        description=f"wheel {given.section}: {len(wheel.modes)} modes up to {given.max_frequency:g} Hz at "
        f"{1e3 * given.contact_position:g} mm",
        values=_names_of(wheel.modes),
        arrays=_arrays_of(wheel.modes),
    )
    return wheel.modes
