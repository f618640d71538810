"""The model: everything that a run reads and never changes."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..contact.geometry import ConstantGeometry, ContactGeometry
from ..contact.solution import NormalContact
from ..contact.tangential_models import TangentialModel
from ..errors import ParameterError
from ..greens.parts import response_to_parts
from ..greens.protocol import WheelResponse, first_sample
from ..greens.track_response import TrackResponse
from .inputs import Inputs
from .parameters import OWN_SEEDS, Parameters

__all__ = ["Model", "Source"]

_SPEED_TOLERANCE = 1e-9


class Source(Protocol):
    """A source of combined roughness on the grid x = i dx."""

    @property
    def across(self) -> bool:
        """Whether it differs across the surface."""
        ...

    def add_window(self, first: int, out: NDArray, /) -> None:
        """Add r(first dx), r((first + 1) dx), ... in m to ``out``; of a source that is the same all across."""
        ...

    def add_surface(self, first: int, y_wheel: NDArray, y_rail: NDArray, out: NDArray, /) -> None:
        """Add the same at several positions across (m) to ``out``, shape (rows, nodes); of one that is not."""
        ...

    def realise(self, *, dx: float, seed_override: int | None) -> Source:
        """Return the source with its random numbers drawn; itself if there are none."""
        ...

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description, and the arrays."""
        ...


@dataclass(frozen=True)
class Model:
    """Parameters and everything precomputed; shared by any number of runs.

    Attributes
    ----------
    title, case : str
        Title, and the whole case file with its presets resolved.
    dx : float
        Grid spacing in rolling direction, m.
    parameters : Parameters
    start_inputs : Inputs
        What the case gives for the vehicle's inputs: the preload, creepages, lateral shift.
    wheel : WheelResponse or None
        Green's functions of the wheel on its suspension; None for a wheel without dynamics.
    held_wheel : WheelResponse or None
        What remains of it in coupling by displacement.
    track : TrackResponse or None
        Moving Green's functions of one bay; None for a rigid track.
    geometry : ContactGeometry
        Where wheel and rail touch.
    contact : NormalContact
    tangential : TangentialModel or None
        None for a run in vertical direction only. With one, wheel and track may have three directions; their first
        samples that couple the vertical with another direction are then zero. A body with one direction stands still
        in the others.
    sources : tuple of Source
        Excitation as the case gives it.
    report : dict
        JSON-able facts about how it was built, for people.
    """

    title: str
    case: str
    dx: float
    parameters: Parameters
    start_inputs: Inputs
    wheel: WheelResponse | None
    held_wheel: WheelResponse | None
    track: TrackResponse | None
    geometry: ContactGeometry
    contact: NormalContact
    tangential: TangentialModel | None
    sources: tuple[Source, ...]
    report: dict[str, Any]

    @property
    def dt(self) -> float:
        """Time step dx / v in s."""
        return self.dx / self.parameters.speed

    @cached_property
    def start_index(self) -> int:
        """Grid index i of the start, x = i dx."""
        return round(self.parameters.start_position / self.dx)

    @cached_property
    def active_wheel(self) -> WheelResponse | None:
        """The wheel's Green's functions in the chosen coupling."""
        return self.wheel if self.parameters.coupling == "load" else self.held_wheel

    @cached_property
    def active_geometry(self) -> ContactGeometry:
        """Geometry with the chosen lateral position; profiles decide for themselves where they touch."""
        if isinstance(self.geometry, ConstantGeometry):
            return replace(self.geometry, y_wheel=self.parameters.lateral_position)
        return self.geometry

    @cached_property
    def wheel_first(self) -> float:
        """First vertical sample of the active wheel, m/N."""
        return 0.0 if self.active_wheel is None else float(first_sample(self.active_wheel)[-1, -1])

    @cached_property
    def wheel_first_tangential(self) -> NDArray | None:
        """First samples of the active wheel along and across the rail, shape (2, 2), m/N; None if they are zero."""
        if self.active_wheel is None or self.active_wheel.directions == 1:
            return None
        first = first_sample(self.active_wheel)[:2, :2]
        return first if np.any(first) else None

    @cached_property
    def tangential_compliances(self) -> list[NDArray] | None:
        """First samples of rail and wheel together for each position in a bay; None if they are zero."""
        wheel = self.wheel_first_tangential
        track = self.track
        if track is None or track.directions == 1:
            return None if wheel is None else [wheel]
        both = [track.tangential_first(i) + (0.0 if wheel is None else wheel) for i in range(track.positions)]
        return both if np.any(both) else None

    @cached_property
    def lines(self) -> tuple[Source, ...]:
        """Excitation with its random numbers drawn."""
        seed = self.parameters.random_seed
        override = None if seed == OWN_SEEDS else seed
        return tuple(source.realise(dx=self.dx, seed_override=override) for source in self.sources)

    @property
    def lateral(self) -> bool:
        """Whether the lateral position of the wheel on the rail makes a difference."""
        return self.geometry.shaped or any(source.across for source in self.sources)

    @cached_property
    def fingerprint(self) -> bytes:
        """Hash of all that shapes a run apart from the parameters; 16 bytes."""
        tangential = None if self.tangential is None else self.tangential.to_parts()
        digest = hashlib.blake2b(repr((self.dx, self.start_inputs, tangential)).encode(), digest_size=16)
        meta, arrays = self.contact.to_parts()
        _update(digest, meta, arrays)
        for wheel in (self.wheel, self.held_wheel):
            if wheel is not None:
                _update(digest, *response_to_parts(wheel))
        if self.track is not None:
            digest.update(repr(self.track.values.shape).encode())
            digest.update(self.track.values.data)
        _update(digest, *self.geometry.to_parts())
        for source in self.sources:
            _update(digest, *source.to_parts())
        return digest.digest()

    def configured(self, **values: Any) -> Model:
        """Return a model with some parameters changed; the precomputed parts are shared.

        Parameters
        ----------
        **values
            As `Parameters` names them.

        Raises
        ------
        ParameterError
            If a value is not allowed, or would need other Green's functions.
        """
        parameters = self.parameters.changed(**values)
        built = self.parameters.speed
        if abs(parameters.speed - built) > _SPEED_TOLERANCE * built:
            if self.wheel is not None or self.track is not None:
                raise ParameterError(
                    "speed",
                    parameters.speed,
                    f"the Green's functions in this model are for {built!r} m/s; build one for this speed "
                    '(set simulation.speed in the case file and run "wheelrail build")',
                )
        elif parameters.speed != built:
            parameters = parameters.changed(speed=built)
        cells = parameters.start_position / self.dx
        if abs(cells - round(cells)) > 1e-6:
            raise ParameterError(
                "start_position",
                parameters.start_position,
                f"must be a multiple of dx = {self.dx:g} m; the nearest is {round(cells) * self.dx:g} m",
            )
        return replace(self, parameters=parameters)


def _update(digest: Any, meta: dict[str, Any], arrays: dict[str, NDArray]) -> None:
    """Add a description and its arrays to a hash."""
    digest.update(json.dumps(meta, sort_keys=True).encode())
    for name in sorted(arrays):
        digest.update(name.encode() + np.ascontiguousarray(arrays[name]).tobytes())
