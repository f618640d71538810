"""Profiles of wheels and rails that have a name.

Wheels
------
s1002
    EN 13715 (UIC 510-2), flange 28 mm high and 32.5 mm thick: polynomials, lines and arcs in the zones A to H. Where
    zones meet, the printed coefficients leave steps in height of 0.12 um at most.
cone
    A straight tread of given slope; no flange.
cylinder
    A tread without slope; no flange.

Rails
-----
60e1
    The head of EN 13674-1: arcs of 300, 80 and 13 mm.
bv50-like
    A stand-in for the Swedish BV50, whose drawing isn't at hand: a head of 70 mm, as wide as BV50's, with a crown of
    300 mm that goes on in arcs of 80 and 13 mm as on 60E1.
circular
    One arc of given radius.

A head ends where its side begins; that of 60E1 has a slope of 1:20 there.
"""

from __future__ import annotations

import math

from ..errors import ParameterError
from .curve import Piece, ProfileCurve

__all__ = ["NAMED_RAIL_PROFILES", "NAMED_WHEEL_PROFILES", "named_rail_profile", "named_wheel_profile"]

NAMED_WHEEL_PROFILES = ("s1002", "cone", "cylinder")
NAMED_RAIL_PROFILES = ("60e1", "bv50-like", "circular")

_MM = 1e-3
_TREAD = 70.0  # mm, half the width of the wheels without a flange
_HALF_HEAD = 36.0  # mm, of a circular rail
_STEEPEST = math.radians(80.0)  # end of a circular rail so narrow that its arc stands upright

# Zones of S1002 from the flange's back to the tread's end: end of the zone in mm, then the polynomial's coefficients in
# mm, or centre, depth of the centre, radius and bulge of an arc in mm.
_S1002_START = -70.0
_S1002: tuple[tuple[float, tuple[float, ...], tuple[float, float, int] | None], ...] = (
    (-62.764705882, (9.519259302,), (-49.5, 20.5, 1)),  # H
    (-49.662510381, (16.0,), (-55.0, 12.0, 1)),  # G
    (-39.764473993, (8.834924130,), (-58.558326413, 20.0, 1)),  # F
    (-38.426669071, (-93.576667419, -2.747477419), None),  # E
    (-35.0, (16.446,), (-26.210665, 13.0, -1)),  # D
    (
        -26.0,  # C
        (
            -4320.221063,
            -1038.384026,
            -106.5501873,
            -6.051367875,
            -0.2054332446,
            -0.004169739389,
            -4.687195829e-05,
            -2.25275554e-07,
        ),
        None,
    ),
    (
        32.15796,  # B
        (
            0.0,
            -0.03358537058,
            0.001565681624,
            -2.810427944e-05,
            5.844240864e-08,
            -1.562379023e-08,
            5.309217349e-15,
            -5.957839843e-12,
            2.646656573e-13,
        ),
        None,
    ),
    (60.0, (1.364323640, -0.066666667), None),  # A
)

# Arcs of a head from its middle to its side: end, centre's lateral position and depth, radius; mm.
_60E1 = (
    (10.2280204, 0.0, 300.0, 300.0),
    (26.026723, 7.5005483, 172.0 - 91.8721032, 80.0),
    (36.0, 23.0162196, 172.0 - 157.050811, 13.0),
)


def named_wheel_profile(name: str, *, conicity: float | None = None) -> ProfileCurve:
    """Return a wheel profile, one of `NAMED_WHEEL_PROFILES`.

    Parameters
    ----------
    name : str
        Without regard to case.
    conicity : float, optional
        Slope of the cone, by which its radius falls to the field side; only for "cone", from 0 to 1.

    Returns
    -------
    ProfileCurve
        Radius beyond that at the tape circle, m, over the position from the tape circle, m, + to the field side.

    Raises
    ------
    ParameterError
        Unknown name, or a conicity that is missing, not needed or not allowed.
    """
    known = name.lower()
    if known not in NAMED_WHEEL_PROFILES:
        raise ParameterError("wheel_profile", name, f"allowed: {', '.join(NAMED_WHEEL_PROFILES)}")
    if known != "cone" and conicity is not None:
        raise ParameterError("conicity", conicity, 'only the wheel profile "cone" has one')
    if known == "s1002":
        return _s1002()
    slope = 0.0
    if known == "cone":
        if conicity is None or not 0.0 <= conicity <= 1.0:
            raise ParameterError("conicity", conicity, 'the wheel profile "cone" needs one from 0 to 1')
        slope = conicity
    return ProfileCurve.from_pieces(known, [Piece(-_MM * _TREAD, _MM * _TREAD, (0.0, -slope))])


def named_rail_profile(name: str, *, radius: float | None = None) -> ProfileCurve:
    """Return the profile of a rail's head, one of `NAMED_RAIL_PROFILES`.

    Parameters
    ----------
    name : str
        Without regard to case.
    radius : float, optional
        Of the circular head, m; only for "circular".

    Returns
    -------
    ProfileCurve
        Depth below the middle of the running surface, m, over the position from the rail's axis, m.

    Raises
    ------
    ParameterError
        Unknown name, or a radius that is missing, not needed or not positive.
    """
    known = name.lower()
    if known not in NAMED_RAIL_PROFILES:
        raise ParameterError("rail_profile", name, f"allowed: {', '.join(NAMED_RAIL_PROFILES)}")
    if known != "circular":
        if radius is not None:
            raise ParameterError("rail_radius", radius, 'only the rail profile "circular" needs one')
        return _head(known, _60E1 if known == "60e1" else _crowned_head(10.0, 35.0, (300.0, 80.0, 13.0)))
    if radius is None or not (math.isfinite(radius) and radius > 0.0):
        raise ParameterError("rail_radius", radius, 'the rail profile "circular" needs one above 0 m')
    millimetres = radius / _MM
    half = min(_HALF_HEAD, millimetres * math.sin(_STEEPEST))
    return _head(known, ((half, 0.0, millimetres, millimetres),))


def _s1002() -> ProfileCurve:
    pieces, start = [], _S1002_START
    for end, coefficients, arc in _S1002:
        # A coefficient of mm^(1 - k) in m^(1 - k).
        metres = tuple(value * _MM ** (1 - k) for k, value in enumerate(coefficients))
        centre, radius, bulge = (0.0, 1.0, 0) if arc is None else (_MM * arc[0], _MM * arc[1], arc[2])
        pieces.append(Piece(_MM * start, _MM * end, metres, 0.0, centre, radius, bulge))
        start = end
    return ProfileCurve.from_pieces("s1002", pieces)


def _crowned_head(crown: float, half_width: float, radii: tuple[float, float, float]) -> tuple:
    """Arcs of three radii that pass into each other without a bend, the last down to the slope 1:20; mm.

    Parameters
    ----------
    crown : float
        Half the width of the first arc.
    half_width : float
        Where the last arc would stand upright.
    """
    top, shoulder, corner = radii
    first = crown / top  # sine of the slope where the arcs meet
    second = (half_width - corner - (top - shoulder) * first) / (shoulder - corner)
    y_shoulder, z_shoulder = (top - shoulder) * first, top - (top - shoulder) * math.sqrt(1.0 - first**2)
    y_corner = y_shoulder + (shoulder - corner) * second
    z_corner = z_shoulder - (shoulder - corner) * math.sqrt(1.0 - second**2)
    side = math.sin(math.atan(20.0))
    return (
        (crown, 0.0, top, top),
        (y_shoulder + shoulder * second, y_shoulder, z_shoulder, shoulder),
        (y_corner + corner * side, y_corner, z_corner, corner),
    )


def _head(name: str, arcs: tuple) -> ProfileCurve:
    """Both halves of a head from the arcs of the right one."""
    right, start = [], 0.0
    for end, centre, depth, radius in arcs:
        right.append(Piece(_MM * start, _MM * end, (_MM * depth,), 0.0, _MM * centre, _MM * radius, -1))
        start = end
    left = [piece._replace(start=-piece.end, end=-piece.start, centre=-piece.centre) for piece in reversed(right)]
    left[-1] = left[-1]._replace(end=0.0)  # not -0.0
    return ProfileCurve.from_pieces(name, [*left, *right])
