"""Creep-force curves: forces of steady rolling over creepages, by the exact theory and by the simpler laws."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from wheelrail.contact.creep.fastsim import fastsim
from wheelrail.contact.creep.kalker_coefficients import kalker_coefficients
from wheelrail.contact.creep.linear import linear_creep_force
from wheelrail.contact.creep.shen_hedrick_elkins import shen_hedrick_elkins
from wheelrail.contact.creep.vermeulen_johnson import vermeulen_johnson
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalState
from wheelrail.contact.rolling import steady_rolling
from wheelrail.errors import ContactGridError, ParameterError

__all__ = ["LAWS", "creep_force_curves"]

EXACT = "exact"
LAWS = {
    EXACT: "exact theory: steady rolling on the grid of elements (Kalker 1990)",
    "fastsim": "FASTSIM (Kalker 1982)",
    "shen-hedrick-elkins": "Shen, Hedrick and Elkins (1983)",
    "vermeulen-johnson": "Vermeulen and Johnson (1964) with Kalker's coefficients; without spin",
    "linear": "Kalker's linear theory (1967)",
}
"""Names and sources of the laws."""

_SIMPLER = {
    "fastsim": fastsim,
    "shen-hedrick-elkins": shen_hedrick_elkins,
    "vermeulen-johnson": vermeulen_johnson,
    "linear": linear_creep_force,
}
_CREEPAGES = {
    "creepage_x": ("1", "longitudinal creepage"),
    "creepage_y": ("1", "lateral creepage"),
    "creepage_spin": ("m-1", "spin creepage"),
}
_FORCES = {
    "force_x": ("N", "longitudinal force on the rail"),
    "force_y": ("N", "lateral force on the rail"),
    "moment_spin": ("N m", "spin moment on the rail"),
}
_OF_EXACT = {
    "slip_fraction": ("1", "slipping share of the contact area, exact theory"),
    "residual": ("1", "relative residual of the steady equations, exact theory"),
}


def creep_force_curves(
    *,
    half_space: HalfSpace,
    normal: NormalState,
    friction: float,
    creepage_x: ArrayLike,
    creepage_y: ArrayLike,
    creepage_spin: ArrayLike,
    semi_axis_x: float | None,
    semi_axis_y: float | None,
    laws: Sequence[str] = tuple(LAWS),
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Compute forces and spin moment for every combination of creepages.

    Parameters
    ----------
    half_space : HalfSpace
    normal : NormalState
        Normal contact, of any shape.
    friction : float
        Coefficient mu.
    creepage_x, creepage_y : array_like, shape (n,) or ()
        Rail relative to wheel over the speed, between -1 and 1, no value twice.
    creepage_spin : array_like, shape (n,) or ()
        1/m.
    semi_axis_x, semi_axis_y : float or None
        Of the contact ellipse in rolling and in lateral direction, m, for the simpler laws; None: the exact theory
        only.
    laws : sequence of str
        Keys of `LAWS`.
    progress : callable, optional
        Called with the share of the work done.

    Returns
    -------
    xarray.Dataset
        ``force_x``, ``force_y`` (N) and ``moment_spin`` (N m) over law, creepage_x, creepage_y and creepage_spin; with
        the exact theory also ``slip_fraction`` and ``residual`` over the creepages; ``normal_force`` (N) and
        ``friction_coefficient``. NaN where a law does not apply:
        Vermeulen and Johnson with spin.

    Raises
    ------
    ParameterError
        For creepages that are no numbers, out of range, given twice or not in a line; for unknown laws; for friction
        or semi-axes that are not positive, missing, or outside Kalker's table; without contact.
    ContactGridError
        If the contact reaches the edge of the grid.
    """
    axes = {
        "creepage_x": _axis("creepage_x", creepage_x, limit=1.0),
        "creepage_y": _axis("creepage_y", creepage_y, limit=1.0),
        "creepage_spin": _axis("creepage_spin", creepage_spin, limit=None),
    }
    if not (np.isfinite(friction) and friction > 0.0):
        raise ParameterError("friction", friction, "the friction coefficient must be positive and finite")
    _check_contact(half_space, normal)
    laws = _check_laws(laws, half_space, semi_axis_x, semi_axis_y)

    shape = tuple(len(values) for values in axes.values())
    forces = {name: np.full((len(laws), *shape), np.nan) for name in _FORCES}
    extra = {name: np.full(shape, np.nan) for name in _OF_EXACT}
    physics: dict[str, Any] = {
        "semi_axis_x": semi_axis_x,
        "semi_axis_y": semi_axis_y,
        "load": normal.force,
        "friction_coefficient": friction,
        "shear_modulus": half_space.shear_modulus,
        "poisson_ratio": half_space.poisson_ratio,
    }
    for done, at in enumerate(np.ndindex(shape), start=1):
        xi, eta, phi = (float(values[i]) for values, i in zip(axes.values(), at, strict=True))
        for n, law in enumerate(laws):
            if law == EXACT:
                result = steady_rolling(
                    half_space, normal, friction=friction, creepage_x=xi, creepage_y=eta, creepage_spin=phi
                )
                for name in _OF_EXACT:
                    extra[name][at] = getattr(result, name)
            elif (result := _simpler(law, xi, eta, phi, physics)) is None:
                continue
            for name, values in forces.items():
                values[(n, *at)] = getattr(result, name)
        if progress is not None:
            progress(done / int(np.prod(shape)))
    return _dataset(axes, laws, forces, extra, half_space, physics)


def _axis(name: str, values: ArrayLike, *, limit: float | None) -> NDArray:
    unit = " in 1/m" if name == "creepage_spin" else ""
    allowed = f"must be a number{unit}, or a line of them" + (f", between -{limit:g} and {limit:g}" if limit else "")
    try:
        line = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(name, values, allowed) from None
    if line.ndim > 1 or line.size == 0:
        raise ParameterError(name, values, f"{allowed}; this has the shape {line.shape}")
    line = np.atleast_1d(line)
    wrong = ~np.isfinite(line) if limit is None else ~(np.abs(line) < limit)
    if wrong.any():
        first = int(np.argmax(wrong))
        raise ParameterError(f"{name}[{first}]" if line.size > 1 else name, float(line[first]), allowed)
    seen, counts = np.unique(line, return_counts=True)
    if seen.size < line.size:
        raise ParameterError(name, float(seen[np.argmax(counts > 1)]), "given more than once")
    return line


def _check_contact(half_space: HalfSpace, normal: NormalState) -> None:
    if len(normal.pressure) != half_space.elements:
        raise ParameterError(
            "normal", f"{len(normal.pressure)} elements", f"the half-space has {half_space.elements} elements"
        )
    if len(normal.contact) == 0:
        raise ParameterError("normal", "no contact", "creep forces need a load")
    if half_space.edge[normal.contact].any():
        raise ContactGridError(
            f"the contact reaches the edge of the grid, {half_space.mx * half_space.dx:g} m long and "
            f"{half_space.my * half_space.dy:g} m wide; take more elements"
        )


def _check_laws(
    laws: Sequence[str], half_space: HalfSpace, semi_axis_x: float | None, semi_axis_y: float | None
) -> tuple[str, ...]:
    laws = (laws,) if isinstance(laws, str) else tuple(laws)
    for law in laws:
        if law not in LAWS or laws.count(law) > 1:
            raise ParameterError("laws", law, f"allowed, each once: {', '.join(LAWS)}")
    if not laws:
        raise ParameterError("laws", laws, f"name one of {', '.join(LAWS)}")
    if all(law == EXACT for law in laws):
        return laws
    for name, value in (("semi_axis_x", semi_axis_x), ("semi_axis_y", semi_axis_y)):
        if value is None:
            raise ParameterError(name, value, f"only laws = ({EXACT!r},) does without the contact ellipse")
    assert semi_axis_x is not None
    assert semi_axis_y is not None
    try:
        kalker_coefficients(semi_axis_x=semi_axis_x, semi_axis_y=semi_axis_y, poisson_ratio=half_space.poisson_ratio)
    except ValueError as error:
        raise ParameterError("semi_axis_x, semi_axis_y", (semi_axis_x, semi_axis_y), str(error)) from error
    return laws


def _simpler(law: str, xi: float, eta: float, phi: float, physics: dict[str, Any]) -> Any:
    arguments = {"creepage_x": xi, "creepage_y": eta, "spin": phi, **physics}
    if law == "vermeulen-johnson":
        if phi != 0.0:
            return None
        del arguments["spin"]
    if law == "linear":
        del arguments["load"], arguments["friction_coefficient"]
    return _SIMPLER[law](**arguments)


def _dataset(
    axes: dict[str, NDArray],
    laws: tuple[str, ...],
    forces: dict[str, NDArray],
    extra: dict[str, NDArray],
    half_space: HalfSpace,
    physics: dict[str, Any],
) -> xr.Dataset:
    def described(of: tuple[str, str]) -> dict[str, str]:
        return {"units": of[0], "long_name": of[1]}

    data: dict[str, Any] = {name: (("law", *axes), values, described(_FORCES[name])) for name, values in forces.items()}
    if EXACT in laws:
        data |= {name: (tuple(axes), values, described(_OF_EXACT[name])) for name, values in extra.items()}
    data["normal_force"] = ((), physics["load"], {"units": "N"})
    data["friction_coefficient"] = ((), physics["friction_coefficient"], {"units": "1"})
    coordinates: dict[str, Any] = {name: (name, axes[name], described(_CREEPAGES[name])) for name in axes}
    coordinates["law"] = ("law", list(laws), {"long_name": "; ".join(f"{law}: {LAWS[law]}" for law in laws)})
    grid = {name: getattr(half_space, name) for name in ("mx", "my", "dx", "dy")}
    given = {
        name: value
        for name, value in physics.items()
        if value is not None and name not in ("load", "friction_coefficient")
    }
    attributes = {
        "title": "Creep forces of steady rolling",
        "comment": "Creepage is the velocity of the rail's surface relative to the wheel's over the speed; forces are "
        "those on the rail. Lengths of the grid and the ellipse in m, shear modulus in Pa.",
        **grid,
        **given,
    }
    return xr.Dataset(data, coords=coordinates, attrs=attributes)
