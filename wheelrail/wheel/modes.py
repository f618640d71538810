"""A flexible wheel as the sum of its modes, seen from the contact (Pieringer 2011, eq. 3.10).

Directions are ordered (x', y', z'): rolling, to the field side, down into the rail. A receptance is the displacement of
the wheel under a force on the wheel, both in these directions.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["RESIDUAL", "FlexibleWheel", "Mode", "rigid_modes"]

RESIDUAL = "above-"
"""Beginning of the names of modes that stand for the compliance of all modes above a band."""


@dataclass(frozen=True)
class Mode:
    """One mode: an oscillator and its shape at the contact.

    Parameters
    ----------
    name : str
        (n,m,a), (n,r) or (n,c) without the brackets, "7,0,a" for instance. An asterisk marks the partner turned by a
        quarter of a wave around the wheel; "vertical", "lateral" and "roll" are the rigid-body modes. "fit-1" and
        "above-1" for instance were fitted to receptances.
    mass : float
        Modal mass in kg.
    stiffness : float
        Modal stiffness in N/m; 0 for a free rigid body.
    damping : float
        Modal viscous damping in N s/m.
    shape : tuple of 3 floats
        Displacement (x', y', z') at the contact, dimensionless, in the scale that belongs to `mass`.
    """

    name: str
    mass: float
    stiffness: float
    damping: float
    shape: tuple[float, float, float]

    @classmethod
    def with_frequency(
        cls, *, name: str, mass: float, frequency: float, damping_ratio: float, shape: tuple[float, float, float]
    ) -> Mode:
        """Make a mode from its natural frequency (Hz) and its damping ratio."""
        omega = 2.0 * math.pi * frequency
        return cls(name, mass, mass * omega**2, 2.0 * damping_ratio * mass * omega, shape)

    @property
    def omega(self) -> float:
        """Natural angular frequency without damping, rad/s."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def frequency(self) -> float:
        """Natural frequency without damping, Hz."""
        return self.omega / (2.0 * math.pi)

    @property
    def damping_ratio(self) -> float:
        """Damping over critical damping; for a free body 0 without damping, else infinite."""
        if self.stiffness == 0.0:
            return math.inf if self.damping else 0.0
        return self.damping / (2.0 * math.sqrt(self.stiffness * self.mass))

    @property
    def residual(self) -> bool:
        """Whether it is no mode of its own, but stands for the compliance of all above a band."""
        return self.name.startswith(RESIDUAL)


@dataclass(frozen=True)
class FlexibleWheel:
    """Modes of a wheel.

    Parameters
    ----------
    modes : tuple of Mode
        Flexible modes.
    rigid : tuple of Mode
        Rigid-body modes.
    notes : tuple of str
        What a user should know of where the modes come from.
    """

    modes: tuple[Mode, ...]
    rigid: tuple[Mode, ...] = ()
    notes: tuple[str, ...] = field(default=(), compare=False)

    @property
    def all_modes(self) -> tuple[Mode, ...]:
        """Rigid-body modes, then flexible ones."""
        return self.rigid + self.modes

    @property
    def shapes(self) -> NDArray:
        """Shapes at the contact of all modes, shape (number of modes, 3)."""
        return np.array([mode.shape for mode in self.all_modes], dtype=float).reshape(-1, 3)

    def receptance(self, frequency: ArrayLike) -> NDArray:
        """Point receptances at the contact.

        Parameters
        ----------
        frequency : array_like, shape (nf,)
            In Hz. At 0 Hz a free body's receptance is infinite and refused.

        Returns
        -------
        ndarray of complex, shape (nf, 3, 3)
            Displacement (second index) under a force on the wheel (third index), m/N; time factor exp(+i omega t).

        Raises
        ------
        ValueError
            At 0 Hz, where a rigid-body mode has no suspension.
        """
        omega = 2.0 * np.pi * np.atleast_1d(np.asarray(frequency, dtype=float))[:, None]
        mass, stiffness, damping = (
            np.array([getattr(mode, name) for mode in self.all_modes]) for name in ("mass", "stiffness", "damping")
        )
        dynamic = stiffness + 1j * omega * damping - omega**2 * mass
        if np.any(dynamic == 0.0):
            raise ValueError("a body without a suspension has no receptance at 0 Hz")
        shapes = self.shapes
        outer = (shapes[:, :, None] * shapes[:, None, :]).reshape(-1, 9)
        return ((1.0 / dynamic) @ outer).reshape(-1, 3, 3)

    def static_compliance(self) -> NDArray:
        """Displacement under a constant force, m/N; shape (3, 3); infinite where a body has no suspension."""
        result = np.zeros((3, 3))
        for mode in self.all_modes:
            outer = np.outer(mode.shape, mode.shape)
            if mode.stiffness:
                result += outer / mode.stiffness
            else:
                result[outer != 0.0] += np.sign(outer[outer != 0.0]) * np.inf
        return result

    def held(self) -> FlexibleWheel:
        """Return the wheel without rigid-body modes, for a vehicle model that owns and moves the wheel's mass."""
        return replace(self, rigid=())

    def without(self, names: Iterable[str]) -> FlexibleWheel:
        """Leave flexible modes out.

        Parameters
        ----------
        names : iterable of str
            "7,0,a" stands for both partners, "7,0,a*" for the second one only. Brackets and blanks are ignored.

        Returns
        -------
        FlexibleWheel

        Raises
        ------
        ValueError
            For a name that no flexible mode has; lists the nearest names.
        """
        known = {mode.name for mode in self.modes}
        known |= {name.removesuffix("*") for name in known}
        removed = set()
        for given in names:
            name = given.strip().replace(" ", "").replace("(", "").replace(")", "")
            if name not in known:
                nearest = difflib.get_close_matches(name, sorted(known), n=3, cutoff=0.0)
                raise ValueError(f'the wheel has no mode "{given}"; nearest names: {", ".join(nearest) or "none"}')
            removed |= {name} if name.endswith("*") else {name, f"{name}*"}
        return replace(self, modes=tuple(mode for mode in self.modes if mode.name not in removed))

    def with_damping_factor(self, factor: float) -> FlexibleWheel:
        """Return the wheel with the damping of all flexible modes multiplied by `factor`."""
        return replace(self, modes=tuple(replace(mode, damping=factor * mode.damping) for mode in self.modes))


def rigid_modes(
    *,
    mass: float,
    suspension_stiffness: float,
    suspension_damping: float,
    lateral_mass: float | None = None,
    lateral_stiffness: float | None = None,
    lateral_damping: float | None = None,
    roll_inertia: float | None = None,
    roll_stiffness: float | None = None,
    roll_damping: float | None = None,
    roll_arm_y: float | None = None,
    roll_arm_z: float | None = None,
) -> tuple[Mode, ...]:
    """Rigid-body modes of half a wheelset on its suspension: vertical, lateral and roll.

    Lateral motion is included where all its three arguments are given, roll where all its five are. The wheel has no
    rigid-body motion along the rail and none about its axle.

    Parameters
    ----------
    mass, suspension_stiffness, suspension_damping : float
        Of the vertical motion, in kg, N/m, N s/m; 0 leaves the body unsprung.
    lateral_mass, lateral_stiffness, lateral_damping : float, optional
        Of the lateral motion, in kg, N/m, N s/m.
    roll_inertia, roll_stiffness, roll_damping : float, optional
        Of the rotation about x', in kg m^2, N m/rad, N m s/rad.
    roll_arm_y, roll_arm_z : float, optional
        Contact relative to the wheelset's centre, in m: to the field side (half the distance between the contacts of
        the two wheels) and down (the rolling radius).

    Returns
    -------
    tuple of Mode
        Named "vertical", "lateral", "roll". The roll mode has the angle as its coordinate, in rad, so its mass is in
        kg m^2 and its shape, the displacement at the contact per rad, in m.

    Raises
    ------
    ValueError
        For a motion with only some of its arguments, a mass or inertia that isn't positive, a negative stiffness or
        damping.
    """
    vertical = {"mass": mass, "suspension_stiffness": suspension_stiffness, "suspension_damping": suspension_damping}
    lateral = {
        "lateral_mass": lateral_mass,
        "lateral_stiffness": lateral_stiffness,
        "lateral_damping": lateral_damping,
    }
    roll = {"roll_inertia": roll_inertia, "roll_stiffness": roll_stiffness, "roll_damping": roll_damping}
    arms = {"roll_arm_y": roll_arm_y, "roll_arm_z": roll_arm_z}
    modes = [Mode("vertical", *_checked(vertical), (0.0, 0.0, 1.0))]
    if _given(lateral):
        modes.append(Mode("lateral", *_checked(lateral), (0.0, 1.0, 0.0)))
    if _given(roll | arms):
        # Angle times e_x times (0, arm_y, arm_z).
        modes.append(Mode("roll", *_checked(roll), (0.0, -float(roll_arm_z or 0.0), float(roll_arm_y or 0.0))))
    return tuple(modes)


def _given(arguments: Mapping[str, float | None]) -> bool:
    """Whether a motion is wanted; all of its arguments or none have to be there."""
    missing = [name for name, value in arguments.items() if value is None]
    if missing and len(missing) < len(arguments):
        raise ValueError(f"{', '.join(missing)}: missing; give all of {', '.join(arguments)} or none")
    return not missing


def _checked(arguments: Mapping[str, float | None]) -> tuple[float, float, float]:
    """Mass, stiffness and damping of a motion, of which the first is positive and the others aren't negative."""
    values = {name: float(value if value is not None else math.nan) for name, value in arguments.items()}
    for i, (name, value) in enumerate(values.items()):
        if not (math.isfinite(value) and (value > 0.0 if i == 0 else value >= 0.0)):
            raise ValueError(f"{name} = {value!r} is refused: it has to be {'positive' if i == 0 else 'at least 0'}")
    first, second, third = values.values()
    return first, second, third
