"""Names of wheel modes by their motion: axial (n,m,a), radial (n,r), circumferential (n,c).

n counts nodal diameters, m nodal circles (Pieringer 2011, section 3.2.2). In most modes of a wheel the three motions
are mixed, so a mode is not named by its largest component but by its likeness to the two in-plane motions of a ring,
which the rim is:

* radial: it bends without stretching, u_theta = -u_r / n; for n = 0 it breathes, for n = 1 it moves as a rigid ring;
* circumferential: it stretches, u_theta = n u_r; for n = 0 it turns about the axle.

The likeness is the modal assurance criterion with the mass as the metric, so that the values of all modes add up to at
most 1. In each harmonic the mode that is most like a motion gets its name.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .axisymmetric import AxisymmetricBody, HarmonicModes

__all__ = ["name_modes"]

_LEAST_LIKENESS = 0.25
_MOSTLY_AXIAL = 0.5  # share of the kinetic energy above which no mode is the first in-plane one
_HARDLY_AXIAL = 0.25  # share below which a mode is an in-plane one of higher order


def name_modes(body: AxisymmetricBody, modes: HarmonicModes) -> tuple[str, ...]:
    """Name the modes of a harmonic.

    Parameters
    ----------
    body : AxisymmetricBody
    modes : HarmonicModes
        All modes of a harmonic from the lowest on.

    Returns
    -------
    tuple of str
        "n,m,a" with m = 0, 1, ... in the order of frequency, which for discs is the number of nodal circles; "n,r" and
        "n,c", and "n,r2", "n,c2", ... for in-plane modes of higher order. Each name occurs once.
    """
    n = modes.harmonic
    kinetic = body.kinetic_product(modes.shapes, modes.shapes)
    radial, circumferential, axial = (kinetic / kinetic.sum(axis=1, keepdims=True)).T
    ring = {"r": (1.0, -1.0 / n), "c": (1.0, float(n))} if n else {"r": (1.0, 0.0), "c": (0.0, 1.0)}
    names = [""] * len(modes.frequency)
    for letter, motion in ring.items():
        likeness = np.where(axial > _MOSTLY_AXIAL, 0.0, _likeness(body, modes.shapes, motion))
        best = int(np.argmax(likeness)) if len(likeness) else -1
        if best >= 0 and likeness[best] >= _LEAST_LIKENESS and not names[best]:
            names[best] = f"{n},{letter}"
    circles, order = 0, {"r": 1, "c": 1}
    for i, name in enumerate(names):
        if name:
            continue
        if axial[i] >= _HARDLY_AXIAL:
            names[i] = f"{n},{circles},a"
            circles += 1
        else:
            letter = "r" if radial[i] > circumferential[i] else "c"
            order[letter] += 1
            names[i] = f"{n},{letter}{order[letter]}"
    return tuple(names)


def _likeness(body: AxisymmetricBody, shapes: NDArray, motion: tuple[float, float]) -> NDArray:
    """Modal assurance criterion of each mode with an in-plane motion that grows from the hub to the rim, shape (m,)."""
    r = body.points[:, 0]
    growth = ((r - r.min()) / np.ptp(r)) ** 2
    pattern = growth[:, None] * np.array([*motion, 0.0])
    pattern = np.broadcast_to(pattern, shapes.shape)
    return body.kinetic_product(shapes, pattern).sum(axis=1) ** 2 / (
        body.kinetic_product(shapes, shapes).sum(axis=1) * body.kinetic_product(pattern, pattern).sum(axis=1)
    )
