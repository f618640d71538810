"""A host that is not Python: the ecos command of ecospy, started by the recipe in the FMU's documentation."""

from __future__ import annotations

import csv
import ctypes
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from wheelrail.case import Case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation

pytestmark = pytest.mark.fmu


def ecos_command(folder: Path) -> Path:
    """Copy the command to where it can be made executable, or skip with the reason."""
    specification = importlib.util.find_spec("ecospy")
    if not sys.platform.startswith("linux") or specification is None or specification.origin is None:
        pytest.skip("ecospy, whose native host this test runs, is not installed here (Linux x86-64 only)")
    source = Path(specification.origin).parent / "binaries" / "ecos"
    if not source.is_file():
        pytest.skip(f"ecospy has no native command {source}")
    command = folder / "ecos"
    shutil.copyfile(source, command)
    command.chmod(0o755)
    try:
        ctypes.CDLL("libtbb.so.12")
    except OSError:
        pytest.skip("the ecos command needs the system library libtbb.so.12 (apt install libtbb12)")
    return command


def python_library() -> Path:
    library = Path(sysconfig.get_config_var("LIBDIR") or "", sysconfig.get_config_var("INSTSONAME") or "")
    if not library.is_file() or ".so" not in library.name:
        pytest.skip("this Python has no shared library to preload")
    return library


def test_ecos_gives_the_forces_of_the_cosimulation(small_path: Path, small_case: Case, tmp_path: Path) -> None:
    command, library = ecos_command(tmp_path), python_library()
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    environment["LD_PRELOAD"] = str(library)
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    done = subprocess.run(
        [command, "simulate", "--path", small_path, "--stopTime", "0.01", "--stepSize", "0.001"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    # The exit code is not asked: the wrapper's unloading can crash a native host after its results are written.
    (result,) = tmp_path.glob("*.csv")
    with result.open(newline="") as file:
        rows = list(csv.reader(file, skipinitialspace=True))
    time, force, mean = (rows[0].index(name) for name in ("time", *_columns("force_z", "force_z_mean")))
    simulation = CoSimulation(build_model(small_case))
    simulation.initialise()
    assert len(rows) > 8, done.stderr
    for number, row in enumerate(rows[1:]):
        if number:
            simulation.advance(1e-3)
        assert float(row[time]) == pytest.approx(number * 1e-3, abs=1e-9)
        # ecos prints six decimals; the outputs at t = 0 are in it too
        assert float(row[force]) == pytest.approx(simulation.output("force_z"), abs=6e-7, rel=1e-12)
        assert float(row[mean]) == pytest.approx(simulation.output("force_z_mean"), abs=6e-7, rel=1e-12)


def _columns(*names: str) -> list[str]:
    return [f"instance::{name}[REAL]" for name in names]
