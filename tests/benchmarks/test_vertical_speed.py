"""How fast the vertical model is: ratios against baselines timed in the same run.

    python -m pytest tests/benchmarks -m benchmark -s

Nothing here asserts a time. Medians of several runs, one thread for BLAS.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from wheelrail.case import case_from_dict, default_case_text, parse_case
from wheelrail.greens.cache import cached_moving_greens
from wheelrail.interaction.build import build_model, track_of
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.inputs import Inputs
from wheelrail.interaction.model import Model
from wheelrail.interaction.start import start
from wheelrail.interaction.step import step

pytestmark = pytest.mark.benchmark

SPEED = 106.0 / 3.6

COLD = """
import resource, sys, time
from threadpoolctl import threadpool_limits
from wheelrail.case import default_case_text, parse_case
from wheelrail.interaction.build import track_of
from wheelrail.greens.moving import compute_moving_greens
threads = int(sys.argv[1])
with threadpool_limits(threads):
    begin = time.perf_counter()
    compute_moving_greens(track_of(parse_case(default_case_text())), speed=106.0 / 3.6, dx=1e-3)
    print(time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""


def timed(work: Callable[[], object], runs: int = 5) -> float:
    times = []
    for _ in range(runs):
        begin = perf_counter()
        work()
        times.append(perf_counter() - begin)
    return median(times)


@pytest.fixture(autouse=True)
def one_thread():
    with threadpool_limits(1):
        yield


@pytest.fixture(scope="module")
def solve_400() -> float:
    """Time of numpy.linalg.solve on 400 x 400, the unit in which machines compare."""
    rng = np.random.default_rng(0)
    matrix, vector = rng.normal(size=(400, 400)) + 400.0 * np.eye(400), rng.normal(size=400)
    with threadpool_limits(1):
        return timed(lambda: np.linalg.solve(matrix, vector), 21)


@pytest.fixture(scope="module")
def model() -> Model:
    case = parse_case(default_case_text()).to_dict()
    case["simulation"]["speed"] = SPEED
    return build_model(case_from_dict(case))


def pull(model: Model, forces: np.ndarray, number: int) -> float:
    """Rail displacement as eq. 3.15 is written: the sum over all past forces, each with its own function."""
    assert model.track is not None
    samples = model.track.samples
    ages = np.arange(min(samples, number + 1))
    rows = (model.start_index + number - ages) % model.track.positions
    return float(model.track.values[rows, 0, 0, ages] @ forces[number - ages])


def test_green_functions(model: Model, solve_400: float) -> None:
    assert model.track is not None
    print()
    for threads in (1, 2):
        out = subprocess.run([sys.executable, "-c", COLD, str(threads)], capture_output=True, text=True, check=True)
        seconds, megabytes = map(float, out.stdout.split())
        print(
            f"moving Green's functions cold, {threads} thread(s): {seconds:.1f} s, peak {megabytes:.0f} MB "
            f"= {seconds / solve_400:.0f} x numpy.linalg.solve(400)"
        )
    track = track_of(parse_case(default_case_text()))
    assert track is not None
    warm = timed(lambda: cached_moving_greens(track, speed=SPEED, dx=1e-3))
    print(
        f"moving Green's functions from the cache: {warm:.3f} s, {seconds / warm:.0f} times faster than cold "
        f"({model.track.positions} x {model.track.samples} samples, {model.track.values.nbytes / 1e6:.0f} MB)"
    )


def test_step(model: Model, solve_400: float) -> None:
    inputs = Inputs(wheel_force_z=model.start_inputs.wheel_force_z)
    state = start(model, inputs)
    count = 4000

    def run() -> None:
        for _ in range(count):
            step(model, state, inputs)

    run()
    seconds = timed(run) / count
    forces = np.full(model.track.samples + 10, 65e3) if model.track is not None else np.zeros(1)
    pulled = timed(lambda: [pull(model, forces, len(forces) - 1) for _ in range(50)]) / 50
    print(
        f"\nvertical step (2-dof wheel, discrete track, Winkler): {1e6 * seconds:.0f} us = "
        f"{seconds / model.dt:.2f} x real time at 106 km/h, dx 1 mm; {seconds / solve_400:.3f} x "
        f"numpy.linalg.solve(400); the history alone as written in eq. 3.15 takes {pulled / seconds:.1f} times as long"
    )


def test_long_run(model: Model) -> None:
    run = CoSimulation(model)
    run.advance(1.0)
    before, begin = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, perf_counter()
    for _ in range(59_000):
        run.advance(1e-3)
    seconds = perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(
        f"\n60 s run in steps of 1 ms: {seconds / 59.0:.2f} x real time, peak memory grew by "
        f"{(after - before) / 1024:.1f} MB from {before / 1024:.0f} MB"
    )


def test_fmu_start(model: Model) -> None:
    from fmpy import extract, read_model_description
    from fmpy.fmi2 import FMU2Slave

    from fmu_src.build import build_fmu

    del model
    with tempfile.TemporaryDirectory() as folder:
        path = build_fmu(parse_case(default_case_text()), Path(folder))
        description, unzipped = read_model_description(path), extract(path)
        times = []
        for number in range(5):
            begin = perf_counter()
            fmu = FMU2Slave(
                guid=description.guid,
                unzipDirectory=unzipped,
                modelIdentifier=description.coSimulation.modelIdentifier,
                instanceName=f"wheel{number}",
            )
            fmu.instantiate()
            instantiated = perf_counter()
            fmu.setupExperiment(startTime=0.0)
            fmu.enterInitializationMode()
            fmu.exitInitializationMode()
            times.append((instantiated - begin, perf_counter() - instantiated))
        first, later = times[0], np.median(times[1:], axis=0)
        print(
            f"\nFMU ({path.stat().st_size / 1e6:.0f} MB): instantiate {first[0]:.2f} s, initialise {first[1]:.2f} s; "
            f"further instances {later[0]:.3f} s and {later[1]:.3f} s ({first[0] / later[0]:.0f} times faster)"
        )
