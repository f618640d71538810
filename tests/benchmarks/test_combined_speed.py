"""How fast a step in three directions is outside its contact: flexible wheel, waveguide rail, transient rolling.

    python -m pytest tests/benchmarks/test_combined_speed.py -m benchmark -s

Nothing here asserts a time. The baselines of the same run are the convolution sums as Pieringer (2011) writes them,
eqs. 3.5 and 3.15, and numpy.linalg.solve on 400 x 400.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from wheelrail.case import case_from_dict, load_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.model import Model
from wheelrail.interaction.start import start
from wheelrail.interaction.step import step

pytestmark = pytest.mark.benchmark

ROLLING = load_case(Path(__file__).parents[2] / "examples" / "cases" / "rolling_contact.toml").to_dict()


class Timed:
    """A contact model that counts the time spent in it."""

    def __init__(self, contact: Any) -> None:
        self.contact, self.seconds = contact, 0.0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.contact, name)

    def _timed(self, method: Any, *values: Any, **named: Any) -> Any:
        begin = perf_counter()
        result = method(*values, **named)
        self.seconds += perf_counter() - begin
        return result

    def solve(self, *values: Any, **named: Any) -> Any:
        return self._timed(self.contact.solve, *values, **named)

    def step(self, *values: Any, **named: Any) -> Any:
        return self._timed(self.contact.step, *values, **named)


def case(track: str, tangential: str) -> dict[str, Any]:
    data = {**ROLLING, "simulation": {**ROLLING["simulation"], "speed": 50.0 / 3.6}}
    data["contact"] = {**ROLLING["contact"], "tangential": tangential}
    data["wheel"] = {"preset": "synthetic-c20", "contact_position": 0.01}
    data["track"] = {"preset": track, "contact_position": 0.01}
    return data


def outside_the_contact(model: Model, steps: int) -> tuple[float, float]:
    """Seconds of a step outside and inside the contact's solvers."""
    normal, tangential = Timed(model.contact), Timed(model.tangential)
    timed = replace(model, contact=normal, tangential=None if model.tangential is None else tangential)
    state = start(timed, timed.start_inputs)
    times = []
    for _ in range(6):
        normal.seconds = tangential.seconds = 0.0
        begin = perf_counter()
        for _ in range(steps):
            step(timed, state, timed.start_inputs)
        inside = normal.seconds + tangential.seconds
        times.append((perf_counter() - begin - inside, inside))
    outside, inside = np.median(times[1:], axis=0) / steps
    return float(outside), float(inside)


def summed(model: Model) -> float:
    """Seconds of the two convolutions as written, with all past forces; the wheel's 2.5 s as in the thesis."""
    assert model.track is not None
    track, samples = model.track.values, model.track.samples
    wheel = np.zeros((3, round(2.5 / model.dt) * 3))
    forces = np.ones((wheel.shape[1] // 3, 3))
    ages = np.arange(samples)

    def both() -> None:
        np.einsum("aij,ai->j", track[-ages % len(track), :, :, ages], forces[:samples])
        wheel @ forces[::-1].reshape(-1)

    times = []
    for _ in range(5):
        begin = perf_counter()
        both()
        times.append(perf_counter() - begin)
    return median(times)


@pytest.mark.parametrize("track", ["thesis-waveguide-60e1", "waveguide-60e1-sleepers"])
def test_step_outside_the_contact(track: str) -> None:
    rng = np.random.default_rng(0)
    matrix, vector = rng.normal(size=(400, 400)) + 400.0 * np.eye(400), rng.normal(size=400)
    with threadpool_limits(1):
        times = []
        for _ in range(11):
            begin = perf_counter()
            np.linalg.solve(matrix, vector)
            times.append(perf_counter() - begin)
        solve = median(times)
        begin = perf_counter()
        model = build_model(case_from_dict(case(track, "transient")))
        built = perf_counter() - begin
        begin = perf_counter()
        build_model(case_from_dict(case(track, "transient")))
        again = perf_counter() - begin
        outside, inside = outside_the_contact(model, 200)
        vertical, _ = outside_the_contact(build_model(case_from_dict(case(track, "none"))), 200)
        written = summed(model)
    assert model.track is not None
    assert model.wheel is not None
    print(
        f"\n{track}: {model.wheel.size // 2} wheel modes, {model.track.positions} x 3 x 3 x {model.track.samples} "
        "samples\n"
        f"  outside the contact {1e6 * outside:.0f} us = {outside / solve:.3f} x numpy.linalg.solve(400), "
        f"{outside / inside:.3f} x the contact ({1e6 * inside:.0f} us); vertical only {1e6 * vertical:.0f} us\n"
        f"  the convolutions as written take {1e6 * written:.0f} us = {written / outside:.0f} x all of that\n"
        f"  model built in {built:.1f} s, again from the cache in {again:.2f} s"
    )
