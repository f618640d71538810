"""Arrays that take long to compute, kept on disk under a hash of everything they depend on.

Files are written atomically and carry a checksum: an interrupted or damaged one is never used, its content is computed
anew. The folder is the user's cache folder, or what the environment variable WHEELRAIL_CACHE names.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import platformdirs
from numpy.typing import NDArray

from .array_file import ArrayFileError, read_arrays, write_arrays

__all__ = ["CacheEntry", "cache_folder", "clear_cache", "content_key", "list_cache", "recall", "remember"]

_SUFFIX = ".cache"
_SUFFIXES = (_SUFFIX, ".greens")  # with those of earlier versions
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


def content_key(content: Mapping[str, Any]) -> str:
    """Return the hash of a JSON-able description; equal hashes mean equal numbers, as repr of a float is exact."""
    text = json.dumps(content, sort_keys=True)
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()


def _path_of(content: Mapping[str, Any]) -> Path:
    return cache_folder() / f"{content_key(content)}{_SUFFIX}"


def recall(content: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, NDArray]] | None:
    """Look up what is kept.

    Parameters
    ----------
    content : mapping
        JSON-able: everything the arrays depend on, with the version of their algorithm.

    Returns
    -------
    (values, arrays) or None
        As `remember` took them; None also for a damaged file, after a warning.
    """
    try:
        header, arrays, _ = read_arrays(_path_of(content))
        return header["values"], arrays
    except FileNotFoundError:
        return None
    except (ArrayFileError, OSError, ValueError, KeyError, TypeError) as error:
        _log.warning("a cached file is not used and its content computed anew: %s", error)
        return None


def remember(
    content: Mapping[str, Any], *, description: str, values: Mapping[str, Any], arrays: Mapping[str, NDArray]
) -> None:
    """Keep arrays; where that is impossible, there is only a warning.

    Parameters
    ----------
    content : mapping
        As `recall` takes it.
    description : str
        One line for people.
    values : mapping
        JSON-able numbers and names that belong to the arrays.
    arrays : mapping of str to ndarray
    """
    path = _path_of(content)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_arrays(path, {"key": dict(content), "description": description, "values": dict(values)}, arrays)
    except OSError as error:
        _log.warning("what was computed could not be cached: %s", error)


def list_cache() -> list[CacheEntry]:
    """List what the cache holds, sorted by name."""
    entries = []
    for path in sorted(path for suffix in _SUFFIXES for path in cache_folder().glob(f"*{suffix}")):
        try:
            header, _, _ = read_arrays(path)
            text = header["description"]
        except KeyError:
            text = "of an earlier version, not used any more"
        except (ArrayFileError, OSError, ValueError) as error:
            text = f"unusable: {error}"
        entries.append(CacheEntry(path, path.stat().st_size, text))
    return entries


def clear_cache() -> int:
    """Remove every cached file and what interrupted writes left behind; return the number of files."""
    folder, count = cache_folder(), 0
    for pattern in (f"{name}" for suffix in _SUFFIXES for name in (f"*{suffix}", f".*{suffix}.*.part")):
        for path in folder.glob(pattern):
            path.unlink(missing_ok=True)
            count += 1
    return count
