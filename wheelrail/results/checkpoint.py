"""What a result file keeps for the continuation of its run, and whether the case is still the same."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wheelrail.interaction.simulate import Statistics
from wheelrail.results.layout import STATE
from wheelrail.results.reading import ResultFileError, open_result

__all__ = ["Checkpoint", "case_differences", "read_checkpoint"]


@dataclass(frozen=True)
class Checkpoint:
    """Where a run ended.

    Attributes
    ----------
    path : Path
    case : dict
        The case in the layout of its file.
    samples : int
        Rows in the file: one more than the steps.
    complete : bool
        The run got as far as its case says.
    state : bytes
        As `wheelrail.interaction.state.State.to_bytes` gives it.
    statistics : Statistics
    fingerprint : str
        Of the model, see `wheelrail.interaction.model.Model.fingerprint`.
    version : str
        Of the program that wrote it.
    """

    path: Path
    case: dict[str, Any]
    samples: int
    complete: bool
    state: bytes
    statistics: Statistics
    fingerprint: str
    version: str


def read_checkpoint(path: str | os.PathLike[str]) -> Checkpoint:
    """Read what is needed to continue a run.

    Raises
    ------
    ResultFileError
        If the file is missing, foreign or damaged.
    """
    path = Path(path)
    if not path.exists():
        raise ResultFileError(f"{path}: there is no such file to continue; run without --resume")
    with open_result(path) as dataset:
        try:
            return Checkpoint(
                path=path,
                case=tomllib.loads(dataset.attrs["case"]),
                samples=dataset.sizes["time"],
                complete=bool(dataset.attrs["complete"]),
                state=dataset[STATE].values.tobytes(),
                statistics=Statistics(**json.loads(dataset.attrs["statistics"])),
                fingerprint=dataset.attrs["model_fingerprint"],
                version=dataset.attrs["wheelrail_version"],
            )
        except (KeyError, TypeError, ValueError) as error:
            raise ResultFileError(f"{path}: can't be continued, {error} is missing or damaged") from error


def case_differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """List the keys in which two cases differ, one line each.

    How long the run is and where it is written does not matter: a run may be made longer when it is continued.
    """
    flat_before, flat_now = _flat(before), _flat(now)
    lines = []
    for key in dict.fromkeys((*flat_before, *flat_now)):
        if key in ("simulation.duration", "output.file"):
            continue
        old, new = flat_before.get(key, "left out"), flat_now.get(key, "left out")
        if old != new:
            lines.append(f"{key}: {old} in the file, {new} in the case")
    return lines


def _flat(value: Any, prefix: str = "") -> dict[str, Any]:
    if isinstance(value, Mapping):
        pairs = [(f"{prefix}.{key}" if prefix else str(key), item) for key, item in value.items()]
    elif isinstance(value, list | tuple) and any(isinstance(item, Mapping) for item in value):
        pairs = [(f"{prefix} #{number}", item) for number, item in enumerate(value, 1)]
    else:
        return {prefix: value}
    return {key: leaf for name, item in pairs for key, leaf in _flat(item, name).items()}
