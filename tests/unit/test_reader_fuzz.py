"""Damaged files: every reader of measured data gives finite numbers or one `DataFileError`, and nothing else."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from wheelrail.errors import DataFileError
from wheelrail.excitation.measured import read_heights
from wheelrail.excitation.named_spectra import read_spectrum
from wheelrail.profile.reading import read_profile

PROFILES = Path(__file__).parents[1] / "data" / "profiles"
NUMBERS = ["nan", "inf", "-inf", "1e300", "-1e308", "1e-300", "1e999", "0", "-0.0", "1_0", "0x1p3", "1,5", "--1", "٣"]
SNIPPETS = [
    *("=", '"', "'", "!", "#", "%", ",", ";", "\t", " ", "\n\n", "\r", "\r\n", "\x0c", "\x1a", "\u2028", "\ufeff", "µ"),
    *("ColumnDef=Y,X", "ColumnDef=", "XYPoints=nan", "XOffset=1e300", "YOffset=-1e9", "#MINIRAILPROF", "[FileInfo]"),
    *("units.len.f = 0", "units.len.f = 1e-300", "units.len = 'in'", "rotate = 1e9", "rotate = 1", "mirror.z = 1"),
    *("inversion = 1", "bound.y.min = -5", "bound.y.max = 5", "shift.z = inf", "type = 1", "point.end", "spline.begin"),
    *("y_mm", "[m]", "(um)", "x_m,height_um", "wavelength_m,level_dB"),
]


def roughness() -> bytes:
    x = 0.001 * np.arange(40)
    return (
        "x_m,height_um\n" + "\n".join(f"{a:.4f},{b:.4f}" for a, b in zip(x, np.sin(90.0 * x), strict=True))
    ).encode()


def spectrum() -> bytes:
    bands = (100, 80, 63, 50, 40, 31.5, 25, 20, 16, 12.5, 10)
    return (
        "# measured\nwavelength [mm];level [dB]\n" + "\n".join(f"{band};{band / 10:.2f}" for band in bands)
    ).encode()


def columns() -> bytes:
    y = np.linspace(-36.0, 36.0, 60)
    z = 0.8 * np.maximum(np.abs(y) - 30.0, 0.0) ** 1.6 + y**2 / 600.0
    return ("y_mm z_mm\n" + "\n".join(f"{a:.3f} {b:.3f}" for a, b in zip(y, z, strict=True))).encode()


def profile(path: Path, kind: str) -> list[np.ndarray]:
    read = read_profile(path, kind=kind)
    assert read.y.shape == read.z.shape
    assert len(read.y) >= 20
    assert 0.02 <= np.ptp(read.y) <= 0.2
    assert read.y[0] <= read.y[-1]
    return [read.y, read.z]


def bands(path: Path) -> list[np.ndarray]:
    read = read_spectrum(path)
    assert np.all(read.wavelengths > 0.0)
    return [read.wavelengths, read.levels]


@dataclass(frozen=True)
class Reader:
    name: str
    content: Callable[[], bytes]
    read: Callable[[Path], list[np.ndarray]]


READERS = [
    Reader("line.csv", roughness, lambda path: list(read_heights(path))),
    Reader("spectrum.csv", spectrum, bands),
    Reader("profile.txt", columns, lambda path: profile(path, "rail")),
    Reader("rail.ban", (PROFILES / "rail_roller.ban").read_bytes, lambda path: profile(path, "rail")),
    Reader("wheel.whl", (PROFILES / "wheel_worn_old_header.whl").read_bytes, lambda path: profile(path, "wheel")),
    Reader("rail.prr", (PROFILES / "rail_60e1_canted.prr").read_bytes, lambda path: profile(path, "rail")),
    Reader("wheel.prw", (PROFILES / "wheel_s1002.prw").read_bytes, lambda path: profile(path, "wheel")),
]


def flipped(content: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(content)
    for place in rng.integers(len(changed), size=rng.integers(1, 4)):
        changed[place] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def truncated(content: bytes, rng: np.random.Generator) -> bytes:
    return content[: rng.integers(len(content))]


def line_deleted(content: bytes, rng: np.random.Generator) -> bytes:
    lines = content.splitlines(keepends=True)
    del lines[rng.integers(len(lines))]
    return b"".join(lines)


def line_repeated(content: bytes, rng: np.random.Generator) -> bytes:
    lines = content.splitlines(keepends=True)
    lines.insert(rng.integers(len(lines)), lines[rng.integers(len(lines))])
    return b"".join(lines)


def lines_exchanged(content: bytes, rng: np.random.Generator) -> bytes:
    lines = content.splitlines(keepends=True)
    i, j = rng.integers(len(lines), size=2)
    lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


def columns_exchanged(content: bytes, rng: np.random.Generator) -> bytes:
    everywhere = rng.random() < 0.5
    lines = content.splitlines(keepends=True)
    for i in range(len(lines)) if everywhere else [rng.integers(len(lines))]:
        lines[i] = re.sub(rb"^(\s*)([^\s,;]+)([\s,;]+)([^\s,;]+)", rb"\1\4\3\2", lines[i])
    return b"".join(lines)


def number_replaced(content: bytes, rng: np.random.Generator) -> bytes:
    found = list(re.finditer(rb"[-+]?\d[\d.eE+-]*", content))
    if not found:
        return content
    chosen = found[rng.integers(len(found))]
    return content[: chosen.start()] + str(rng.choice(NUMBERS)).encode() + content[chosen.end() :]


def numbers_scaled(content: bytes, rng: np.random.Generator) -> bytes:
    factor = 10.0 ** rng.integers(-12, 12)
    return re.sub(rb"[-+]?\d+\.\d+([eE][-+]\d+)?", lambda found: b"%.9g" % (factor * float(found[0])), content)


def separators_changed(content: bytes, rng: np.random.Generator) -> bytes:
    marks = [b",", b";", b"\t", b" ", b"."]
    return content.replace(marks[rng.integers(5)], marks[rng.integers(5)])


def snippet_inserted(content: bytes, rng: np.random.Generator) -> bytes:
    snippet = str(rng.choice(SNIPPETS)).encode()
    if rng.random() < 0.5:
        lines = content.splitlines(keepends=True)
        lines.insert(rng.integers(len(lines)), snippet + b"\n")
        return b"".join(lines)
    place = rng.integers(len(content))
    return content[:place] + snippet + content[place:]


def noise_inserted(content: bytes, rng: np.random.Generator) -> bytes:
    place = rng.integers(len(content))
    return content[:place] + rng.bytes(rng.integers(1, 40)) + content[place + rng.integers(20) :]


def points_repeated(content: bytes, rng: np.random.Generator) -> bytes:
    lines = content.splitlines(keepends=True)
    start, stop = sorted(rng.integers(len(lines), size=2))
    return b"".join([*lines[:stop], *lines[start:stop][:: rng.choice([-1, 1])], *lines[stop:]])


MUTATIONS = [
    *(flipped, truncated, line_deleted, line_repeated, lines_exchanged, columns_exchanged, number_replaced),
    *(numbers_scaled, separators_changed, snippet_inserted, noise_inserted, points_repeated),
]


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
def test_damaged_files_are_read_or_refused(tmp_path, reader):
    rng = np.random.default_rng(20111)
    path = tmp_path / reader.name
    original = reader.content()
    path.write_bytes(original)
    reader.read(path)  # the file is good before it is damaged
    outcomes = {"read": 0, "refused": 0}
    for number in range(480):
        content = original
        for _ in range(rng.integers(1, 4)):
            content = MUTATIONS[rng.integers(len(MUTATIONS))](content, rng) or b" "
        path.write_bytes(content)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                arrays = reader.read(path)
            assert all(np.all(np.isfinite(array)) for array in arrays)
            outcomes["read"] += 1
        except DataFileError as error:
            message = str(error)
            assert message.startswith(str(path)), message
            assert len(message) < len(str(path)) + 400, message
            outcomes["refused"] += 1
        except Exception as error:
            raise AssertionError(f"mutation {number} of {reader.name}: {content!r}") from error
    # Neither a reader that refuses all nor one that takes all passes.
    assert min(outcomes.values()) > 40, outcomes
