"""Numerical settings of the waveguide rail, which its results depend on a little.

They are by themselves so that the key of a cached result can hold them without an import of finite elements.
"""

from __future__ import annotations

__all__ = ["ELEMENT_SIZE", "MARGIN", "RING_LENGTH", "SPACING"]

ELEMENT_SIZE = 6e-3
"""Side of the quadrilaterals in the section, m."""

SPACING = 5.0
"""Between the wavenumbers whose shapes are the basis of the reduced section, rad/m."""

MARGIN = 2.0
"""The basis holds shapes up to this multiple of the highest frequency."""

RING_LENGTH = 400.0
"""Length of the ring that stands for the infinite rail, m.

Vertical and lateral waves die out before they come round. Longitudinal ones below 1 kHz do not: they change the
longitudinal receptance by up to 16 %, the Green's functions from 80 ms on.
"""
