"""The push convolution against the sum of Pieringer (2011), eq. 3.15."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.greens.track_response import TrackResponse


@pytest.mark.parametrize(("positions", "directions", "samples"), [(13, 3, 40), (1, 3, 40), (13, 1, 40), (1, 1, 7)])
def test_against_the_direct_sum(positions, directions, samples):
    rng = np.random.default_rng(positions + directions)
    values = rng.normal(size=(positions, directions, directions, samples))
    response = TrackResponse(values)
    assert (response.positions, response.directions, response.samples) == (positions, directions, samples)
    forces = rng.normal(size=(5 * samples, directions))
    future, work = np.zeros((directions, 2 * samples)), np.empty(directions * samples)
    head, begin = 0, 8  # at grid index 8
    for a in range(len(forces)):
        expected = np.zeros(directions)
        for n in range(min(samples, a + 1)):
            function = values[(begin + a - n) % positions, :, :, n]  # of the position of its own force
            if n:
                expected += forces[a - n] @ function
        np.testing.assert_allclose(future[:, head], expected, rtol=0, atol=2e-14 * samples)
        head = response.push(future, head, begin + a, forces[a], work)
    assert 0 <= head < samples


@pytest.mark.parametrize(("positions", "directions"), [(13, 3), (1, 3), (13, 1)])
def test_history_and_compliance_of_a_force_that_rolled_for_ever(positions, directions):
    rng = np.random.default_rng(positions)
    values = rng.normal(size=(positions, directions, directions, 30))
    response = TrackResponse(values)
    force = rng.normal(size=directions)
    index = 100
    history = np.einsum("ijk,i->jk", response.history(index), force)
    future, work = np.zeros((directions, 60)), np.empty(30 * directions)
    head = 0
    for a in range(index - 80, index):
        head = response.push(future, head, a, force, work)
    np.testing.assert_allclose(history, future[:, head : head + 30], rtol=0, atol=1e-13)
    displacement = history[:, 0] + force @ values[index % positions, :, :, 0]
    np.testing.assert_allclose(response.compliance(index) @ force, displacement, rtol=0, atol=1e-13)
    assert response.first(index) == values[index % positions, -1, -1, 0]
