"""The labelled data set of a study: netCDF, the same bytes for the same study."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from wheelrail.errors import WheelrailError
from wheelrail.results import ResultFileError
from wheelrail.results.layout import OUTPUTS
from wheelrail.study.definition import Axis, Study
from wheelrail.study.measures import RUN_FACTS, SQUEAL
from wheelrail.study.point import Outcome
from wheelrail.study.variation import shown_full
from wheelrail.version import __version__

__all__ = ["FORMAT", "check_study_target", "complete_digest", "dataset_of", "write_dataset"]

FORMAT = 1
"""Of the file, in the attribute ``wheelrail_study_format``."""

_MARK, _DIGEST = "wheelrail_study_format", "study_digest"


def check_study_target(path: Path) -> None:
    """Refuse a place where the data set can't be written, before anything is computed.

    Raises
    ------
    ResultFileError
        If the folder is missing or not writable, or something else than a study's data set would be overwritten.
    """
    folder = path.parent
    if not folder.is_dir():
        raise ResultFileError(f"{path}: the folder {folder} does not exist; make it first or choose another --output")
    if not os.access(folder, os.W_OK):
        raise ResultFileError(f"{path}: the folder {folder} is not writable; choose another --output")
    if path.is_dir():
        raise ResultFileError(f"{path}: is a folder; give the name of a file in it")
    if path.exists() and _MARK not in _attributes(path):
        raise ResultFileError(
            f"{path}: is not a data set of wheelrail study; it is not overwritten, choose another --output"
        )


def _attributes(path: Path) -> dict[str, Any]:
    try:
        with xr.open_dataset(path, engine="netcdf4", decode_times=False) as dataset:
            return dict(dataset.attrs)
    except (OSError, RuntimeError, ValueError):
        return {}


def complete_digest(path: Path) -> str | None:
    """Return the hash of the study whose data set is at ``path`` if all its points are there; else None."""
    attributes = _attributes(path) if path.exists() else {}
    return attributes.get(_DIGEST) if attributes.get("failed_points") == 0 else None


def dataset_of(study: Study, load: Callable[[int], Outcome], *, digest: str) -> xr.Dataset:
    """Put the outcomes of all points together.

    Parameters
    ----------
    study : Study
    load : callable
        Gives the outcome of a point by its index; called in the order of the points.
    digest : str
        Hash of what the study depends on.

    Returns
    -------
    xarray.Dataset
        Dimensions are the varied keys of a grid, or ``point``. Numbers of failed points are nan, and so is what is
        beyond the end of a history.

    Raises
    ------
    WheelrailError
        If measures of one's own have another number of dimensions at other points.
    """
    outcomes = [load(point.index) for point in study.points]
    dims = tuple(axis.name for axis in study.axes) if study.grid else ("point",)
    dataset = xr.Dataset(coords=_coordinates(study), attrs=_attributes_of(study, outcomes, digest))
    failed = np.array([bool(outcome.reason) for outcome in outcomes], dtype="i1")
    dataset["status"] = xr.Variable(
        dims,
        failed.reshape(study.shape),
        {"long_name": "what came of the point", "flag_values": np.array([0, 1], "i1"), "flag_meanings": "done failed"},
    )
    for name, long_name in (("reason", "why the point failed"), ("remarks", "warnings of the run")):
        texts = np.array([getattr(outcome, name) for outcome in outcomes], dtype=object).astype(str)
        dataset[name] = xr.Variable(dims, texts.reshape(study.shape), {"long_name": long_name})
    for name in _names(study, outcomes):
        array = _joined(name, [outcome.values.get(name) for outcome in outcomes])
        extra, attributes = _description(name, array.ndim - 1)
        # A measure of one's own may be called like a varied key.
        own = f"measured_{name}" if name in dataset.variables else name
        dataset[own] = xr.Variable((*dims, *extra), array.reshape(*study.shape, *array.shape[1:]), attributes)
    return dataset


def _coordinates(study: Study) -> dict[str, Any]:
    coordinates: dict[str, Any] = {}
    for axis in study.axes:
        attributes: dict[str, Any] = {"key": axis.key, "long_name": axis.description}
        if axis.unit is not None:
            attributes["units"] = axis.unit
        coordinates[axis.name] = xr.Variable(axis.name if study.grid else "point", _labels(axis), attributes)
    if not study.grid:
        numbers = np.arange(1, len(study.points) + 1, dtype="i4")
        coordinates["point"] = xr.Variable("point", numbers, {"long_name": "number of the point"})
    settings = study.results
    if settings.outputs:
        coordinates["statistic"] = xr.Variable("statistic", np.array(settings.statistics))
    if settings.third_octave is not None:
        coordinates["band"] = xr.Variable(
            "band",
            settings.third_octave.centres,
            {"units": "Hz", "long_name": "exact centre frequency of the third-octave band"},
        )
    return coordinates


def _labels(axis: Axis) -> NDArray:
    values = axis.values
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        whole = all(isinstance(value, int) for value in values)
        return np.array(values, dtype="i8" if whole else "f8")
    return np.array([value if isinstance(value, str) else shown_full(value) for value in values])


def _attributes_of(study: Study, outcomes: Iterable[Outcome], digest: str) -> dict[str, Any]:
    return {
        "Conventions": "CF-1.11",
        "title": study.title,
        "source": f"wheelrail {__version__}",
        "wheelrail_version": __version__,
        _MARK: np.int32(FORMAT),
        "case": study.case_text,
        "study": study.text,
        "settling_time": study.results.settle,
        "failed_points": np.int32(sum(bool(outcome.reason) for outcome in outcomes)),
        _DIGEST: digest,
    }


def _names(study: Study, outcomes: Iterable[Outcome]) -> list[str]:
    """Variables in an order that does not depend on which points failed; own measures come last."""
    settings = study.results
    spectra = () if settings.third_octave is None else settings.third_octave.outputs
    known = [
        *RUN_FACTS,
        *settings.outputs,
        *(f"{name}_third_octave" for name in spectra),
        *(f"{name}_history" for name in settings.histories),
        *(SQUEAL if settings.squeal else ()),
    ]
    found = {name for outcome in outcomes for name in outcome.values}
    return [*(name for name in known if name in found), *sorted(found - set(known))]


def _joined(name: str, arrays: list[NDArray | None]) -> NDArray:
    """Stack arrays of shape (...) to (points, ...), filled up with nan to the largest."""
    given = [array for array in arrays if array is not None]
    if len({array.ndim for array in given}) > 1:
        raise WheelrailError(f"measure: {name} has another number of dimensions at other points of the study")
    shape = tuple(np.max([array.shape for array in given], axis=0)) if given[0].ndim else ()
    joined = np.full((len(arrays), *shape), np.nan)
    for place, array in zip(joined, arrays, strict=True) if shape else ():
        if array is not None:
            place[tuple(slice(length) for length in array.shape)] = array
    if not shape:
        joined[:] = [np.nan if array is None else float(array) for array in arrays]
    return joined


def _description(name: str, extra: int) -> tuple[tuple[str, ...], dict[str, str]]:
    """Dimensions beside those of the points, and attributes, of a variable."""
    if name in OUTPUTS:
        unit, long_name = OUTPUTS[name]
        return ("statistic",), {"units": unit, "long_name": long_name}
    for ending, dimension, words in (
        ("_third_octave", "band", "root mean square in the band"),
        ("_history", "step", "at each step, dt apart, from the start"),
    ):
        output = name.removesuffix(ending)
        if output != name and output in OUTPUTS:
            unit, long_name = OUTPUTS[output]
            return (dimension,), {"units": unit, "long_name": f"{long_name}: {words}"}
    for table in (RUN_FACTS, SQUEAL):
        if name in table:
            unit, long_name = table[name]
            return (), {"units": unit, "long_name": long_name}
    return tuple(f"{name}_{number}" for number in range(1, extra + 1)), {"long_name": "measure of one's own"}


def write_dataset(dataset: xr.Dataset, path: Path) -> None:
    """Write a data set; an older file is replaced at the end, at once.

    Raises
    ------
    ResultFileError
        If that fails; an older file is then as it was.
    """
    part = path.with_name(path.name + ".part")
    try:
        dataset.to_netcdf(part, engine="netcdf4", format="NETCDF4")
        os.replace(part, path)
    except (OSError, RuntimeError) as error:
        raise ResultFileError(f"{path}: can't be written: {getattr(error, 'strerror', None) or error}") from error
    finally:
        part.unlink(missing_ok=True)
