import numpy as np
import pytest


def dense_dynamic_stiffness(track, frequency):
    """Dynamic stiffness of rail and sleepers, assembled naively; clamped degrees of freedom removed."""
    nodes = track.nodes
    omega = 2 * np.pi * frequency
    size = 2 * nodes + track.bays - 1
    matrix = np.zeros((size, size), dtype=complex)
    stiffness, mass = track.element_matrices()
    for e in range(nodes - 1):
        matrix[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += stiffness - omega**2 * mass
    pad = track.pad_stiffness + 1j * omega * track.pad_damping
    ballast = track.ballast_stiffness + 1j * omega * track.ballast_damping
    for k in range(track.bays - 1):
        rail, sleeper = 2 * (k + 1) * track.elements_per_bay, 2 * nodes + k
        matrix[rail, rail] += pad
        matrix[sleeper, sleeper] += pad + ballast - omega**2 * track.sleeper_mass
        matrix[rail, sleeper] -= pad
        matrix[sleeper, rail] -= pad
    free = np.delete(np.arange(size), [0, 1, 2 * nodes - 2, 2 * nodes - 1])
    return matrix, free


@pytest.mark.parametrize("frequency", [0.0, 37.0, 228.0, 943.0, 3000.0])
def test_receptance_against_a_dense_matrix(thesis_track, frequency):
    track = thesis_track(bays=6, elements_per_bay=3)
    matrix, free = dense_dynamic_stiffness(track, frequency)
    force = np.zeros(len(matrix))
    node = (track.nodes - 1) // 2 + 2
    force[2 * node] = 1.0
    response = np.zeros(len(matrix), dtype=complex)
    response[free] = np.linalg.solve(matrix[np.ix_(free, free)], force[free])
    x = (np.arange(track.nodes) - (track.nodes - 1) // 2) * track.element_length
    found = track.receptance(x[node], x, [frequency])[0]
    np.testing.assert_allclose(found, response[: 2 * track.nodes : 2], atol=1e-12 * np.abs(response).max())
    if frequency == 0.0:
        np.testing.assert_allclose(track.static_compliance(x[node], x), found.real, atol=1e-13 * np.abs(found).max())
    assert track.degrees_of_freedom == len(free)


def test_reciprocity(thesis_track):
    track, rng = thesis_track(), np.random.default_rng(1)
    for _ in range(40):
        a, b = rng.uniform(-track.half_length, track.half_length, 2) * [0.3, 0.6]
        f = [10.0 ** rng.uniform(0.5, 3.7)]
        there, back = track.receptance(a, [b], f)[0, 0], track.receptance(b, [a], f)[0, 0]
        scale = abs(track.receptance(a, [a], f)[0, 0])
        assert abs(there - back) <= 1e-10 * scale  # achieved: 8e-15
        assert there != back or a == b


def test_symmetry(thesis_track):
    track = thesis_track()
    for a, b in ((0.0, 0.7), (0.1, -0.4), (1.3, 2.21)):
        one, other = (track.receptance(s * a, [s * b], [30.0, 943.0, 2500.0]) for s in (1, -1))
        np.testing.assert_allclose(one, other, rtol=1e-9)


def test_passivity(thesis_track):
    """With exp(+i omega t) forces can only put power in: minus the imaginary part is positive semi-definite."""
    track, rng = thesis_track(), np.random.default_rng(2)
    for f in (5.0, 110.0, 228.0, 943.0, 1300.0, 4000.0):
        x = rng.uniform(-2.0, 2.0, 6)
        matrix = np.stack([track.receptance(a, x, [f])[0] for a in x])
        loss = -matrix.imag
        lowest = np.linalg.eigvalsh(0.5 * (loss + loss.T)).min()
        assert lowest >= -1e-12 * np.abs(matrix).max()  # achieved: -4e-15
        assert np.all(np.diag(loss) > 0.0)


def test_bay_shape_functions_agree_with_the_interpolation(thesis_track):
    track = thesis_track(bays=20)
    positions = 13
    rng = np.random.default_rng(4)
    motion = rng.normal(size=2 * (track.nodes - 2))
    shapes = track.bay_shape_functions(positions)
    for bay in (0, 3):
        x = (bay + np.arange(positions) / positions) * track.sleeper_spacing
        columns, weights = track.interpolation(x)
        first = 2 * ((track.bays // 2 + bay) * track.elements_per_bay - 1)
        nodal = motion[first : first + shapes.shape[1]]
        np.testing.assert_allclose(shapes @ nodal, np.einsum("ij,ij->i", weights, motion[columns]), atol=1e-12)


def test_clamped_ends_do_not_move(thesis_track):
    track = thesis_track(bays=20)
    ends = [-track.half_length, track.half_length]
    np.testing.assert_array_equal(track.receptance(0.0, ends, [100.0]), 0.0)
    np.testing.assert_array_equal(track.static_compliance(0.0, ends), 0.0)


@pytest.mark.parametrize("x", [-6.51, 6.51])
def test_points_outside_are_refused(thesis_track, x):
    track = thesis_track(bays=20)
    with pytest.raises(ValueError, match=r"6\.5 m"):
        track.receptance(x, [0.0], [100.0])
    with pytest.raises(ValueError, match=r"6\.5 m"):
        track.static_compliance(0.0, [x])


def test_support_stiffness_is_a_series_of_springs(thesis_track):
    track = thesis_track()
    assert track.support_stiffness(0.0) == pytest.approx(1 / (1 / 120e6 + 1 / 140e6), abs=0, rel=1e-14)
    high = track.support_stiffness(1e6)  # the sleeper stands still: the pad alone
    assert high == pytest.approx(120e6 + 2j * np.pi * 1e6 * 16e3, abs=0, rel=1e-4)
