"""The folder beside a result in which finished points are kept until the study is complete."""

from __future__ import annotations

import hashlib
import inspect
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from wheelrail.numerics.array_file import ArrayFileError, read_arrays, write_arrays
from wheelrail.results import ResultFileError
from wheelrail.study.definition import Study
from wheelrail.study.measures import Measure
from wheelrail.study.point import Outcome
from wheelrail.version import __version__

__all__ = ["PointStore", "digest_of", "identity_of", "parts_path"]

_IDENTITY = "study.json"
_MOST_DIFFERENCES = 8
_MISSING = object()


def parts_path(path: Path) -> Path:
    """Where the finished points of a study are kept while its result is not complete."""
    return path.with_name(path.name + ".parts")


def identity_of(study: Study, measure: Measure | None) -> dict[str, Any]:
    """Return all that the numbers of a study depend on, JSON-able.

    Parameters
    ----------
    study : Study
    measure : callable, optional
        A measure of one's own; its own source counts, not that of what it calls.
    """
    return {
        "wheelrail": __version__,
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "case": study.base,
        "combine": "grid" if study.grid else "list",
        "vary": {axis.key: list(axis.values) for axis in study.axes},
        "seed": study.seed,
        "results": study.results.to_dict(),
        "data files": _data_files(study),
        "measure": None if measure is None else _source_of(measure),
    }


def digest_of(identity: Mapping[str, Any]) -> str:
    """Return the hash of an identity."""
    return hashlib.blake2b(json.dumps(identity, sort_keys=True, default=str).encode(), digest_size=16).hexdigest()


def _data_files(study: Study) -> dict[str, str]:
    """Hash of every file that a case names."""
    found: dict[str, str] = {}
    for point in study.points:
        data = point.case.to_dict()
        for name in ("output", "title"):
            data.pop(name, None)
        for text in _texts(data):
            path = point.case.data_path(text)
            if text not in found and _is_file(path):
                found[text] = hashlib.blake2b(path.read_bytes(), digest_size=16).hexdigest()
    return found


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # too long for a name
        return False


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from _texts(item)
    elif isinstance(value, list):
        for item in value:
            yield from _texts(item)


def _source_of(measure: Measure) -> str:
    name = getattr(measure, "__qualname__", type(measure).__qualname__)
    try:
        return f"{name}: {hashlib.blake2b(inspect.getsource(measure).encode(), digest_size=16).hexdigest()}"
    except (OSError, TypeError):  # no function, or typed in
        return name


class PointStore:
    """Finished points on disk, each in a file of its own that appears whole or not at all.

    Parameters
    ----------
    path : Path
        The result of the study.
    identity : mapping
        From `identity_of`.
    """

    def __init__(self, path: Path, identity: Mapping[str, Any]) -> None:
        self.path = path
        self.folder = parts_path(path)
        self.identity = json.loads(json.dumps(identity, default=str))

    @property
    def exists(self) -> bool:
        """Whether there is anything of an earlier run."""
        return (self.folder / _IDENTITY).is_file()

    def begin(self) -> None:
        """Start anew; what an earlier run has left is removed.

        Raises
        ------
        ResultFileError
            If the folder can't be made, or is not one of a study.
        """
        try:
            if self.folder.exists():
                if not self.exists and any(self.folder.iterdir()):
                    raise ResultFileError(f"{self.folder}: is in the way, and not of a study; choose another --output")
                shutil.rmtree(self.folder)
            self.folder.mkdir()
            temporary = self.folder / f"{_IDENTITY}.part"
            temporary.write_text(json.dumps(self.identity), encoding="utf-8")
            os.replace(temporary, self.folder / _IDENTITY)
        except OSError as error:
            raise ResultFileError(f"{self.folder}: can't be made: {error.strerror or error}") from error

    def check_same(self) -> None:
        """Refuse to continue another study.

        Raises
        ------
        ResultFileError
            With the differences.
        """
        try:
            before = json.loads((self.folder / _IDENTITY).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise ResultFileError(f"{self.folder}: can't be read: {error}; run without --resume") from None
        differences = _differences(before, self.identity)
        if differences:
            shown = differences[:_MOST_DIFFERENCES]
            if len(shown) < len(differences):
                shown.append(f"and {len(differences) - len(shown)} more")
            raise ResultFileError(
                f"{self.path}: can't be continued, it belongs to another study; run without --resume or choose another "
                "--output\n" + "\n".join(f"  - {line}" for line in shown)
            )

    def keep(self, outcome: Outcome) -> None:
        """Store a point.

        Raises
        ------
        ResultFileError
            If there is no room, for example.
        """
        scalars = [name for name, array in outcome.values.items() if not array.ndim]  # the file knows arrays only
        header = {"index": outcome.index, "reason": outcome.reason, "remarks": outcome.remarks, "scalars": scalars}
        try:
            write_arrays(self._file(outcome.index), header, outcome.values)
        except OSError as error:
            raise ResultFileError(f"{self.folder}: can't be written to: {error.strerror or error}") from error

    def load(self, index: int) -> Outcome | None:
        """Read a point; None if it is not there or damaged."""
        try:
            header, arrays, _ = read_arrays(self._file(index))
        except (ArrayFileError, OSError):
            return None
        values = {name: array.reshape(()) if name in header["scalars"] else array for name, array in arrays.items()}
        return Outcome(header["index"], header["reason"], header["remarks"], values)

    def remove(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _file(self, index: int) -> Path:
        return self.folder / f"point-{index:06d}.point"


def _differences(before: Any, now: Any, place: str = "") -> list[str]:
    if isinstance(before, dict) and isinstance(now, dict):
        return [
            line
            for key in dict.fromkeys((*before, *now))
            for line in _differences(before.get(key, _MISSING), now.get(key, _MISSING), f"{place}: {key}".lstrip(": "))
        ]
    if isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        return [
            line
            for number, (old, new) in enumerate(zip(before, now, strict=True), 1)
            for line in _differences(old, new, f"{place} #{number}")
        ]
    return [] if before == now else [f"{place}: {_shown(before)} before, {_shown(now)} now"]


def _shown(value: Any) -> str:
    if value is _MISSING or value is None:
        return "left out"
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
