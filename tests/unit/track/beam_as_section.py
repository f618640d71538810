"""A Timoshenko beam in the form of a cross-section with two unknowns, deflection and rotation."""

import numpy as np

from wheelrail.track.reduced_section import ReducedSection


def timoshenko_section(
    *,
    bending_stiffness: float,
    shear_stiffness: float,
    mass_per_length: float,
    rotary_inertia: float,
    foundation: float = 0.0,
    loss_factor: float = 0.0,
    foundation_loss_factor: float = 0.0,
) -> ReducedSection:
    """Build it with rows for head (x', y', z') and foot (x', y', z', rotation); only z' moves.

    The rotation is i times the unknown, as an axial displacement is: shear w' - psi = -i (k w + psi~).
    """
    scale = 1.0 / np.sqrt([mass_per_length, rotary_inertia])
    scaled = np.outer(scale, scale)
    k0 = np.array([[0.0, 0.0], [0.0, shear_stiffness]]) * scaled
    k1 = shear_stiffness * np.array([[0.0, 1.0], [1.0, 0.0]]) * scaled
    k2 = np.diag([shear_stiffness, bending_stiffness]) * scaled
    zero = np.zeros((2, 2))
    parts = ((k0, k1, k2), (np.diag([foundation, 0.0]) * scaled, zero, zero))
    outputs = np.zeros((7, 2))
    outputs[[2, 5], 0] = scale[0]
    return ReducedSection(parts, (loss_factor, foundation_loss_factor), outputs)
