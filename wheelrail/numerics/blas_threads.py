"""One thread for BLAS around small solves, with numpy and the standard library alone.

Threads that wait for each other make a solve of some hundred equations slower, at times a hundredfold, and a host that
runs several instances has better use for its cores.
"""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import numpy as np

__all__ = ["one_thread"]

_PREFIXES = ("scipy_openblas", "openblas")
_SUFFIXES = ("64_", "")


@cache
def _openblas() -> tuple[Callable[[], int], Callable[[int], None]] | None:
    """Functions of numpy's OpenBLAS that get and set its number of threads; None if numpy uses something else."""
    for path in _candidates():
        try:
            library = ctypes.CDLL(path)
        except OSError:
            continue
        for prefix in _PREFIXES:
            for suffix in _SUFFIXES:
                try:
                    get = getattr(library, f"{prefix}_get_num_threads{suffix}")
                    put = getattr(library, f"{prefix}_set_num_threads{suffix}")
                except AttributeError:
                    continue
                get.argtypes, get.restype = [], ctypes.c_int
                put.argtypes, put.restype = [ctypes.c_int], None
                return get, put
    return None


def _candidates() -> list[str]:
    """Library files that may be numpy's OpenBLAS: what is loaded, else what lies beside numpy."""
    if sys.platform.startswith("linux"):
        try:
            lines = Path("/proc/self/maps").read_text().splitlines()
        except OSError:
            lines = []
        loaded = {line.split(maxsplit=5)[-1] for line in lines if "openblas" in line}
        if loaded:
            # Another package may have brought its own; numpy's lies in its folder.
            return sorted(loaded, key=lambda path: "numpy" not in path)
    folder = Path(np.__file__).parent
    places = [folder.parent / "numpy.libs", folder / ".dylibs"]
    return [str(path) for place in places if place.is_dir() for path in place.iterdir() if "openblas" in path.name]


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit numpy's BLAS to one thread; nothing is done where it can't be limited, or was limited from outside."""
    functions = None if os.environ.get("WHEELRAIL_BLAS_THREADS") == "keep" else _openblas()
    if functions is None:
        yield
        return
    get, put = functions
    before = get()
    if before == 1:
        yield
        return
    put(1)
    try:
        yield
    finally:
        put(before)
