"""Discretely supported track: figures of Pieringer (2011), section 3.3.1, an independent code, the exact solution."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import minimize_scalar

from wheelrail.reference.exact_timoshenko_track import exact_receptance, pinned_pinned_frequency

DATA = Path(__file__).parents[1] / "data"
MID, SPACING = 0.325, 0.65


def peak_near(track, lowest: float, highest: float, x0: float = MID) -> float:
    def negative(f: float) -> float:
        return -abs(track.receptance(x0, [x0], [f])[0, 0])

    return minimize_scalar(negative, bounds=(lowest, highest), method="bounded", options={"xatol": 1e-4}).x


def test_static_stiffness(thesis_track):
    track = thesis_track()
    # Computed figures of the reference: 127.1 and 135.3 MN/m; achieved 127.07 and 135.27.
    assert 1.0 / track.static_compliance(MID, [MID])[0] == pytest.approx(127.1e6, abs=0.05e6)
    assert 1.0 / track.static_compliance(0.0, [0.0])[0] == pytest.approx(135.3e6, abs=0.05e6)
    # A whole bay further only the distance to the ends differs.
    assert track.static_compliance(MID - 5 * SPACING, [MID - 5 * SPACING]) == pytest.approx(
        track.static_compliance(MID, [MID]), rel=1e-8
    )


@pytest.mark.parametrize(("elements", "frequency"), [(8, 942.3), (16, 940.7)])
def test_pinned_pinned_peak(thesis_track, elements, frequency):
    """The peak belongs to the mesh: 942.3 Hz with 8 elements per bay (the thesis prints 943), 940.7 Hz with 16."""
    assert peak_near(thesis_track(elements_per_bay=elements), 930, 955) == pytest.approx(frequency, abs=0.1)


def test_other_extremes(thesis_track):
    track = thesis_track()
    f = np.arange(60.0, 400.0, 0.5)
    mid, sleeper = (np.abs(track.receptance(x, [x], f)[:, 0]) for x in (MID, 0.0))
    between = (f > 150) & (f < 300)
    assert f[between][np.argmin(mid[between])] == pytest.approx(220, abs=2)  # the sleepers as absorbers
    assert f[between][np.argmin(sleeper[between])] == pytest.approx(228, abs=2)
    assert f[np.argmax(mid)] == pytest.approx(110, abs=10)
    # Over a sleeper there is no peak at 943 Hz but a minimum behind it.
    g = np.arange(930.0, 1000.0, 0.5)
    assert g[np.argmin(np.abs(track.receptance(0.0, [0.0], g)[:, 0]))] == pytest.approx(964.5, abs=1.5)


def test_simply_supported_bay(thesis_track):
    """The rail alone between two sleepers: 943.1 Hz exactly; the element tends to it with the second order."""
    exact = pinned_pinned_frequency(thesis_track())
    assert exact == pytest.approx(943.1, abs=0.05)
    errors = []
    for n in (4, 8, 16, 32):
        stiffness, mass = (np.zeros((2 * n + 2,) * 2) for _ in range(2))
        for total, matrix in zip((stiffness, mass), thesis_track(elements_per_bay=n).element_matrices(), strict=True):
            for element in range(n):
                total[2 * element : 2 * element + 4, 2 * element : 2 * element + 4] += matrix
        free = np.delete(np.arange(2 * n + 2), [0, 2 * n])
        at = np.ix_(free, free)
        lowest = eigh(stiffness[at], mass[at], eigvals_only=True, subset_by_index=(0, 0))[0]
        errors.append(math.sqrt(lowest) / (2.0 * math.pi) / exact - 1.0)
    # Achieved: 9.4e-3, 2.3e-3, 5.9e-4, 1.5e-4. So short an element is ruled by shear, its deflection almost linear.
    assert errors[1] == pytest.approx(2.3e-3, abs=0, rel=0.1)
    for coarse, fine in pairwise(errors):
        assert coarse / fine == pytest.approx(4.0, abs=0.2)


def table() -> tuple[np.ndarray, np.ndarray]:
    lines = (DATA / "track_receptance_16_elements.csv").read_text(encoding="utf-8").splitlines()
    values = np.loadtxt([line for line in lines if not line.startswith("#")][1:], delimiter=",")
    return values[:, 0], values[:, 1::2] + 1j * values[:, 2::2]


def six_receptances(track, f) -> np.ndarray:
    return np.hstack(
        [
            track.receptance(MID, [MID, MID + SPACING, MID + 4 * SPACING], f),
            track.receptance(0.0, [0.0, SPACING, 4 * SPACING], f),
        ]
    )


def test_an_independent_beam_code(thesis_track):
    """The same mesh and data: every figure that the table prints."""
    f, expected = table()
    found = six_receptances(thesis_track(elements_per_bay=16, rotary_inertia=0.2398), f)
    np.testing.assert_allclose(found, expected, rtol=1e-6)  # achieved: 4.2e-7, its last digit


def test_how_far_the_coarser_mesh_is_from_it(thesis_track):
    """8 elements per bay: half a percent up to 600 Hz; the pinned-pinned peak stands 1.6 Hz too high."""
    f, expected = table()
    error = np.abs(six_receptances(thesis_track(), f) / expected - 1.0)
    assert error[f <= 600].max() < 5e-3  # achieved: 4.7e-3, four bays away; 1.4e-3 at the points of the force
    assert error[f <= 800][:, [0, 3]].max() < 5e-3  # achieved: 4.1e-3
    assert 0.1 < error[(f > 900) & (f < 980)].max() < 0.26  # achieved: 0.25


def test_elements_converge_to_the_exact_solution(thesis_track):
    """Receptances of ever finer meshes against Timoshenko's equations solved exactly; points between the nodes too."""
    f = np.array([50.0, 220.0, 500.0, 900.0, 1500.0, 2500.0])
    x = [MID, MID + SPACING, -0.1234]
    exact = exact_receptance(thesis_track(), MID, x, f)
    errors = np.array(
        [np.abs(thesis_track(elements_per_bay=n).receptance(MID, x, f) / exact - 1.0) for n in (16, 32, 64, 128)]
    )
    # Achieved at 128: 7e-8, 2e-6, 7e-6, 1.2e-4, 1.2e-4, 1.6e-3
    assert np.all(errors[-1].max(axis=1) < [1e-7, 3e-6, 1e-5, 2e-4, 2e-4, 2e-3])
    # Between nodes the place in the element changes from mesh to mesh, and with it the factor.
    rate = np.log2(errors[1:-1, :, :2] / errors[2:, :, :2])
    assert np.all(np.abs(rate - 2.0) < 0.1)  # achieved: 0.02


def test_exact_solution_at_rest(thesis_track):
    """Statically the elements are exact: the exact solution at almost no frequency must give the same."""
    track = thesis_track()
    x = [MID, 0.0, -0.1234, 3.21]
    # Achieved: 6e-10.
    found = exact_receptance(track, MID, x, [1e-3])[0]
    np.testing.assert_allclose(found.real, track.static_compliance(MID, x), rtol=1e-8, atol=1e-18)
    # Inside elements too, at the force and beside it in the same element.
    for x0 in (0.01, 0.1, -0.2):
        found = exact_receptance(track, x0, [x0, x0 + 0.011, 0.4], [1e-3])[0]
        np.testing.assert_allclose(found.real, track.static_compliance(x0, [x0, x0 + 0.011, 0.4]), rtol=1e-8)


def test_point_receptance_inside_an_element(thesis_track):
    """Along one element the rail must not look stiffer between its nodes than it is."""
    track, f = thesis_track(), [100.0, 500.0, 1200.0]
    for x in (0.02, 0.04, 0.1, 0.2):
        exact = exact_receptance(track, x, [x], f)[:, 0]
        error = np.abs(track.receptance(x, [x], f)[:, 0] / exact - 1.0)
        assert np.all(error < [2e-4, 3e-3, 3e-2])  # achieved: 1.7e-4, 2.6e-3, 2.0e-2


def test_exact_solution_is_reciprocal(thesis_track):
    track = thesis_track()
    x = [MID, 0.0, -0.1234, 3.21]
    both = [exact_receptance(track, a, [b], [700.0])[0, 0] for a, b in ((x[2], x[3]), (x[3], x[2]))]
    assert both[0] == pytest.approx(both[1], abs=0, rel=1e-11)  # achieved: 3e-15
    with pytest.raises(ValueError, match="middle sleeper"):
        exact_receptance(track, 0.0, [track.half_length], [10.0])
