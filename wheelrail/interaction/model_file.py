"""A model in one file, read with numpy alone: what an FMU carries."""

from __future__ import annotations

import os
from dataclasses import asdict
from typing import Any

from numpy.typing import NDArray

from ..contact.parts import contact_from_parts, tangential_model
from ..errors import ModelFileError
from ..excitation.sources import source_from_parts
from ..greens.parts import response_from_parts, response_to_parts
from ..greens.protocol import WheelResponse
from ..greens.track_response import TrackResponse
from ..numerics.array_file import ArrayFileError, read_arrays, write_arrays
from .geometry_parts import geometry_from_parts
from .inputs import Inputs
from .model import Model
from .parameters import Parameters

__all__ = ["FORMAT", "load_model", "save_model"]

FORMAT = 3


def save_model(model: Model, path: str | os.PathLike[str]) -> None:
    """Write a model; the same model gives the same bytes.

    Parameters
    ----------
    model : Model
    path : path-like
        Replaced atomically.
    """
    arrays: dict[str, NDArray] = {}
    header: dict[str, Any] = {
        "format": FORMAT,
        "title": model.title,
        "case": model.case,
        "dx": model.dx,
        "parameters": model.parameters.to_dict(),
        "start_inputs": asdict(model.start_inputs),
        "report": model.report,
    }
    for name in ("wheel", "held_wheel"):
        response: WheelResponse | None = getattr(model, name)
        header[name] = None
        if response is not None:
            header[name], parts = response_to_parts(response)
            arrays |= {f"{name}.{part}": array for part, array in parts.items()}
    header["track"] = model.track is not None
    if model.track is not None:
        arrays["track"] = model.track.values
    header["geometry"], geometry_arrays = model.geometry.to_parts()
    arrays |= {f"geometry.{name}": array for name, array in geometry_arrays.items()}
    header["contact"], contact_arrays = model.contact.to_parts()
    arrays |= {f"contact.{name}": array for name, array in contact_arrays.items()}
    header["tangential"] = {"kind": "none"} if model.tangential is None else model.tangential.to_parts()
    header["sources"] = []
    for number, source in enumerate(model.sources):
        meta, parts = source.to_parts()
        header["sources"].append({"meta": meta, "arrays": sorted(parts)})
        arrays |= {f"source{number}.{name}": array for name, array in parts.items()}
    write_arrays(path, header, arrays)


def load_model(path: str | os.PathLike[str]) -> Model:
    """Read a model.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged or of another format.
    """
    try:
        header, arrays, _ = read_arrays(path)
    except (ArrayFileError, OSError) as error:
        raise ModelFileError(f"the model file can't be read: {error}") from error
    if header.get("format") != FORMAT:
        raise ModelFileError(f"{path}: format {header.get('format')!r}, this version reads format {FORMAT}")
    wheels: dict[str, WheelResponse | None] = {}
    for name in ("wheel", "held_wheel"):
        meta, prefix = header[name], f"{name}."
        parts = {key.removeprefix(prefix): array for key, array in arrays.items() if key.startswith(prefix)}
        wheels[name] = None if meta is None else response_from_parts(meta, parts)
    sources = []
    for number, entry in enumerate(header["sources"]):
        parts = {name: arrays[f"source{number}.{name}"] for name in entry["arrays"]}
        sources.append(source_from_parts(entry["meta"], parts))
    prefix = "geometry."
    geometry_arrays = {name.removeprefix(prefix): array for name, array in arrays.items() if name.startswith(prefix)}
    contact_arrays = {name[8:]: array for name, array in arrays.items() if name.startswith("contact.")}
    contact = contact_from_parts(header["contact"], contact_arrays)
    return Model(
        title=header["title"],
        case=header["case"],
        dx=header["dx"],
        parameters=Parameters(**header["parameters"]),
        start_inputs=Inputs(**header["start_inputs"]),
        wheel=wheels["wheel"],
        held_wheel=wheels["held_wheel"],
        track=TrackResponse(arrays["track"]) if header["track"] else None,
        geometry=geometry_from_parts(header["geometry"], geometry_arrays),
        contact=contact,
        tangential=tangential_model(header["tangential"], contact),
        sources=tuple(sources),
        report=header["report"],
    )
