"""Cache of moving Green's functions on disk, keyed by everything they depend on.

Files are written atomically and carry a checksum: an interrupted or damaged one is never used, it is computed anew.
The folder is the user's cache folder, or what the environment variable WHEELRAIL_CACHE names.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import platformdirs
from threadpoolctl import threadpool_limits

from ..numerics.array_file import ArrayFileError, read_arrays, write_arrays
from .moving import ENERGY_TOLERANCE, LONGEST_HORIZON, MARGIN_BAYS, MovingGreens, PeriodicTrack, compute_moving_greens

__all__ = ["CacheEntry", "cache_folder", "cached_moving_greens", "clear_cache", "find_cached", "list_cache"]

ALGORITHM = 2  # raised whenever the same input gives other numbers
_SUFFIX = ".greens"
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class CacheEntry:
    """One cached file.

    Attributes
    ----------
    path : Path
    size : int
        Bytes.
    description : str
        What it holds, or what is wrong with it.
    """

    path: Path
    size: int
    description: str


def cache_folder() -> Path:
    """Folder of the cache; it need not exist."""
    named = os.environ.get("WHEELRAIL_CACHE")
    return Path(named) if named else Path(platformdirs.user_cache_dir("wheelrail", appauthor=False))


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
    # repr of a float is exact, so equal keys mean equal numbers.
    text = json.dumps(content, sort_keys=True)
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest(), content


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
    key, _ = _key(track, {"speed": speed, "dx": dx, "memory": memory})
    try:
        header, arrays, _ = read_arrays(cache_folder() / f"{key}{_SUFFIX}")
        return MovingGreens(**arrays, **header["scalars"])
    except FileNotFoundError:
        return None
    except (ArrayFileError, OSError, ValueError, KeyError, TypeError) as error:
        _log.warning("cached Green's functions are not used and computed anew: %s", error)
        return None


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
    found = find_cached(track, speed=speed, dx=dx, memory=memory)
    if found is not None:
        return found
    key, content = _key(track, {"speed": speed, "dx": dx, "memory": memory})
    path = cache_folder() / f"{key}{_SUFFIX}"
    # One thread: its products are too small for more, and the numbers must not depend on the machine's cores.
    with threadpool_limits(1):
        greens = compute_moving_greens(track, speed=speed, dx=dx, memory=memory, progress=progress)
    scalars = {"dx": greens.dx, "dt": greens.dt, "horizon": greens.horizon}
    arrays = {
        "values": greens.values,
        "neglected_energy": greens.neglected_energy,
        "neglected_compliance": greens.neglected_compliance,
    }
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_arrays(path, {"key": content, "scalars": scalars}, arrays)
    except OSError as error:
        _log.warning("the Green's functions could not be cached: %s", error)
    return greens


def list_cache() -> list[CacheEntry]:
    """List what the cache holds, sorted by name."""
    entries = []
    for path in sorted(cache_folder().glob(f"*{_SUFFIX}")):
        try:
            header, arrays, _ = read_arrays(path)
            positions, samples = arrays["values"].shape
            key, dt = header["key"], header["scalars"]["dt"]
            text = (
                f"{key['track']['kind']}, {key['speed'] * 3.6:.4g} km/h, dx {key['dx'] * 1e3:g} mm: "
                f"{positions} functions of {samples} samples ({samples * dt:.3g} s)"
            )
        except (ArrayFileError, OSError, KeyError, ValueError) as error:
            text = f"unusable: {error}"
        entries.append(CacheEntry(path, path.stat().st_size, text))
    return entries


def clear_cache() -> int:
    """Remove every cached file and what interrupted writes left behind; return the number of files."""
    folder, count = cache_folder(), 0
    for pattern in (f"*{_SUFFIX}", f".*{_SUFFIX}.*.part"):
        for path in folder.glob(pattern):
            path.unlink(missing_ok=True)
            count += 1
    return count
