"""The stability of steady sliding for a case file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case import Case
from ..contact.creep.contact_spring import tangential_compliance
from ..contact.creep.linear import linear_creep_force
from ..contact.creep.vermeulen_johnson import saturated_fraction
from ..errors import CaseError
from ..interaction.build import hertz_of
from ..interaction.friction import law_of, slip_friction_of, static_friction_of
from ..interaction.tracks import track_of
from ..interaction.wheels import wheel_of
from ..wheel.modes import FlexibleWheel
from .stability import SlidingLoop, WheelModeStability, mode_stability, unstable_count

__all__ = ["CaseStability", "case_stability", "sliding_loop"]

HIGHEST = 3.0  # of the Nyquist curve, as a multiple of the wheel's highest modal frequency


@dataclass(frozen=True)
class CaseStability:
    """Stability of steady sliding of one case.

    Attributes
    ----------
    modes : tuple of WheelModeStability
        The wheel's modes in contact.
    saturation : float
        Tangential force in steady rolling over the friction limit, by Vermeulen and Johnson (1964). The check takes the
        contact as sliding fully; below about 0.99 it does not hold.
    growing : int
        Growing oscillations of the whole system by Nyquist's criterion; more than the growing modes of the wheel if
        wheel mass and rail, the rail alone or the contact alone have one of their own.
    loop : SlidingLoop
        What was judged.
    """

    modes: tuple[WheelModeStability, ...]
    saturation: float
    growing: int
    loop: SlidingLoop

    @property
    def unstable(self) -> tuple[WheelModeStability, ...]:
        """Growing modes of the wheel, the fastest first."""
        return tuple(sorted((m for m in self.modes if m.unstable), key=lambda m: -m.growth_rate))


def sliding_loop(case: Case, *, x: float | None = None) -> SlidingLoop:
    """Linearise a case about steady sliding.

    Parameters
    ----------
    case : Case
        With a flexible wheel given by modes, a waveguide or rigid track, friction and a creepage.
    x : float, optional
        Place of the contact on a rail with discrete supports, m from a sleeper; left out: the case's start.

    Returns
    -------
    SlidingLoop

    Raises
    ------
    CaseError
        If the case has no sliding in three directions to be judged.
    """
    wheel, friction, creepage = wheel_of(case), case.friction, case.creepage
    if not isinstance(wheel, FlexibleWheel):
        raise CaseError(
            "wheel.model",
            [
                'the stability of sliding needs a wheel with modes: "flexible" from section, modes or receptances as '
                "modes"
            ],
        )
    if case.track.model == "discrete":
        raise CaseError(
            "track.model",
            ['the beam track has no lateral motion; the stability of sliding needs "waveguide" or "rigid"'],
        )
    if friction is None or creepage is None:
        raise CaseError("friction", ["the stability of sliding needs [friction] and [creepage]"])
    if creepage.x == 0.0 and creepage.y == 0.0:
        raise CaseError("creepage", ["x and y are both 0, so there is no direction of sliding"])
    if not wheel.modes:
        raise CaseError("wheel.max_frequency", ["the wheel has no mode up to this frequency; raise it"])
    track: Any = track_of(case)
    place = case.simulation.start_position if x is None else x

    def rail(frequency: NDArray) -> NDArray:
        if track is None:
            return np.zeros((len(frequency), 3, 3))
        return track.receptance(frequency, place)

    hertz, contact = hertz_of(case), case.contact
    speed = case.simulation.speed * float(np.hypot(creepage.x, creepage.y))
    ratio, slope = law_of(case).evaluate(np.array([speed]))
    static, settings = static_friction_of(case), slip_friction_of(case)
    compliance = tangential_compliance(
        semi_axis_x=hertz.semi_axis_x,
        semi_axis_y=hertz.semi_axis_y,
        shear_modulus=contact.youngs_modulus / (2.0 * (1.0 + contact.poisson_ratio)),
        poisson_ratio=contact.poisson_ratio,
    )
    along = np.array([creepage.x, creepage.y]) / np.hypot(creepage.x, creepage.y)
    return SlidingLoop(
        wheel,
        rail,
        1.5 * hertz.load / hertz.approach,  # F = C d^1.5 about the preload
        static * float(ratio[0]),
        (creepage.x, creepage.y),
        load=hertz.load,
        sliding_speed=speed,
        friction_slope=static * float(slope[0]),
        memory_distance=0.0 if settings is None or settings.memory is None else settings.memory.distance,
        tangential_compliance=float(np.array(compliance) @ along**2),
    )


def case_stability(case: Case, *, x: float | None = None) -> CaseStability:
    """Find the wheel modes of a case that grow in steady sliding.

    Parameters
    ----------
    case, x
        As `sliding_loop` takes them.

    Returns
    -------
    CaseStability
    """
    loop = sliding_loop(case, x=x)
    highest = HIGHEST * max(mode.frequency for mode in loop.wheel.modes)
    growing = unstable_count(loop, highest_frequency=highest)
    return CaseStability(mode_stability(loop), _saturation(case, loop), growing, loop)


def _saturation(case: Case, loop: SlidingLoop) -> float:
    """Tangential force of steady rolling over the friction limit."""
    hertz, contact, creepage = hertz_of(case), case.contact, case.creepage
    assert creepage is not None
    linear = linear_creep_force(
        creepage_x=creepage.x,
        creepage_y=creepage.y,
        spin=creepage.spin,
        semi_axis_x=hertz.semi_axis_x,
        semi_axis_y=hertz.semi_axis_y,
        shear_modulus=contact.youngs_modulus / (2.0 * (1.0 + contact.poisson_ratio)),
        poisson_ratio=contact.poisson_ratio,
    )
    limit = loop.friction_coefficient * hertz.load
    if limit == 0.0:
        return 1.0
    return float(saturated_fraction(float(np.hypot(linear.force_x, linear.force_y)) / limit))
