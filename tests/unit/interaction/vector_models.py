"""Small models in three directions from made-up, passive modes of wheel and rail; nothing comes from a file."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from wheelrail.case import case_from_dict, load_case
from wheelrail.greens.first_samples import wheel_with_first, with_first
from wheelrail.greens.modal import ModalRecursion
from wheelrail.greens.modal_discretisation import discretise_modes
from wheelrail.greens.track_response import TrackResponse
from wheelrail.interaction.build import build_model
from wheelrail.interaction.model import Model

CASE = load_case(Path(__file__).parents[3] / "examples" / "cases" / "rolling_contact.toml").to_dict()

# Frequency in Hz, damping ratio, modal mass in kg, shape (x', y', z').
WHEEL = [
    (430.0, 0.01, 60.0, (0.0, 0.9, 0.3)),
    (1150.0, 0.01, 40.0, (0.0, 0.7, -0.4)),
    (1150.0, 0.01, 40.0, (0.5, 0.0, 0.0)),
    (2600.0, 0.03, 50.0, (0.1, 0.4, 0.9)),
]
VERTICAL, LATERAL = (9.0, 0.3, 340.0, (0.0, 0.0, 1.0)), (18.0, 0.3, 340.0, (0.0, 1.0, 0.0))
RAIL = [
    (250.0, 0.15, 60.0, (0.0, 1.0, 0.2)),
    (600.0, 0.10, 55.0, (0.0, -0.3, 1.0)),
    (1700.0, 0.08, 25.0, (1.0, 0.1, 0.1)),
    (2900.0, 0.06, 20.0, (0.2, 0.9, 0.5)),
]


def recursion(modes: list[tuple], dt: float) -> ModalRecursion:
    frequency, ratio, mass = (np.array([mode[i] for mode in modes]) for i in range(3))
    omega = 2.0 * np.pi * frequency
    return discretise_modes(
        mass=mass,
        stiffness=mass * omega**2,
        damping=2.0 * ratio * mass * omega,
        shapes=[mode[3] for mode in modes],
        dt=dt,
    )


def vector_model(
    *,
    rigid: tuple = (VERTICAL, LATERAL),
    positions: int = 1,
    samples: int = 90,
    kept: bool = True,
    excitation: tuple = (),
    coupling: str = "load",
    creepage: tuple[float, float, float] = (1e-4, -1.5e-3, 0.1),
    **parameters: Any,
) -> Model:
    """Transient rolling on a half-space between a wheel of some modes and a rail of some modes."""
    data = deepcopy(CASE)
    data["simulation"] |= {"speed": 20.0, "dx": 1e-3}
    data["excitation"] = list(excitation)
    data["creepage"] = dict(zip(("x", "y", "spin"), creepage, strict=True))
    data["load"]["coupling"] = coupling
    base = build_model(case_from_dict(data))
    wheel, held = recursion([*rigid, *WHEEL], base.dt), recursion(WHEEL, base.dt)
    rail = recursion(RAIL, base.dt).values(samples).transpose(2, 1, 0)  # [force, displacement, sample]
    # The rail is softer between supports; its functions are not symmetric, as those of a moving contact.
    place = 1.0 + 0.1 * np.cos(2.0 * np.pi * np.arange(positions) / positions)
    if positions == 1:
        place[:] = 1.0
    values = (
        place[:, None, None, None] * rail * np.array([[1.0, 1.1, 0.9], [1.05, 1.0, 1.1], [1.0, 0.95, 1.0]])[..., None]
    )
    values[..., -1] *= 0.5
    values = np.concatenate([with_first(values[..., 0], kept=kept)[..., None], values[..., 1:]], axis=-1)
    model = replace(
        base,
        wheel=wheel_with_first(wheel, kept=kept),
        held_wheel=wheel_with_first(held, kept=kept),
        track=TrackResponse(values),
    )
    return model.configured(**parameters)
