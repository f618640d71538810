"""The synthetic wheel of the preset, in the material of Pieringer (2011), section 3.2.2."""

from __future__ import annotations

from functools import cache

from wheelrail.wheel.flexible import WheelShapes, wheel_shapes
from wheelrail.wheel.section import load_section

STEEL = {"youngs_modulus": 207e9, "poisson_ratio": 0.3, "density": 7860.0}


@cache
def synthetic_wheel(max_frequency: float = 7e3, element_size: float | None = None) -> WheelShapes:
    section = load_section("synthetic-c20", element_size=element_size)
    return wheel_shapes(section, **STEEL, max_frequency=max_frequency)
