"""Timoshenko's beam with the section of 60E1, endless, on springs or on supports, by the residues of its two waves."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_toeplitz

from wheelrail.track.section_sources import preset_section

SECTION = preset_section("60e1")
STEEL, DENSITY, LOSS = 207e9, 7860.0, 0.01
BENDING = STEEL * SECTION.second_moments[0]
SHEAR = 241e6  # N; fits the long waves, by an independent code
MASS, ROTARY = DENSITY * SECTION.area, DENSITY * SECTION.second_moments[0]
SPACING = 0.65  # m, of the supports
SUPPORT = {
    "pad_stiffness": 120e6,
    "pad_damping": 16e3,
    "sleeper_mass": 125.0,
    "ballast_stiffness": 140e6,
    "ballast_damping": 165e3,
}
POINT = (0.0, 0.0, 0.0)


def free_beam(x, frequency: float, loss: float = LOSS, foundation: complex = 0.0) -> np.ndarray:
    """Receptance of an endless beam between points at a distance x, by the residues of its two waves; m/N."""
    bending, shear = BENDING * (1.0 + 1j * loss), SHEAR * (1.0 + 1j * loss)
    omega2 = (2.0 * np.pi * frequency) ** 2
    upper, rocking = foundation - omega2 * MASS, shear - omega2 * ROTARY
    # w / F = (EI k^2 + rocking) / ((kGA k^2 + upper) (EI k^2 + rocking) - (kGA k)^2)
    a, b, c = shear * bending, shear * rocking + upper * bending - shear**2, upper * rocking
    result = np.zeros(np.shape(x), dtype=complex)
    for square in np.roots([a, b, c]):
        k = np.sqrt(square + 0j)
        k = -k if k.imag > 0.0 else k
        result += -1j * (bending * square + rocking) / (4.0 * a * k**3 + 2.0 * b * k) * np.exp(-1j * k * np.abs(x))
    return result


def beam_on_supports(x0: float, frequency, *, local=POINT, loss: float = LOSS) -> np.ndarray:
    """Point receptance of a beam on 321 supports, coupled through the free beam's receptances."""
    places = SPACING * np.arange(-160, 161)
    result = []
    for f in frequency:
        omega = 2.0 * np.pi * f
        pad = SUPPORT["pad_stiffness"] + 1j * omega * SUPPORT["pad_damping"]
        below = SUPPORT["ballast_stiffness"] + 1j * omega * SUPPORT["ballast_damping"]
        below -= SUPPORT["sleeper_mass"] * omega**2
        support = pad * below / (pad + below)
        matrix = support * free_beam(places - places[0], f, loss)
        matrix[0] += 1.0 + support * local[2]
        drive = free_beam(places - x0, f, loss) + np.where(np.abs(places - x0) < 1e-9, local[1], 0.0)
        feet = solve_toeplitz((matrix, matrix), drive)
        result.append(free_beam(0.0, f, loss) + local[0] - support * np.sum(drive * feet))
    return np.array(result)
