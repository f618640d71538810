"""Vertical runs over roughness so small that the contact is linear, and their transfer functions."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wheelrail.case import Case, parse_case
from wheelrail.excitation.line import Line
from wheelrail.interaction.model import Model
from wheelrail.interaction.simulate import simulate

AMPLITUDE = 1e-9  # m, of every line

_CASE = """
[simulation]
speed = {speed}
dx = {dx}
duration = 1.0
start_position = 0.0
[wheel]
preset = "synthetic-c20"
contact_position = {on_wheel}
[track]
{track}
[contact]
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
{contact}
[load]
preload = 65e3
coupling = "load"
"""


def vertical_case(
    *, speed: float, dx: float, track: str, contact: str = 'normal = "hertz"', on_wheel: float = 0.0
) -> Case:
    """Case of the flexible wheel; ``track`` and ``contact`` are lines of the case file."""
    return parse_case(_CASE.format(speed=speed, dx=dx, track=track, contact=contact, on_wheel=on_wheel))


def spaced_lines(number: int, *, window: float, lowest: float = 100.0, highest: float = 4000.0) -> NDArray:
    """About equally spaced frequencies on a logarithmic scale (Hz), each with whole periods in the window (s)."""
    return np.unique(np.round(np.geomspace(lowest, highest, number) * window)) / window


class Transfer(NamedTuple):
    """What a unit of roughness causes at each line, and the largest force between the lines over a typical one."""

    force: NDArray
    wheel: NDArray
    rail: NDArray
    between: float


def transfer(model: Model, frequency: NDArray, *, window: float, ramp: float) -> Transfer:
    """Roll over sinusoids that grow smoothly within the ramp (s) and look at the window (s) after it."""
    n, begin = round(window / model.dt), round(ramp / model.dt)
    t = model.dt * np.arange(begin + n + 1)
    phase = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, len(frequency))
    heights = np.zeros_like(t)
    for f, p in zip(frequency, phase, strict=True):
        heights += AMPLITUDE * np.sin(2.0 * np.pi * f * t + p)
    grown = np.minimum(t / t[begin], 1.0)
    heights *= grown - np.sin(2.0 * np.pi * grown) / (2.0 * np.pi)
    half = model.contact.nodes // 2
    line = Line(np.pad(heights, half), -half, model.dx, False, "lines")
    rolled = simulate(
        replace(model, sources=(line,)), duration=t[-1], record=["force_z", "wheel_disp_z", "rail_disp_z"]
    ).collect()
    spectra = [np.fft.rfft(rolled[name][-n:]) for name in ("force_z", "wheel_disp_z", "rail_disp_z")]
    rough = np.fft.rfft(heights[-n:])
    at = np.round(frequency * window).astype(int)
    others = np.ones(len(rough), dtype=bool)
    others[at] = False
    others[: math.ceil(0.6 * at[0])] = others[at[-1] + 1 :] = False
    force = np.abs(spectra[0])
    between = float(force[others].max() / np.median(force[at]))
    force_z, wheel_z, rail_z = (spectrum[at] / rough[at] for spectrum in spectra)
    return Transfer(force_z, wheel_z, rail_z, between)


def decibels(ratio: NDArray) -> NDArray:
    """Magnitudes of a ratio in dB."""
    return 20.0 * np.log10(np.abs(ratio))
