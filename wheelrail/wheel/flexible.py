"""Flexible wheels (Pieringer 2011, section 3.2.2): modes of an axisymmetric section, and what the contact sees of them.

The stiffness of modes above the highest frequency is left out. Most of it is the local deformation around the contact,
which is infinite for a point force on an elastic body and which the contact model's half-space holds already.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from numpy.typing import NDArray

from .axisymmetric import AxisymmetricBody
from .damping import damping_ratios
from .modes import FlexibleWheel, Mode
from .naming import name_modes
from .section import WheelSection

__all__ = ["SectionMode", "WheelShapes", "flexible_wheel", "wheel_shapes"]

_NARROWEST_TREAD = 0.95  # radius over that of the tread centre, for contacts


@dataclass(frozen=True, eq=False)
class SectionMode:
    """A mode of the whole wheel, as amplitudes in the section.

    Parameters
    ----------
    name : str
        (n,m,a), (n,r) or (n,c), without the brackets. A mode with n > 0 stands for its partner as well.
    harmonic : int
        Number of nodal diameters n.
    frequency : float
        Natural frequency in Hz.
    mass : float
        Modal mass in kg, for the scale of `shape`.
    shape : ndarray, shape (points, 3)
        Amplitudes (u_r, u_theta, u_z); the longest vector has length 1. Around the wheel the displacement is
        (u_r cos(n theta), u_theta sin(n theta), u_z cos(n theta)).
    energy : tuple of 3 floats
        Shares of the kinetic energy: radial, circumferential, axial.
    """

    name: str
    harmonic: int
    frequency: float
    mass: float
    shape: NDArray
    energy: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class WheelShapes:
    """All modes of a wheel up to a frequency, with their shapes over the section.

    Parameters
    ----------
    section : WheelSection
    body : AxisymmetricBody
    max_frequency : float
        Hz.
    modes : tuple of SectionMode
        By frequency.
    """

    section: WheelSection
    body: AxisymmetricBody
    max_frequency: float
    modes: tuple[SectionMode, ...]

    @property
    def tread(self) -> tuple[float, float]:
        """Range of contact positions on the tread in m, from the flange side (negative) to the field side."""
        ends = self.body.points[self.body.boundary[:, :2]]
        z = ends[..., 1][ends[..., 0] >= _NARROWEST_TREAD * self.section.tread_radius]
        return -float(z.max()), -float(z.min())

    def contact_weights(self, contact_position: float) -> NDArray:
        """Weights of the section's points in the contact's motion.

        Parameters
        ----------
        contact_position : float
            m from the tread centre, positive to the field side.

        Returns
        -------
        ndarray, shape (points,)

        Raises
        ------
        ValueError
            Where there is no tread.
        """
        first, last = self.tread
        if not first <= contact_position <= last:
            raise ValueError(
                f"contact_position = {contact_position:g} m is refused: the wheel's tread reaches from {first:g} to "
                f"{last:g} m"
            )
        return self.body.outer_point(-contact_position)[1]

    def at(self, *, contact_position: float, damping: float | str | Mapping[str, float | str]) -> tuple[Mode, ...]:
        """Modes as a contact on the tread sees them.

        The radial and axial motion at the contact belong to one family of modes. The partners turned by a quarter of a
        wave, marked by an asterisk, only move it along the rail; so does the twist (0,c), which has no partner.

        Parameters
        ----------
        contact_position : float
            m from the tread centre, positive to the field side.
        damping : float, "thesis" or mapping
            See `damping_ratios`.

        Returns
        -------
        tuple of Mode

        Raises
        ------
        ValueError
            For a position beside the tread, or damping that is refused.
        """
        weights = self.contact_weights(contact_position)
        seen: list[tuple[SectionMode, str, tuple[float, float, float]]] = []
        for mode in self.modes:
            radial, circumferential, axial = (float(value) for value in weights @ mode.shape)
            # With z' down, y' away from the flange and theta from e_r to e_theta = -e_x', the second family's
            # -u_theta at theta = 0 is + along x'. The sign of a mode as a whole is arbitrary.
            along, across = (circumferential, 0.0, 0.0), (0.0, -axial, radial)
            if mode.harmonic == 0:
                seen.append((mode, mode.name, along if mode.energy[1] > 0.5 else across))
            else:
                seen += [(mode, mode.name, across), (mode, f"{mode.name}*", along)]
        ratios = damping_ratios([name for _, name, _ in seen], damping)
        return tuple(
            Mode.with_frequency(
                name=name, mass=mode.mass, frequency=mode.frequency, damping_ratio=ratios[name], shape=shape
            )
            for mode, name, shape in seen
        )


def wheel_shapes(
    section: WheelSection, *, youngs_modulus: float, poisson_ratio: float, density: float, max_frequency: float
) -> WheelShapes:
    """Compute all modes of a wheel that is held at its hub.

    Parameters
    ----------
    section : WheelSection
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    density : float
        kg/m^3.
    max_frequency : float
        Hz; harmonics are added until one has all its modes above.

    Returns
    -------
    WheelShapes
    """
    body = AxisymmetricBody(section.mesh, youngs_modulus=youngs_modulus, poisson_ratio=poisson_ratio, density=density)
    found: list[SectionMode] = []
    harmonic = 0
    while True:
        modes = body.modes(harmonic, max_frequency)
        kinetic = body.kinetic_product(modes.shapes, modes.shapes)
        kinetic /= kinetic.sum(axis=1, keepdims=True)
        for i, name in enumerate(name_modes(body, modes)):
            energy = (float(kinetic[i, 0]), float(kinetic[i, 1]), float(kinetic[i, 2]))
            frequency, mass = float(modes.frequency[i]), float(modes.mass[i])
            found.append(SectionMode(name, harmonic, frequency, mass, modes.shapes[i], energy))
        # Of discs and wheels, the lowest frequency rises with n from n = 2 on.
        if harmonic >= 2 and len(modes.frequency) == 0:
            break
        harmonic += 1
    found.sort(key=lambda mode: mode.frequency)
    return WheelShapes(section, body, max_frequency, tuple(found))


def flexible_wheel(
    *,
    section: WheelSection,
    youngs_modulus: float,
    poisson_ratio: float,
    density: float,
    max_frequency: float,
    damping: float | str | Mapping[str, float | str],
    contact_position: float,
    rigid: Sequence[Mode],
) -> FlexibleWheel:
    """Make a flexible wheel from its section.

    Parameters
    ----------
    section : WheelSection
        See `load_section`.
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    density : float
        kg/m^3.
    max_frequency : float
        Hz; all modes up to it are included.
    damping : float, "thesis" or mapping
        See `damping_ratios`.
    contact_position : float
        m from the tread centre, positive to the field side.
    rigid : sequence of Mode
        Rigid-body modes; see `rigid_modes`.

    Returns
    -------
    FlexibleWheel

    Raises
    ------
    ValueError
        For a position beside the tread, or damping that is refused.
    """
    shapes = wheel_shapes(
        section,
        youngs_modulus=youngs_modulus,
        poisson_ratio=poisson_ratio,
        density=density,
        max_frequency=max_frequency,
    )
    return FlexibleWheel(shapes.at(contact_position=contact_position, damping=damping), tuple(rigid))
