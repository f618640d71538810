"""Moving Green's functions from the cache on disk, keyed by everything they depend on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ..numerics.disk_cache import CacheEntry, cache_folder, clear_cache, content_key, list_cache, recall, remember
from .moving import ENERGY_TOLERANCE, LONGEST_HORIZON, MARGIN_BAYS, MovingGreens, PeriodicTrack, compute_moving_greens

__all__ = [
    "CacheEntry",
    "cache_folder",
    "cached_greens",
    "cached_moving_greens",
    "clear_cache",
    "find_cached",
    "find_greens",
    "list_cache",
]

ALGORITHM = 2  # raised whenever the same input gives other numbers


def _key(track: PeriodicTrack, settings: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    parameters = {k: v for k, v in asdict(track).items() if not k.startswith("_")}  # type: ignore[call-overload]
    content = {
        "algorithm": ALGORITHM,
        "track": {"kind": type(track).__name__, **parameters},
        **settings,
        "energy_tolerance": ENERGY_TOLERANCE,
        "longest_horizon": LONGEST_HORIZON,
        "margin_bays": MARGIN_BAYS,
    }
    return content_key(content), content


def find_cached(track: PeriodicTrack, *, speed: float, dx: float, memory: float | None = None) -> MovingGreens | None:
    """Look up moving Green's functions in the cache, without computing anything.

    Parameters
    ----------
    track, speed, dx, memory
        As `cached_moving_greens` takes them.

    Returns
    -------
    MovingGreens or None
        None also for a damaged file, after a warning.
    """
    return find_greens(_key(track, {"speed": speed, "dx": dx, "memory": memory})[1])


def find_greens(content: Mapping[str, Any]) -> MovingGreens | None:
    """Look up moving Green's functions by all they depend on (JSON-able)."""
    found = recall(content)
    if found is None:
        return None
    values, arrays = found
    return MovingGreens(**arrays, **values)


def cached_greens(content: Mapping[str, Any], compute: Callable[[], MovingGreens], *, description: str) -> MovingGreens:
    """Get moving Green's functions from the cache, or compute and store them there.

    Parameters
    ----------
    content : mapping
        JSON-able: everything they depend on, with the version of their algorithm.
    compute : callable
        Computes them.
    description : str
        Of track, speed and grid, for people.

    Returns
    -------
    MovingGreens
    """
    found = find_greens(content)
    if found is not None:
        return found
    # One thread: the products are too small for more, and the numbers must not depend on the machine's cores.
    with threadpool_limits(1):
        greens = compute()
    shape = greens.values.shape
    remember(
        content,
        description=f"{description}: {int(np.prod(shape[:-1]))} functions of {shape[-1]} samples "
        f"({shape[-1] * greens.dt:.3g} s)",
        values={"dx": greens.dx, "dt": greens.dt, "horizon": greens.horizon},
        arrays={
            "values": greens.values,
            "neglected_energy": greens.neglected_energy,
            "neglected_compliance": greens.neglected_compliance,
        },
    )
    return greens


def cached_moving_greens(
    track: PeriodicTrack,
    *,
    speed: float,
    dx: float,
    memory: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> MovingGreens:
    """Get moving Green's functions from the cache, or compute and store them there.

    Parameters
    ----------
    track : PeriodicTrack
        A dataclass of plain numbers.
    speed, dx, memory, progress
        As `wheelrail.greens.moving.compute_moving_greens` takes them.

    Returns
    -------
    MovingGreens
    """
    return cached_greens(
        _key(track, {"speed": speed, "dx": dx, "memory": memory})[1],
        lambda: compute_moving_greens(track, speed=speed, dx=dx, memory=memory, progress=progress),
        description=f"{type(track).__name__}, {speed * 3.6:.4g} km/h, dx {dx * 1e3:g} mm",
    )
