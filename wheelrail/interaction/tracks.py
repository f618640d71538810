"""From ``[track]`` of a case to a track, and to its response in the time step."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..case import Case
from ..case.track_sections import RAIL_SECTIONS
from ..errors import CaseError
from ..greens.cache import cached_greens, cached_moving_greens, find_cached, find_greens
from ..greens.first_samples import with_first
from ..greens.moving import MovingGreens
from ..greens.track_response import TrackResponse
from ..greens.waveguide import ENERGY_TOLERANCE, HORIZON, compute_waveguide_greens
from ..track.discrete import DiscreteTrack
from ..track.waveguide_settings import ELEMENT_SIZE, MARGIN, RING_LENGTH, SPACING
from .wheel_sources import data_digest

if TYPE_CHECKING:
    from ..track.waveguide import WaveguideTrack

    TrackModel = DiscreteTrack | WaveguideTrack
else:
    TrackModel = DiscreteTrack  # the waveguide's finite elements are imported when they are needed only

__all__ = ["TrackModel", "find_greens_of", "greens_of", "memory_of", "track_of", "track_receptance", "track_response"]

ALGORITHM = 3  # of the waveguide's Green's functions, raised whenever the same input gives other numbers
_TRIPLES = ("pad_stiffness", "pad_damping", "ballast_stiffness", "ballast_damping")


def track_of(case: Case) -> DiscreteTrack | WaveguideTrack | None:
    """Make the track model of a case; None for a rigid track.

    Raises
    ------
    CaseError, DataFileError
        If the keys of a waveguide do not go with its section.
    """
    track = case.track
    if track.model == "rigid":
        return None
    if track.model == "discrete":
        return DiscreteTrack(**track.model_dump(exclude={"model", "preset", "memory"}))
    return _waveguide(case)


def _waveguide(case: Case) -> WaveguideTrack:
    # Finite elements are imported when they are needed only: they take long.
    from ..track.safe_matrices import Material, Pad
    from ..track.section_sources import load_section
    from ..track.supported_ring import Supports
    from ..track.waveguide import WaveguideTrack

    given: Any = case.track
    material = ("youngs_modulus", "poisson_ratio", "density", "loss_factor")
    try:
        if given.support == "continuous":
            pad = Material(**{key: getattr(given, f"pad_{key}") for key in material})
            support: Pad | Supports = Pad(material=pad, thickness=given.pad_thickness, width=given.pad_width)
        else:
            support = Supports(
                spacing=given.sleeper_spacing,
                pad_width=given.pad_width,
                sleeper_mass=given.sleeper_mass,
                **{name: _triple(given, name) for name in _TRIPLES},
            )
        track = WaveguideTrack(
            section=load_section(given.section, case.folder),
            material=Material(**{key: getattr(given, key) for key in material}),
            support=support,
            contact_position=given.contact_position,
            max_frequency=given.max_frequency,
        )
        _ = track.matrices  # a contact beside the head or a pad too wide shows here
        return track
    except ValueError as error:
        raise CaseError("track", [str(error)]) from error


def _triple(given: Any, name: str) -> tuple[float, float, float]:
    """Values for (x', y', z') of a key with a longitudinal and a lateral sibling."""
    part, kind = name.split("_")
    return (
        getattr(given, f"{part}_longitudinal_{kind}"),
        getattr(given, f"{part}_lateral_{kind}"),
        getattr(given, name),
    )


def memory_of(case: Case) -> float | None:
    """Length that a case sets for the moving Green's functions in s; None where it follows from their decay."""
    return None if case.track.model == "rigid" else case.track.memory


def track_receptance(track: DiscreteTrack | WaveguideTrack, x: float, frequency: ArrayLike) -> NDArray:
    """Vertical point receptance of the track (m/N) at a place x (m from a sleeper) and frequencies in Hz."""
    if isinstance(track, DiscreteTrack):
        return track.receptance(x, [x], np.asarray(frequency))[:, 0]
    return track.receptance(frequency, x)[:, 2, 2]


def _waveguide_content(case: Case) -> dict[str, Any]:
    """Everything that the Green's functions of a waveguide track depend on."""
    simulation, given = case.simulation, case.track
    keys = given.model_dump(exclude={"model", "preset", "section"}, exclude_none=True)
    section = data_digest(case, given.section, RAIL_SECTIONS)  # type: ignore[union-attr]
    return {
        "kind": "waveguide",
        "algorithm": ALGORITHM,
        "section": section,
        "track": keys,
        "speed": simulation.speed,
        "dx": simulation.dx,
        "energy_tolerance": ENERGY_TOLERANCE,
        "horizon": HORIZON,
        "element_size": ELEMENT_SIZE,
        "wavenumber_spacing": SPACING,
        "basis_margin": MARGIN,
        "ring_length": RING_LENGTH,
    }


def find_greens_of(case: Case) -> MovingGreens | None:
    """Look up the moving Green's functions of a case in the cache; None if it has none, or they are not there."""
    if case.track.model == "rigid":
        return None
    if case.track.model == "waveguide":
        return find_greens(_waveguide_content(case))
    track = track_of(case)
    assert isinstance(track, DiscreteTrack)
    simulation = case.simulation
    return find_cached(track, speed=simulation.speed, dx=simulation.dx, memory=memory_of(case))


def greens_of(case: Case, progress: Callable[[float], None] | None = None) -> MovingGreens | None:
    """Get the moving Green's functions of a case from the cache, or compute them.

    Parameters
    ----------
    case : Case
    progress : callable, optional
        Called with the share done; not called if they come from the cache.

    Returns
    -------
    MovingGreens or None
        Values of shape (positions, samples), or (positions, 3, 3, samples) for a waveguide; None for a rigid track.

    Raises
    ------
    CaseError
        If the keys do not go together.
    """
    simulation = case.simulation
    settings: dict[str, Any] = {"speed": simulation.speed, "dx": simulation.dx, "memory": memory_of(case)}
    try:
        if case.track.model == "waveguide":
            given: Any = case.track

            return cached_greens(
                _waveguide_content(case),
                lambda: compute_waveguide_greens(_waveguide(case), **settings, progress=progress),  # type: ignore[arg-type]
                description=f"waveguide {given.section}, {given.support}, {simulation.speed * 3.6:.4g} km/h, "
                f"dx {simulation.dx * 1e3:g} mm",
            )
        track: Any = track_of(case)
        return None if track is None else cached_moving_greens(track, **settings, progress=progress)
    except ValueError as error:
        raise CaseError("track", [str(error)]) from error


def track_response(
    case: Case, *, directions: int, progress: Callable[[float], None] | None = None
) -> tuple[TrackResponse | None, dict[str, Any]]:
    """Make the response of a case's track.

    Parameters
    ----------
    case : Case
    directions : int
        3, or 1 for the vertical alone; a beam has the vertical one in any case.
    progress : callable, optional
        As `greens_of` takes it.

    Returns
    -------
    response : TrackResponse or None
    report : dict
        Facts about it, for people.
    """
    greens = greens_of(case, progress)
    if greens is None:
        return None, {}
    values = greens.values
    values = values[:, None, None, :] if values.ndim == 2 else values[:, 3 - directions :, 3 - directions :, :]
    kept = case.simulation.first_sample == "kept"
    if values.shape[1] > 1 or not kept:
        values = np.concatenate([with_first(values[..., 0], kept=kept)[..., None], values[..., 1:]], axis=-1)
    report = {
        "functions": int(np.prod(values.shape[:-1])),
        "directions": values.shape[1],
        "samples": values.shape[-1],
        "memory": values.shape[-1] * greens.dt,
        "horizon": greens.horizon,
        "neglected_energy": float(greens.neglected_energy.max()),
        "neglected_compliance": float(np.abs(greens.neglected_compliance).max()),
    }
    return TrackResponse(values), report
