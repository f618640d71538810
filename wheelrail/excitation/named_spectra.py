"""Third-octave roughness spectra: the named tables of the package, and a user's table."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.table_file import LENGTH_UNITS, LEVEL_UNITS, read_table
from wheelrail.numerics.third_octave_bands import band_numbers, exact_centres

__all__ = ["SpectrumTable", "named_spectra", "named_spectrum", "read_spectrum"]

_LOWEST_LEVEL, _HIGHEST_LEVEL = -120.0, 80.0  # dB re 1 um: 1 pm and 10 mm
_LONGEST_WAVELENGTH = 1000.0  # m

_SOURCES = {
    "iso3095-2013-limit": (
        "rail",
        "EN ISO 3095:2013, upper limit of the acoustic rail roughness, 400 mm to 3.15 mm; not extrapolated: "
        "no roughness outside this range",
    ),
    "cnossos-rail-iso3095-2013": (
        "rail",
        "Directive (EU) 2015/996, table G-1, amended by (EU) 2021/1226: well maintained and very smooth "
        "(the limit of EN ISO 3095:2013, continued by the directive to 2000 mm and 0.8 mm)",
    ),
    "cnossos-rail-average-network": (
        "rail",
        "Directive (EU) 2015/996, table G-1, amended by (EU) 2021/1226: average network, normally maintained smooth",
    ),
    "cnossos-wheel-cast-iron-tread": (
        "wheel",
        "Directive (EU) 2015/996, table G-1, amended by (EU) 2021/1226: cast iron tread brake",
    ),
    "cnossos-wheel-composite-block": (
        "wheel",
        "Directive (EU) 2015/996, table G-1, amended by (EU) 2021/1226: composite brake",
    ),
    "cnossos-wheel-disc-brake": (
        "wheel",
        "Directive (EU) 2015/996, table G-1, amended by (EU) 2021/1226: disc brake",
    ),
}


@dataclass(frozen=True, eq=False)
class SpectrumTable:
    """Roughness levels per third-octave band.

    Attributes
    ----------
    name : str
        Name of the table or file.
    surface : {"wheel", "rail"} or None
        Surface it was defined for; None: not said.
    source : str
        Where the figures come from.
    wavelengths : ndarray, shape (bands,)
        Exact centre wavelengths (base 10), m, descending.
    levels : ndarray, shape (bands,)
        dB re 1 um.
    """

    name: str
    surface: str | None
    source: str
    wavelengths: np.ndarray
    levels: np.ndarray


def named_spectra() -> tuple[str, ...]:
    """Names of all tables in the package."""
    return tuple(_SOURCES)


@cache
def _tables() -> dict[str, SpectrumTable]:
    text = resources.files("wheelrail.excitation").joinpath("named_spectra.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    tables = {}
    for name, (surface, source) in _SOURCES.items():
        held = [(float(row["wavelength_mm"]), float(row[name])) for row in rows if row[name]]
        # Band numbers count in mm, 30 bands from mm to m.
        wavelengths = exact_centres(band_numbers(np.array([w for w, _ in held])) - 30)
        levels = np.array([level for _, level in held])
        wavelengths.flags.writeable = levels.flags.writeable = False
        tables[name] = SpectrumTable(name, surface, source, wavelengths, levels)
    return tables


def named_spectrum(name: str) -> SpectrumTable:
    """Table of that name.

    Raises
    ------
    ParameterError
        Unknown name.
    """
    if name not in _SOURCES:
        raise ParameterError("name", name, f"known spectra: {', '.join(_SOURCES)}")
    return _tables()[name]


def read_spectrum(path: Path | str) -> SpectrumTable:
    """Read a user's spectrum: columns wavelength (m, mm or um) and level (dB re 1 um), one row per third-octave band.

    Wavelengths may be nominal or exact; they are put on the exact centres of the base-10 system.

    Parameters
    ----------
    path : Path or str
        Text file with a header, as ``wavelength_mm,level_dB``; ``#`` starts a comment line.

    Raises
    ------
    DataFileError
        Unreadable file, wrong units, a wavelength that is no third-octave centre or appears twice, or an
        implausible level.
    """
    table = read_table(path, column_units=(tuple(LENGTH_UNITS), tuple(LEVEL_UNITS)))
    if len(table.names) != 2:
        raise DataFileError(
            f"{table.path}, line {table.header_line}: {len(table.names)} columns; allowed are two, wavelength and level"
        )
    if table.values.shape[0] == 0:
        raise DataFileError(f"{table.path}: no rows after the header; at least one band is needed")
    factor = LENGTH_UNITS[table.units[0]]
    bands: dict[int, float] = {}
    for (printed, level), line in zip(table.values, table.lines, strict=True):
        where = f"{table.path}, line {line}"
        if not 0.0 < printed * factor <= _LONGEST_WAVELENGTH:
            raise DataFileError(
                f"{where}: wavelength {printed:g} {table.units[0]}; allowed: above 0, at most {_LONGEST_WAVELENGTH:g} m"
            )
        try:
            # In mm, so that printed nominal values meet their band; then 30 bands from mm to m.
            number = int(band_numbers(np.array([printed * factor * 1e3]))[0]) - 30
        except ValueError:
            raise DataFileError(
                f"{where}: wavelength {printed:g} {table.units[0]} is not the centre of a third-octave band "
                "(..., 10, 12.5, 16, 20, 25, 31.5, 40, 50, 63, 80, 100, ... mm)"
            ) from None
        if number in bands:
            raise DataFileError(f"{where}: the band of wavelength {printed:g} {table.units[0]} appears twice")
        if not _LOWEST_LEVEL <= level <= _HIGHEST_LEVEL:
            raise DataFileError(
                f"{where}: level {level:g} dB re 1 um; allowed: {_LOWEST_LEVEL:g} dB to {_HIGHEST_LEVEL:g} dB"
            )
        bands[number] = float(level)
    numbers = np.array(sorted(bands, reverse=True))
    wavelengths = exact_centres(numbers)
    levels = np.array([bands[int(number)] for number in numbers])
    return SpectrumTable(table.path.name, None, str(table.path), wavelengths, levels)
