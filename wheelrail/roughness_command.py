"""The command ``wheelrail roughness``: levels of a measured roughness, compared with a limit."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from wheelrail.analysis.coherence import BandCoherence, roughness_coherence
from wheelrail.analysis.roughness_evaluation import RoughnessEvaluation, evaluate_roughness
from wheelrail.analysis.roughness_levels import SEGMENT_LENGTH, LimitComparison, compare_with_limit
from wheelrail.errors import ParameterError, WheelrailError
from wheelrail.excitation.measured_lines import read_height_lines
from wheelrail.excitation.named_spectra import named_spectrum
from wheelrail.plotting.force import nominal_frequency
from wheelrail.plotting.roughness import coherence_figure, roughness_figure

__all__ = ["RoughnessReport", "roughness_report"]

_COHERENCE_SEGMENT = 1.0  # m: many segments matter more than long waves


@dataclass(frozen=True)
class RoughnessReport:
    """What the command found.

    Attributes
    ----------
    text : str
        A table and a verdict, to be printed.
    notes : tuple of str
        What was done to the lines, and what the measurement lacks.
    files : tuple of Path
        Written files.
    exceeded : bool
        The mean is above the limit in a band.
    """

    text: str
    notes: tuple[str, ...]
    files: tuple[Path, ...]
    exceeded: bool


def roughness_report(
    path: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    on: str = "rail",
    wheel_radius: float | None = None,
    limit: str = "iso3095-2013-limit",
    process: bool = True,
    segment_length: float = SEGMENT_LENGTH,
) -> RoughnessReport:
    """Evaluate all lines of a file, and write figures and tables.

    Written are, named after the file: ``_roughness.csv`` (all levels and the limit), ``_spectrum.csv`` (the mean, to be
    used as the file of an excitation of type spectrum), ``_roughness.png``, and, for two lines or more,
    ``_coherence.png``.

    Parameters
    ----------
    path : path-like
        Measured lines, see `wheelrail.excitation.measured_lines.read_height_lines`.
    folder : path-like
        Where files go.
    on : {"rail", "wheel"}
        Surface; a wheel's lines are one turn each.
    wheel_radius : float or None
        m; needed on the wheel.
    limit : str
        A named spectrum.
    process : bool
        Remove spikes, and roll a wheel over the lines.
    segment_length : float
        m.

    Returns
    -------
    RoughnessReport

    Raises
    ------
    WheelrailError
        The lines can't be read or evaluated, or a file can't be written.
    ParameterError
        Unknown limit, surface, radius or segment length.
    """
    path, folder = Path(path), Path(folder)
    if on == "rail" and wheel_radius is not None:
        raise ParameterError("wheel_radius", wheel_radius, "only used with on = wheel (--on wheel)")
    table = named_spectrum(limit)
    if not folder.is_dir():
        raise WheelrailError(f"{folder}: no such folder; make it first")
    measured = read_height_lines(path)
    result = evaluate_roughness(
        measured, path=path, on=on, wheel_radius=wheel_radius, process=process, segment_length=segment_length
    )
    comparison = compare_with_limit(result.mean, table)
    by_line = [compare_with_limit(line, table) for line in result.lines]
    figures = {"roughness": roughness_figure(mean=result.mean, lines=result.lines, limit=comparison, title=path.name)}
    coherence = _coherence(result)
    if coherence is not None:
        figures["coherence"] = coherence_figure(bands=coherence, lateral=measured.lateral, title=path.name)

    files = [
        _write_levels(folder / f"{path.stem}_roughness.csv", path, result, comparison, measured.names),
        _write_spectrum(folder / f"{path.stem}_spectrum.csv", path, result),
    ]
    for name, figure in figures.items():
        files.append(_write_figure(folder / f"{path.stem}_{name}.png", figure))
    rows = [*_table(result, comparison), "", *_processing(result, measured.names, process)]
    if len(by_line) > 1:
        rows += [_verdict(name, line) for name, line in zip(measured.names, by_line, strict=True)]
    rows.append(f"{_verdict('mean' if len(by_line) > 1 else measured.names[0], comparison)} ({table.name})")
    return RoughnessReport("\n".join(rows), result.notes, tuple(files), bool(np.any(comparison.exceeded)))


def _coherence(result: RoughnessEvaluation) -> BandCoherence | None:
    """Coherence of lines if there are two, and bands wide enough."""
    if len(result.heights) < 2:
        return None
    segment = min(round(_COHERENCE_SEGMENT / result.spacing), result.heights.shape[1])
    bands = roughness_coherence(
        result.heights,
        spacing=result.spacing,
        periodic=result.periodic,
        segment=None if result.periodic else segment,
    )
    return bands if len(bands.centres) else None


def _millimetres(wavelength: float) -> str:
    name = nominal_frequency(1e3 * wavelength)
    return f"{1e3 * float(name[:-1]):g}" if name.endswith("k") else name


def _table(result: RoughnessEvaluation, comparison: LimitComparison) -> list[str]:
    limits = dict(zip(_band_names(comparison.wavelengths), comparison.limit, strict=True))
    # All lines have the bands of the mean: they are equally long.
    every = np.array([line.levels for line in result.lines])
    levels = {
        band: [mean, *([lowest, highest] if len(every) > 1 else [])]
        for band, mean, lowest, highest in zip(
            _band_names(result.mean.wavelengths), result.mean.levels, every.min(axis=0), every.max(axis=0), strict=True
        )
    }
    titles = ["mean", "lowest", "highest"] if len(every) > 1 else ["level"]
    rows = [
        "wavelength" + "".join(f"{title:>10}" for title in [*titles, "limit"]) + "  difference",
        "        mm" + f"{'dB':>10}" * (len(titles) + 1) + f"{'dB':>12}",
    ]
    for band in sorted({*limits, *levels}, key=float, reverse=True):
        shown = levels.get(band, [None] * len(titles))
        row = f"{band:>10}" + "".join(f"{'-' if x is None else f'{x:.1f}':>10}" for x in [*shown, limits.get(band)])
        if band in levels and band in limits:
            excess = levels[band][0] - limits[band]
            row += f"{excess:+12.1f}" + ("  above" if excess > 0.0 else "")
        rows.append(row)
    return rows


def _band_names(wavelengths: np.ndarray) -> list[str]:
    return [_millimetres(float(wavelength)) for wavelength in wavelengths]


def _processing(result: RoughnessEvaluation, names: tuple[str, ...], process: bool) -> list[str]:
    if not process:
        return ["lines as measured: no spikes removed, no wheel rolled over them"]
    return [
        f"{name}: {count} spike{'' if count == 1 else 's'} removed; pits bridged by {1e6 * rise:.3g} um at most"
        for name, count, rise in zip(names, result.spikes, result.raised, strict=True)
    ]


def _verdict(name: str, comparison: LimitComparison) -> str:
    judged = int(np.sum(~comparison.unknown))
    left = [_millimetres(float(w)) for w in comparison.wavelengths[comparison.unknown]]
    out = f"; not reached by the measurement: {', '.join(left)} mm" if left else ""
    if not judged:
        return f"{name}: no band of the limit is reached by the measurement"
    if not np.any(comparison.exceeded):
        return f"{name}: within the limit in all {judged} bands{out}"
    above = [
        f"{_millimetres(float(w))} mm by {excess:.1f} dB"
        for w, excess in zip(
            comparison.wavelengths[comparison.exceeded], comparison.excess[comparison.exceeded], strict=True
        )
    ]
    return f"{name}: ABOVE the limit in {len(above)} of {judged} bands: {', '.join(above)}{out}"


def _write_levels(
    target: Path, source: Path, result: RoughnessEvaluation, comparison: LimitComparison, names: tuple[str, ...]
) -> Path:
    """All levels in one table; an empty field: not known."""
    limits = dict(zip(_band_names(comparison.wavelengths), comparison.limit, strict=True))
    mean = dict(zip(_band_names(result.mean.wavelengths), result.mean.levels, strict=True))
    lines = [dict(zip(_band_names(line.wavelengths), line.levels, strict=True)) for line in result.lines]
    with open(target, "w", encoding="utf-8", newline="") as stream:
        stream.write(f"# Third-octave roughness levels of {source.name}, dB re 1 um\n")
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["wavelength_mm", "mean_dB", "limit_dB", *(f"{name} [dB]" for name in names)])
        for band in sorted({*limits, *mean}, key=float, reverse=True):
            values = [mean.get(band), limits.get(band), *(line.get(band) for line in lines)]
            writer.writerow([band, *("" if value is None else f"{value:.2f}" for value in values)])
    return target


def _write_spectrum(target: Path, source: Path, result: RoughnessEvaluation) -> Path:
    """Mean levels as `wheelrail.excitation.named_spectra.read_spectrum` reads them, without empty bands."""
    with open(target, "w", encoding="utf-8", newline="") as stream:
        stream.write(f"# Mean third-octave roughness levels of {source.name}, dB re 1 um\nwavelength_mm,level_dB\n")
        for wavelength, level in zip(result.mean.wavelengths, result.mean.levels, strict=True):
            if np.isfinite(level):
                stream.write(f"{_millimetres(float(wavelength))},{level:.2f}\n")
    return target


def _write_figure(target: Path, figure: Figure) -> Path:
    figure.savefig(target, format="png")
    return target
