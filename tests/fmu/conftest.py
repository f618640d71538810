"""FMUs of two small cases, built once."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fmu_host import UnpackedFmu

from fmu_src.build import build_fmu
from wheelrail.case import Case, parse_case

# A mass over a Hertz spring on a rigid rail, fast waves: builds and steps in no time.
QUICK = """
title = "Mass on a rigid rail"
[simulation]
speed = 20.0
dx = 1e-3
duration = 0.02
start_position = 0.0
[wheel]
model = "rigid-1dof"
radius = 0.46
mass = 341.5
suspension_stiffness = 1.12e6
suspension_damping = 13.2e3
[track]
model = "rigid"
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
[load]
preload = 65e3
coupling = "load"
[[excitation]]
type = "sinusoid"
amplitude = 2e-6
wavelength = 0.05
"""

# Wheel of two masses on a short discretely supported track, Winkler bedding, random roughness.
SMALL = """
title = "Two masses on a short track"
[simulation]
speed = 25.0
dx = 2e-3
duration = 0.01
start_position = 0.0
[wheel]
preset = "thesis-2dof"
[track]
preset = "thesis-discrete"
sleeper_spacing = 0.6
bays = 20
elements_per_bay = 2
[contact]
normal = "winkler"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
length = 22e-3
[load]
preload = 50e3
coupling = "load"
[[excitation]]
type = "spectrum"
name = "iso3095-2013-limit"
on = "rail"
seed = 7
"""


@pytest.fixture(scope="session")
def quick_case() -> Case:
    return parse_case(QUICK, source="quick")


@pytest.fixture(scope="session")
def small_case() -> Case:
    return parse_case(SMALL, source="small")


@pytest.fixture(scope="session")
def quick_path(quick_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_fmu(quick_case, tmp_path_factory.mktemp("quick"))


@pytest.fixture(scope="session")
def small_path(small_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_fmu(small_case, tmp_path_factory.mktemp("small"))


@pytest.fixture(scope="session")
def quick_fmu(quick_path: Path, tmp_path_factory: pytest.TempPathFactory) -> UnpackedFmu:
    return UnpackedFmu(quick_path, tmp_path_factory.mktemp("unpacked_quick"))


@pytest.fixture(scope="session")
def small_fmu(small_path: Path, tmp_path_factory: pytest.TempPathFactory) -> UnpackedFmu:
    return UnpackedFmu(small_path, tmp_path_factory.mktemp("unpacked_small"))


@pytest.fixture
def run_host(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run a Python host in a process and folder of its own, without wheelrail on its path."""

    def run(script: str, *arguments: object, isolated: bool = False) -> subprocess.CompletedProcess[str]:
        environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
        flags = ["-I"] if isolated else []
        if not isolated:
            environment["PYTHONPATH"] = str(Path(__file__).parent)  # for fmu_host
        return subprocess.run(
            [sys.executable, *flags, "-c", script, *map(str, arguments)],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )

    return run
