"""Squeal at constant friction (Pieringer 2011, section 5.3.1): runs in time against the stability of sliding.

The case is examples/cases/squeal.toml. What the thesis found in 108 runs with its wheel: stick/slip only for negative
lateral creepage and contact towards the field side, at axial modes without nodal circles. The synthetic wheel's web is
not symmetric: what is the centre for one of its modes is not the tread's centre, and not that of another mode. The
stability check uses neither the contact algorithm nor the Green's functions of the runs.
"""

import copy
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import butter, hilbert, sosfiltfilt

from wheelrail.analysis.sliding_case import sliding_loop
from wheelrail.analysis.squeal import nearest_mode, squeal_measures
from wheelrail.analysis.stability import SlidingLoop, mode_stability, unstable_count
from wheelrail.case import Case, case_from_dict
from wheelrail.interaction.build import build_model
from wheelrail.interaction.simulate import Simulation
from wheelrail.interaction.tracks import track_of

CASE = Path(__file__).parents[2] / "examples" / "cases" / "squeal.toml"
PRELOAD = 65e3
RECORD = ["force_y", "force_z", "slip_fraction"]


def squeal_case(*, contact_position: float = 20e-3, creepage: float = -1e-2, damping=None, friction=0.3) -> Case:
    """Vary the case."""
    data = copy.deepcopy(tomllib.loads(CASE.read_text(encoding="utf-8")))
    data["wheel"]["contact_position"] = contact_position
    data["creepage"]["y"] = creepage
    data["friction"]["coefficient"] = friction
    if damping is not None:
        data["wheel"]["damping"] = damping
    return case_from_dict(data)


@pytest.fixture(scope="module")
def rail():
    """Receptance of the rail, which is the same in all cases."""
    return track_of(squeal_case()).receptance


def loop_of(case: Case, rail) -> SlidingLoop:
    return replace(sliding_loop(case), rail=rail)


def growing(case: Case, rail) -> dict[str, float]:
    """Growth rates (1/s) of the wheel modes that grow."""
    return {mode.name: mode.growth_rate for mode in mode_stability(loop_of(case, rail)) if mode.unstable}


def run(case: Case, duration: float) -> dict[str, np.ndarray]:
    blocks = list(Simulation(build_model(case), duration=duration, record=RECORD))
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def test_20_mm_towards_the_field_side_axial_modes_grow_at_negative_creepage_only(rail) -> None:
    found = growing(squeal_case(), rail)
    assert set(found) == {"2,0,a", "3,0,a", "5,0,a"}
    assert max(found, key=lambda name: found[name]) == "5,0,a"
    assert growing(squeal_case(creepage=1e-2), rail) == {}


@pytest.mark.slow
def test_every_mode_that_grows_anywhere_is_axial_without_nodal_circles(rail) -> None:
    for position in (-20e-3, 0.0, 10e-3, 30e-3):
        for creepage in (-1e-2, 1e-2):
            for name in growing(squeal_case(contact_position=position, creepage=creepage), rail):
                assert name.endswith(",0,a")


def test_at_the_tread_centre_growth_is_a_tenth(rail) -> None:
    # The web is not symmetric, so lateral and vertical motion are not quite free of each other at the centre either.
    # Found: 1.5 1/s of (2,0,a) against 20.4 1/s of (5,0,a) 20 mm towards the field side.
    centre = growing(squeal_case(contact_position=0.0), rail)
    assert max(centre.values()) < 0.1 * max(growing(squeal_case(), rail).values())


def test_positive_creepage_makes_modes_grow_where_their_coupling_has_the_other_sign(rail) -> None:
    # Found: (5,0,a) 22.9 and (3,0,a) 2.1 1/s at the centre; (3,0,a) 16.6 and (2,0,a) 14.8 1/s towards the flange.
    centre = growing(squeal_case(contact_position=0.0, creepage=1e-2), rail)
    assert set(centre) == {"5,0,a", "3,0,a"}
    assert centre["5,0,a"] > 10.0 * centre["3,0,a"]
    flange = growing(squeal_case(contact_position=-20e-3, creepage=1e-2), rail)
    assert set(flange) == {"3,0,a", "2,0,a"}
    assert growing(squeal_case(contact_position=-20e-3), rail) == {}


@pytest.mark.parametrize(
    ("position", "creepage", "friction"), [(20e-3, -1e-2, 0.3), (10e-3, -1e-2, 0.3), (0.0, 1e-2, 0.6)]
)
def test_modes_in_contact_are_zeros_of_the_return_difference(rail, position, creepage, friction) -> None:
    """Also (1,c) and (4,r), whose zeros lie close to each other."""
    loop = loop_of(squeal_case(contact_position=position, creepage=creepage, friction=friction), rail)
    modes = mode_stability(loop)
    found = [mode for mode in modes if mode.converged]
    assert len(found) >= len(modes) - 1
    for mode in found:
        omega, zeta = 2.0 * np.pi * mode.coupled_frequency, mode.coupled_damping_ratio
        s = omega * (-zeta + 1j * np.sqrt(1.0 - zeta**2))
        nearby = loop.return_difference(np.array([s, s * (1.0 + 1e-5)]))
        assert abs(nearby[0]) < 1e-3 * abs(nearby[1])  # achieved: 1e-4


def test_little_friction_and_much_damping_keep_it_stable(rail) -> None:
    assert growing(squeal_case(damping=1e-2), rail) == {}
    assert growing(squeal_case(friction=0.05), rail) == {}


@pytest.mark.slow
def test_nyquist_counts_the_modes_that_grow(rail) -> None:
    for case in (squeal_case(), squeal_case(creepage=1e-2), squeal_case(damping=1e-2)):
        assert unstable_count(loop_of(case, rail), highest_frequency=2e4) == len(growing(case, rail))


@pytest.mark.slow
def test_stick_slip_develops_at_an_axial_mode() -> None:
    case = squeal_case()
    result = run(case, 1.0)
    dt = result["time"][1]
    late = result["time"] > 0.7
    measures = squeal_measures(force_y=result["force_y"][late], slip_fraction=result["slip_fraction"][late], dt=dt)
    # Found: a part sticks in 42 % of the steps, at 3137 Hz. At dx 0.5 mm it is 48 %: 4.4 steps make one cycle here.
    assert measures.stick_share == pytest.approx(0.42, abs=0.05)
    modes = [mode for mode in sliding_loop(case).wheel.modes if mode.shape[1]]
    mode = nearest_mode(modes, measures.main_frequency)
    assert mode.name == "5,0,a"
    assert measures.main_frequency == pytest.approx(mode.frequency, rel=3e-3)  # achieved: 1.2e-3
    # In full sliding the lateral force is at the traction bound, in stick below, never above.
    bound = 0.3 * result["force_z"]
    assert np.all(np.abs(result["force_y"]) <= bound * (1.0 + 1e-9))
    sticking = result["slip_fraction"] < 1.0
    assert np.all(result["force_y"][late & ~sticking] > 0.99 * bound[late & ~sticking])
    assert np.any(result["force_y"][late & sticking] < 0.95 * bound[late & sticking])


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes",
    [{"creepage": 1e-2}, {"damping": 1e-2}, {"friction": 0.05}],
    ids=["positive creepage", "more damping", "little friction"],
)
def test_nothing_develops_where_sliding_is_stable(changes, rail) -> None:
    case = squeal_case(**changes)
    assert growing(case, rail) == {}
    result = run(case, 1.0)
    late = result["time"] > 0.7
    assert np.all(result["slip_fraction"][late] == 1.0)
    # What remains is the answer to the corrugation of 0.1 um.
    assert np.abs(result["force_z"][late] - PRELOAD).max() < 100.0


@pytest.mark.slow
def test_stick_slip_is_not_reached_at_the_tread_centre_in_the_time_of_the_thesis(rail) -> None:
    """What grows there, with 1.5 1/s by the check, does so slowly: from 0.1 um it takes more than the thesis' 3.5 s."""
    case = squeal_case(contact_position=0.0)
    result = run(case, 3.5)
    time, force = result["time"], result["force_z"] - PRELOAD
    late = time > 3.0
    assert np.all(result["slip_fraction"][late] == 1.0)
    assert np.abs(force[late]).max() < 200.0
    (mode,) = (mode for mode in mode_stability(loop_of(case, rail)) if mode.unstable)
    band = mode.coupled_frequency + np.array([-30.0, 30.0])
    filtered = sosfiltfilt(butter(4, band, btype="band", fs=1.0 / time[1], output="sos"), force)
    steady = (time > 1.5) & (time < 3.0)
    growth = np.polyfit(time[steady], np.log(np.abs(hilbert(filtered))[steady]), 1)[0]
    # Achieved: 1.1 and 1.5 1/s; the unsaturated contact takes 0.44 1/s, see below.
    assert growth == pytest.approx(mode.growth_rate - 0.44, abs=0.1)


@pytest.mark.slow
def test_modes_grow_in_time_as_the_stability_check_says(rail) -> None:
    """Growth of the run's force in a narrow band against the zeros of the return difference.

    Found in the run and by the check, 1/s: (2,0,a) 14.97 and 15.36, (3,0,a) 13.30 and 14.89, (5,0,a) 23.21 and 20.37.
    The check is continuous in time. With the run's own discretised functions and its contact stiffness on the grid it
    says 15.43, 13.59 and 23.25. What is left (3, 2 and 0.2 %) is the lateral damping of a contact that slides but is
    not quite saturated: 1 - F / (mu P) = 2.0e-4 at 1 %, whose slope of 58 N s/m takes 0.44 1/s from (2,0,a).
    """
    case = squeal_case()
    result = run(case, 0.35)
    time, force = result["time"], result["force_z"] - PRELOAD
    found = discrete_growth(case, rail)
    for mode in mode_stability(loop_of(case, rail)):
        if not mode.unstable:
            continue
        band = mode.coupled_frequency + np.array([-60.0, 60.0])
        filtered = sosfiltfilt(butter(4, band, btype="band", fs=1.0 / time[1], output="sos"), force)
        steady = (time > 0.2) & (time < 0.3)
        growth = np.polyfit(time[steady], np.log(np.abs(hilbert(filtered))[steady]), 1)[0]
        assert growth == pytest.approx(found[mode.name], rel=0.04)
        assert found[mode.name] == pytest.approx(mode.growth_rate, rel=0.2)


def discrete_growth(case: Case, rail) -> dict[str, float]:
    """Growth rates with the discretised functions of the run: zeros of 1 + k (H + G) in z."""
    model = build_model(case)
    wheel, functions = model.wheel, model.track.values[0]
    stiffness = next(iter(Simulation(model, duration=0.0, record=["contact_stiffness_z"])))["contact_stiffness_z"][0]
    force = np.array([0.0, 0.3, 1.0])
    ages = np.arange(functions.shape[-1], dtype=float)
    n = wheel.own.shape[1]

    def difference(s: complex) -> complex:
        z = np.exp(s * model.dt)
        determinant = (z - wheel.own[0]) * (z - wheel.own[1]) - wheel.cross[0] * wheel.cross[1]
        upper, lower = wheel.drive[:, :n], wheel.drive[:, n:]
        first = ((z - wheel.own[1]) * upper + wheel.cross[0] * lower) / determinant
        second = ((z - wheel.own[0]) * lower + wheel.cross[1] * upper) / determinant
        compliance = wheel.output[:, :n] @ first.T + wheel.output[:, n:] @ second.T + wheel.first
        compliance = compliance + np.einsum("fdn,n->df", functions, z**-ages)
        return 1.0 + stiffness * (compliance @ force)[2]

    result = {}
    for mode in mode_stability(loop_of(case, rail)):
        if not mode.unstable:
            continue
        before = 2j * np.pi * mode.coupled_frequency + mode.growth_rate
        now = before * (1.0 + 1e-5)
        at_before, at_now = difference(before), difference(now)
        for _ in range(50):
            before, now, at_before = now, now - at_now * (now - before) / (at_now - at_before), at_now
            if abs(now - before) < 1e-10 * abs(now):
                break
            at_now = difference(now)
        result[mode.name] = now.real
    return result
