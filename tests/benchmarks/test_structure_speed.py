"""How fast the flexible wheel and the waveguide rail are prepared: cold, in processes of their own, and from the cache.

    python -m pytest tests/benchmarks/test_structure_speed.py -m benchmark -s

Nothing here asserts a time. The unit in which machines compare is one numpy.linalg.solve on 400 x 400.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

pytestmark = pytest.mark.benchmark

CASE = Path(__file__).parents[2] / "examples" / "cases" / "squeal.toml"

WHEEL = """
import resource, time
from threadpoolctl import threadpool_limits
from wheelrail.wheel.flexible import wheel_shapes
from wheelrail.wheel.section import load_section
with threadpool_limits(1):
    begin = time.perf_counter()
    shapes = wheel_shapes(
        load_section("synthetic-c20"), youngs_modulus=207e9, poisson_ratio=0.3, density=7860.0, max_frequency=7e3
    )
    seconds = time.perf_counter() - begin
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(seconds, peak, f"{len(shapes.modes)} modes to 7 kHz", sep="|")
"""

RAIL = """
import resource, sys, time
from threadpoolctl import threadpool_limits
from wheelrail.case import case_from_dict, load_case
from wheelrail.interaction.tracks import greens_of
case = load_case(sys.argv[1])
case = case_from_dict(case.to_dict() | {"track": {"preset": sys.argv[2]}}, folder=case.folder)
with threadpool_limits(1):
    begin = time.perf_counter()
    values = greens_of(case).values
    seconds = time.perf_counter() - begin
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(seconds, peak, f"{values.shape} values, {values.nbytes / 1e6:.1f} MB", sep="|")
"""


@pytest.fixture(scope="module")
def solve_400() -> float:
    rng = np.random.default_rng(0)
    matrix, vector = rng.normal(size=(400, 400)) + 400.0 * np.eye(400), rng.normal(size=400)
    times = []
    with threadpool_limits(1):
        for _ in range(21):
            begin = perf_counter()
            np.linalg.solve(matrix, vector)
            times.append(perf_counter() - begin)
    return median(times)


def measure(program: str, *arguments: str) -> tuple[float, float, str]:
    """Seconds, peak memory of the process in MB, and what it says."""
    out = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, check=True)
    seconds, peak, text = out.stdout.strip().split("|")
    return float(seconds), float(peak), text


def test_wheel_modes(solve_400: float) -> None:
    runs = [measure(WHEEL) for _ in range(3)]
    seconds = median(run[0] for run in runs)
    print(
        f"\nwheel modes: {seconds:.2f} s = {seconds / solve_400:.0f} x numpy.linalg.solve(400), "
        f"peak {max(run[1] for run in runs):.0f} MB, {runs[0][2]}"
    )


@pytest.mark.parametrize("track", ["thesis-waveguide-60e1", "waveguide-60e1-sleepers"])
def test_waveguide_functions(track: str, solve_400: float, tmp_path, monkeypatch) -> None:
    cold, warm = [], []
    for run in range(3):
        monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path / str(run)))
        cold.append(measure(RAIL, str(CASE), track))
        warm.append(measure(RAIL, str(CASE), track))
    seconds, again = median(run[0] for run in cold), median(run[0] for run in warm)
    print(
        f"\n{track}: {seconds:.2f} s = {seconds / solve_400:.0f} x numpy.linalg.solve(400), peak "
        f"{max(run[1] for run in cold):.0f} MB, {cold[0][2]}; from the cache {again:.3f} s, 1/{seconds / again:.0f}"
    )
