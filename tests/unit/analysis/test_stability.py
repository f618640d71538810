"""Stability of sliding: against the eigenvalues of the assembled system."""

from dataclasses import replace

import numpy as np
import pytest

from wheelrail.analysis.stability import SlidingLoop, mode_stability, unstable_count
from wheelrail.wheel.modes import FlexibleWheel, Mode, rigid_modes

CONTACT_STIFFNESS = 1.2e9
FRICTION = 0.3
RAIL = (6.0, 2e4, 4e8)  # mass, damping, stiffness of a rail that moves vertically and laterally alike


def wheel(sign: float = 1.0) -> FlexibleWheel:
    """Two modes with coupled lateral and vertical motion, one without, on a suspended mass."""
    modes = (
        Mode.with_frequency(
            name="2,0,a", mass=30.0, frequency=420.0, damping_ratio=1e-4, shape=(0.0, 1.0, 0.25 * sign)
        ),
        Mode.with_frequency(name="3,0,a", mass=25.0, frequency=1150.0, damping_ratio=1e-4, shape=(0.0, 1.0, -0.2)),
        Mode.with_frequency(name="2,r", mass=40.0, frequency=1900.0, damping_ratio=1e-3, shape=(0.0, 0.05, 1.0)),
        Mode.with_frequency(name="2,c*", mass=40.0, frequency=2500.0, damping_ratio=1e-3, shape=(1.0, 0.0, 0.0)),
    )
    return FlexibleWheel(modes, rigid_modes(mass=600.0, suspension_stiffness=1e6, suspension_damping=1e4))


def rail(frequency):
    """Receptance of the rail's oscillator in y' and z'."""
    s = 2j * np.pi * np.asarray(frequency)
    mass, damping, stiffness = RAIL
    return (1.0 / (mass * s**2 + damping * s + stiffness))[:, None, None] * np.diag([0.0, 1.0, 1.0])


def assembled_poles(flexible: FlexibleWheel, creepage) -> np.ndarray:
    """Eigenvalues of wheel, rail and the follower force of sliding friction in one system."""
    slip = np.array([*creepage, 0.0])
    force = np.array([0.0, 0.0, 1.0]) - FRICTION * slip / np.hypot(*creepage)
    modes = flexible.all_modes
    shapes = np.vstack([flexible.shapes, [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]])  # approach = wheel less rail
    mass = np.array([mode.mass for mode in modes] + [RAIL[0]] * 2)
    damping = np.diag([mode.damping for mode in modes] + [RAIL[1]] * 2)
    stiffness = np.diag([mode.stiffness for mode in modes] + [RAIL[2]] * 2)
    stiffness = stiffness + CONTACT_STIFFNESS * np.outer(shapes @ force, shapes[:, 2])
    size = len(mass)
    system = np.block([[np.zeros((size, size)), np.eye(size)], [-stiffness / mass[:, None], -damping / mass[:, None]]])
    poles = np.linalg.eigvals(system)
    return poles[poles.imag > 0.0]


@pytest.mark.parametrize("creepage", [(0.0, -0.01), (0.0, 0.01), (0.004, -0.01)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_coupled_modes_are_eigenvalues_of_the_assembled_system(creepage, sign) -> None:
    loop = SlidingLoop(wheel(sign), rail, CONTACT_STIFFNESS, FRICTION, creepage)
    poles = assembled_poles(loop.wheel, creepage)
    found = mode_stability(loop)
    assert {entry.name for entry in found} == {"2,0,a", "3,0,a", "2,r"}
    for entry in found:
        nearest = poles[np.argmin(np.abs(np.abs(poles) - 2.0 * np.pi * entry.coupled_frequency))]
        # Achieved: 1e-15 and 5e-16.
        assert entry.coupled_frequency == pytest.approx(np.abs(nearest) / (2.0 * np.pi), rel=1e-12)
        assert entry.coupled_damping_ratio == pytest.approx(-nearest.real / np.abs(nearest), abs=1e-12)
    growing = int(np.count_nonzero(poles.real > 0.0))
    assert unstable_count(loop, highest_frequency=2e4) == growing


def test_the_sign_of_the_creepage_decides() -> None:
    def names(creepage: float) -> set[str]:
        loop = SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, FRICTION, (0.0, creepage))
        return {entry.name for entry in mode_stability(loop) if entry.unstable}

    assert names(-0.01) != names(0.01)
    assert names(-0.01) | names(0.01)


def test_without_friction_everything_decays() -> None:
    loop = SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, 0.0, (0.0, -0.01))
    assert not any(entry.unstable for entry in mode_stability(loop))
    assert unstable_count(loop, highest_frequency=2e4) == 0


def test_no_creepage_has_no_direction() -> None:
    with pytest.raises(ValueError, match="no direction of sliding"):
        SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, FRICTION, (0.0, 0.0)).force_direction()


# Friction that changes with the slip velocity

LOAD = 65e3
SPEED = 0.2
NO_RAIL = np.zeros((0, 3)), np.zeros((0, 3))


def oscillators(properties, shapes):
    """Receptance of a rail of oscillators: rows of mass, damping, stiffness, and their shapes (n, 3)."""

    def receptance(frequency):
        s = 2j * np.pi * np.asarray(frequency)[:, None]
        mass, damping, stiffness = np.transpose(properties)
        return np.einsum("nm,mi,mj->nij", 1.0 / (mass * s**2 + damping * s + stiffness), shapes, shapes)

    return receptance


def state_matrix(loop: SlidingLoop, properties, shapes) -> np.ndarray:
    """Wheel, rail, contact springs, friction law and memory as one system x' = A x.

    Written from the equations of motion in time: displacements q and velocities v of the oscillators, then, where it is
    a state of its own, the friction force along the sliding (contact spring without memory) or the change of the
    friction coefficient (memory).
    """
    modes = loop.wheel.all_modes
    mass = np.array([mode.mass for mode in modes] + [row[0] for row in properties])
    damping = np.array([mode.damping for mode in modes] + [row[1] for row in properties])
    stiffness = np.array([mode.stiffness for mode in modes] + [row[2] for row in properties])
    along = np.array([*loop.creepage, 0.0]) / np.hypot(*loop.creepage)
    # Rail less wheel; a force on the rail drives the oscillators by the same factors.
    relative = np.vstack([-loop.wheel.shapes, np.reshape(shapes, (-1, 3))])
    z, e = relative[:, 2], relative @ along
    n = len(mass)
    fall, compliance = loop.load * loop.friction_slope, loop.tangential_compliance
    extra = loop.friction_slope != 0.0 and bool(loop.memory_distance or compliance)
    # Rows over (q, v, extra state).
    width = 2 * n + extra
    q, v = np.eye(n, width), np.eye(n, width, n)
    own = np.eye(1, width, 2 * n)[0]  # the extra state
    normal, normal_rate = -loop.contact_stiffness * z @ q, -loop.contact_stiffness * z @ v
    mu, slip_rate = loop.friction_coefficient, e @ v
    last = []
    if not extra:
        tangential = -mu * normal - fall * slip_rate
    elif loop.memory_distance == 0.0:
        # F = -mu F_n - N mu' (D' + C F')
        tangential = own
        last = [(-mu * normal - own - fall * slip_rate) / (fall * compliance)]
    else:
        # w' = (s_0 / d_c) (mu' (D' + C F') - w),  F = -mu F_n - N w
        tangential = -mu * normal - loop.load * own
        rate = loop.sliding_speed / loop.memory_distance
        drive = loop.friction_slope * (slip_rate - compliance * mu * normal_rate) - own
        last = [rate * drive / (1.0 + rate * fall * compliance)]
    force = np.outer(z, normal) + np.outer(e, tangential)
    acceleration = (force - damping[:, None] * v - stiffness[:, None] * q) / mass[:, None]
    return np.vstack([v, acceleration, *last])


def assert_among(entry, poles: np.ndarray, tolerance: float) -> complex:
    """A mode in contact is one of the poles; returns it."""
    assert entry.converged
    omega, zeta = 2.0 * np.pi * entry.coupled_frequency, entry.coupled_damping_ratio
    s = omega * (-zeta + 1j * np.sqrt(max(0.0, 1.0 - zeta**2)))
    nearest = poles[np.argmin(np.abs(poles - s))]
    assert abs(nearest - s) < tolerance * abs(s)
    return nearest


def growing_of(poles: np.ndarray) -> int:
    """Pairs of growing poles, and one more for a single real one."""
    return (int(np.count_nonzero(poles.real > 0.0)) + 1) // 2


# N mu' is 650 N s/m at 0.01 s/m, the oscillator's own damping 50 N s/m; the spring is critical at 1.3e-7 m.
LAWS = [
    pytest.param(-5e-4, 0.0, 0.0, id="falling"),
    pytest.param(-0.01, 0.0, 0.0, id="steeper"),
    pytest.param(0.01, 0.0, 0.0, id="rising"),
    pytest.param(-0.01, 1e-5, 0.0, id="memory"),
    pytest.param(-0.01, 1e-4, 0.0, id="long memory"),
    pytest.param(0.01, 1e-5, 0.0, id="rising with memory"),
    pytest.param(-0.01, 0.0, 1e-9, id="spring"),
    pytest.param(0.01, 0.0, 1e-9, id="rising with spring"),
    pytest.param(-0.01, 1e-5, 1e-9, id="spring and memory"),
    pytest.param(-0.01, 1e-7, 1e-9, id="spring and too short a memory"),
    pytest.param(-0.01, 1.5e-7, 1e-9, id="spring and hardly enough memory"),
]


@pytest.mark.parametrize(("slope", "memory", "compliance"), LAWS)
def test_a_lateral_oscillator_under_falling_friction(slope, memory, compliance) -> None:
    """Negative damping: without memory and contact spring m y'' + (c + N mu') y' + k y = 0."""
    mode = Mode.with_frequency(name="2,0,a", mass=30.0, frequency=420.0, damping_ratio=3e-4, shape=(0.0, 1.0, 0.0))
    loop = SlidingLoop(
        FlexibleWheel((mode,)),
        lambda frequency: np.zeros((len(frequency), 3, 3)),
        CONTACT_STIFFNESS,
        FRICTION,
        (0.0, -0.01),
        load=LOAD,
        sliding_speed=SPEED,
        friction_slope=slope,
        memory_distance=memory,
        tangential_compliance=compliance,
    )
    poles = np.linalg.eigvals(state_matrix(loop, *NO_RAIL))
    (entry,) = mode_stability(loop)
    assert_among(entry, poles, 1e-8)  # achieved: 1.5e-14
    if memory == compliance == 0.0:
        added = mode.damping + LOAD * slope
        assert entry.growth_rate == pytest.approx(-added / (2.0 * mode.mass), rel=1e-8)  # achieved: 1.6e-10
    for highest in (2e4, 1e8):  # with too short a memory the contact alone goes from 1 to -0.3 above 1 MHz
        assert unstable_count(loop, highest_frequency=highest) == growing_of(poles)
    runs_away = np.any((poles.imag == 0.0) & (poles.real > 0.0))
    assert loop.contact_unstable == runs_away
    assert loop.contact_unstable == (memory < loop.critical_memory_distance)


def random_system(seed: int, *, pairs: bool = False):
    """Wheel and rail with all directions coupled, a creepage in both directions, and any friction law."""
    rng = np.random.default_rng(seed)
    modes, shapes = [], rng.normal(size=(3, 3)) * [0.3, 1.0, 1.0]
    for i, frequency in enumerate(np.sort(rng.uniform(300.0, 5000.0, 5))):
        mass, ratio = rng.uniform(15.0, 60.0), 10.0 ** rng.uniform(-4.0, -2.5)
        modes.append(
            Mode.with_frequency(
                name=f"{i + 2},0,a",
                mass=mass,
                frequency=frequency,
                damping_ratio=ratio,
                shape=(0.0, rng.normal(), 0.3 * rng.normal()),
            )
        )
        if pairs:
            modes.append(replace(modes[-1], name=f"{i + 2},0,a*", shape=(0.3 * rng.normal(), 0.0, 0.0)))
    properties = [
        (mass, 2.0 * ratio * mass * omega, mass * omega**2)
        for mass, ratio, omega in zip(
            rng.uniform(4.0, 20.0, 3), rng.uniform(0.05, 0.3, 3), 2e3 * np.pi * rng.uniform(0.2, 2.0, 3), strict=True
        )
    ]
    rigid = rigid_modes(
        mass=600.0,
        suspension_stiffness=1e6,
        suspension_damping=1e4,
        lateral_mass=600.0,
        lateral_stiffness=4e6,
        lateral_damping=2e4,
    )
    loop = SlidingLoop(
        FlexibleWheel(tuple(modes), rigid),
        oscillators(properties, shapes),
        rng.uniform(0.5e9, 1.5e9),
        rng.uniform(0.1, 0.6),
        (0.01 * rng.normal(), 0.01 * rng.normal()),
        load=LOAD,
        sliding_speed=SPEED,
        friction_slope=-(10.0 ** rng.uniform(-3.0, -1.0)),
    )
    return loop, properties, shapes


@pytest.mark.parametrize("pairs", [False, True], ids=["single modes", "pairs of one frequency"])
@pytest.mark.parametrize(("memory", "compliance"), [(0.0, 0.0), (2e-6, 0.0), (0.0, 8e-10), (0.8, 8e-10), (1.5, 8e-10)])
@pytest.mark.parametrize("seed", range(8))
def test_coupled_modes_under_falling_friction(seed, memory, compliance, pairs) -> None:
    """With a contact spring the memory is a multiple of the critical one."""
    loop, properties, shapes = random_system(seed, pairs=pairs)
    loop = replace(loop, tangential_compliance=compliance)
    loop = replace(loop, memory_distance=memory * (loop.critical_memory_distance if compliance else 1.0))
    poles = np.linalg.eigvals(state_matrix(loop, properties, shapes))
    found = mode_stability(loop)
    assert {entry.name for entry in found} == {mode.name for mode in loop.wheel.modes}
    own = {assert_among(entry, poles, 1e-8) for entry in found}  # achieved: 7.6e-13
    assert len(own) == len(found)
    assert unstable_count(loop, highest_frequency=1e5) == growing_of(poles)


def test_along_the_rail_the_partner_turned_by_a_quarter_wave_is_the_one_that_grows() -> None:
    """Two modes of one frequency, one moved by the normal force only, the other by friction only."""
    modes = tuple(
        Mode.with_frequency(name=name, mass=30.0, frequency=1100.0, damping_ratio=1e-4, shape=shape)
        for name, shape in (("3,0,a", (0.0, 1.0, 0.2)), ("3,0,a*", (0.3, 0.0, 0.0)))
    )
    loop = SlidingLoop(
        replace(wheel(), modes=modes), rail, CONTACT_STIFFNESS, FRICTION, (-0.01, 0.0), LOAD, SPEED, friction_slope=-0.1
    )
    assert {entry.name: entry.unstable for entry in mode_stability(loop)} == {"3,0,a": False, "3,0,a*": True}
    still = mode_stability(replace(loop, friction_slope=0.0))
    assert [entry.name for entry in still] == ["3,0,a"]


def test_two_driven_modes_of_one_frequency_leave_one_motion_undriven_at_constant_friction() -> None:
    modes = tuple(
        Mode.with_frequency(name=name, mass=30.0, frequency=1100.0, damping_ratio=1e-3, shape=(0.0, y, z))
        for name, y, z in (("a", 1.0, 0.2), ("b", 0.5, -0.3))
    )
    loop = SlidingLoop(replace(wheel(), modes=modes), rail, CONTACT_STIFFNESS, FRICTION, (0.0, -0.01))
    poles = assembled_poles(loop.wheel, (0.0, -0.01))
    own = {assert_among(entry, poles, 1e-8) for entry in mode_stability(loop)}  # achieved: 2.7e-16
    assert len(own) == 2
    assert min(abs(np.abs(pole) / (2200.0 * np.pi) - 1.0) for pole in own) < 1e-8  # achieved: 2e-16


def test_at_constant_friction_the_return_difference_is_that_of_the_normal_force() -> None:
    """Also the load, the speed, the memory and the spring count for nothing then."""
    loop = SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, FRICTION, (0.004, -0.01))
    frequency = np.array([30.0, 419.0, 1151.0, 1900.0, 2500.0, 9e3])
    compliance = loop.wheel.receptance(frequency) + rail(frequency)
    expected = 1.0 + CONTACT_STIFFNESS * compliance[:, 2] @ loop.force_direction()
    assert loop.return_difference(2j * np.pi * frequency) == pytest.approx(expected, rel=1e-12)  # achieved: 1.7e-16
    other = replace(loop, load=LOAD, sliding_speed=SPEED, memory_distance=1e-5, tangential_compliance=1e-9)
    assert other.critical_memory_distance == 0.0
    assert not other.contact_unstable
    assert mode_stability(other) == mode_stability(loop)
    assert unstable_count(other, highest_frequency=2e4) == unstable_count(loop, highest_frequency=2e4)
    # A slope that is too small to matter takes the other way through the check: all modes are driven.
    nearly = {entry.name: entry for entry in mode_stability(replace(other, friction_slope=-1e-15))}
    for entry in mode_stability(loop):
        # Achieved: 2.9e-16.
        assert nearly[entry.name].coupled_damping_ratio == pytest.approx(entry.coupled_damping_ratio, abs=1e-12)
    assert nearly["2,c*"].coupled_damping_ratio == pytest.approx(1e-3, abs=1e-12)


def test_the_contact_runs_away_without_enough_memory() -> None:
    loop = SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, FRICTION, (0.0, -0.01), LOAD, SPEED, friction_slope=-0.01)
    assert loop.critical_memory_distance == 0.0
    loop = replace(loop, tangential_compliance=1e-9)
    assert loop.critical_memory_distance == pytest.approx(65e3 * 0.01 * 0.2 * 1e-9)
    assert loop.contact_unstable
    assert abs(loop.contact_difference(np.array([1.0 / (65e3 * 0.01 * 1e-9)]))[0]) < 1e-12
    assert not replace(loop, memory_distance=1.4e-7).contact_unstable
    assert replace(loop, friction_slope=0.01).critical_memory_distance == 0.0


@pytest.mark.parametrize(("frequency", "damping_ratio"), [(0.0, 0.0), (5.0, 0.1), (0.2, 0.1)])
def test_slow_divergence_of_a_lateral_mass_is_counted(frequency, damping_ratio) -> None:
    """Falling friction pushes a body on: one real zero if it is free, a pair on a spring, two real on a soft one."""
    body = Mode.with_frequency(
        name="lateral", mass=600.0, frequency=frequency, damping_ratio=damping_ratio, shape=(0.0, 1.0, 0.0)
    )
    loop = SlidingLoop(
        FlexibleWheel(wheel().modes[2:], (*wheel().rigid, body)),
        rail,
        CONTACT_STIFFNESS,
        0.0,
        (0.0, -0.01),
        LOAD,
        SPEED,
        friction_slope=-0.1,
    )
    poles = np.linalg.eigvals(state_matrix(loop, [RAIL, RAIL], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    slow = poles[(poles.real > 1e-6) & (np.abs(poles) < 2e2)]
    assert len(slow) == (1 if frequency == 0.0 else 2)
    assert np.all(slow.imag == 0.0) == (frequency < 1.0)
    assert unstable_count(loop, highest_frequency=2e4, lowest_frequency=0.01) == (np.sum(poles.real > 1e-6) + 1) // 2


@pytest.mark.parametrize("name", ["load", "sliding_speed", "memory_distance", "tangential_compliance"])
def test_negative_values_are_refused(name) -> None:
    loop = SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, FRICTION, (0.0, -0.01))
    with pytest.raises(ValueError, match=name):
        replace(loop, **{name: -1.0})
    with pytest.raises(ValueError, match=name):
        replace(loop, **{name: float("nan")})


def test_a_slope_needs_load_and_speed() -> None:
    loop = SlidingLoop(wheel(), rail, CONTACT_STIFFNESS, FRICTION, (0.0, -0.01))
    for given in ({"load": LOAD}, {"sliding_speed": SPEED}):
        with pytest.raises(ValueError, match="friction_slope: needs"):
            replace(loop, friction_slope=-0.01, **given)
