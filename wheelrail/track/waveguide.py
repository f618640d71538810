"""Rail modelled as a waveguide, on a continuous pad or on discrete supports (Pieringer 2011, section 3.3.2).

The rail's section is divided into finite elements; along the rail its waves are exact. The waves up to a highest
frequency make up the rail's motion. On a continuous pad they are those of rail and pad together; on discrete supports,
which the thesis does not have, those of the free rail are coupled at the sleepers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .reduced_section import ReducedSection, reduce_section
from .ring import Ring, close_ring
from .safe_matrices import Material, Pad, SectionMatrices, section_matrices
from .section import RailSection
from .supported_ring import SupportedRing, Supports, close_supported_ring
from .waveguide_settings import RING_LENGTH

__all__ = ["WaveguideTrack"]


@dataclass(frozen=True, kw_only=True, eq=False)
class WaveguideTrack:
    """One rail and what it rests on.

    Parameters
    ----------
    section : RailSection
    material : Material
        Of the rail.
    support : Pad or Supports
        Continuous pad on a rigid foundation, or equal supports.
    contact_position : float
        Lateral position of the contact on the head, m, + to the field side of the wheel.
    max_frequency : float
        Highest frequency of the waves in Hz.
    ring_length : float
        Length in m of the ring that stands for the infinite rail.

    Raises
    ------
    ValueError
        If the contact isn't on the head's top or the pad is wider than the foot.
    """

    section: RailSection
    material: Material
    support: Pad | Supports
    contact_position: float
    max_frequency: float
    ring_length: float = RING_LENGTH

    @property
    def sleeper_spacing(self) -> float | None:
        """Spacing of discrete supports in m; None for a continuous pad."""
        return self.support.spacing if isinstance(self.support, Supports) else None

    @cached_property
    def matrices(self) -> SectionMatrices:
        """Matrices of the section, with the pad if it is continuous."""
        return section_matrices(
            self.section,
            material=self.material,
            pad=self.support if isinstance(self.support, Pad) else None,
            contact_position=self.contact_position,
        )

    @cached_property
    def reduced(self) -> ReducedSection:
        """The section in the coordinates of its own waves; outputs are head (3) and foot (4)."""
        rows = np.vstack([self.matrices.head_rows, self.matrices.foot_rows])
        return reduce_section(self.matrices, rows, max_frequency=self.max_frequency)

    @cached_property
    def waves(self) -> Ring | None:
        """Waves of the rail on its pad; None on discrete supports."""
        if isinstance(self.support, Supports):
            return None
        return close_ring(self.reduced, length=self.ring_length, max_frequency=self.max_frequency)

    @cached_property
    def bloch_modes(self) -> SupportedRing | None:
        """Modes of the rail on discrete supports; None on a continuous pad."""
        if not isinstance(self.support, Supports):
            return None
        return close_supported_ring(
            self.reduced, supports=self.support, length=self.ring_length, max_frequency=self.max_frequency
        )

    def receptance(self, frequency: ArrayLike, x0: float = 0.0, x: float | None = None) -> NDArray:
        """Receptance at the contact on the rail's head.

        Parameters
        ----------
        frequency : array_like, shape (n,)
            Hz; complex values ask for the response to exp(i 2 pi f t) off the real axis.
        x0, x : float
            Place of the force and of the displacement in m, from a support if there are any; x is x0 unless given.

        Returns
        -------
        ndarray of complex, shape (n, 3, 3)
            [frequency, displacement, force] in m/N.
        """
        place = x0 if x is None else x
        if self.bloch_modes is not None:
            return self.bloch_modes.receptance(frequency, x0, place)
        assert self.waves is not None
        return self.waves.receptance(frequency, place - x0)[:, 0]

    def static_compliance(self, x0: float = 0.0) -> NDArray:
        """Return the static compliance at the contact for a force at x0 in m/N, shape (3, 3)."""
        if self.bloch_modes is not None:
            return self.bloch_modes.static_compliance(x0)
        assert self.waves is not None
        return self.waves.static_compliance()
