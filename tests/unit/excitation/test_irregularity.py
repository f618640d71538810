import json
import math

import numpy as np
import pytest

from wheelrail.excitation.corrugation import Corrugation
from wheelrail.excitation.irregularity import Irregularity
from wheelrail.excitation.lateral_interpolation import lateral_weights
from wheelrail.excitation.out_of_round import OutOfRound
from wheelrail.excitation.sources import source_from_parts

DX = 1e-3
TURN = 2.0 * math.pi * 0.46


def shape(**changes):
    keys = {
        "positions": np.array([-0.02, 0.0, 0.03]),
        "heights": np.array([[0.0, -3e-4, 0.0]]),
        "lateral": np.zeros(1),
        "on": "wheel",
        "origin": 0.7,
        "period": TURN,
        "stretch": 1.0,
        "dx": DX,
        "name": "notch",
    }
    return Irregularity(**(keys | changes))


def exact(x):
    """The notch at rolled distances x, from its definition."""
    s = np.mod(x - 0.7 + 0.5 * TURN, TURN) - 0.5 * TURN
    return np.where(s < 0.0, np.clip(-3e-4 * (1.0 + s / 0.02), None, 0.0), np.clip(-3e-4 * (1.0 - s / 0.03), None, 0.0))


def window(source, first, count=19):
    out = np.zeros(count)
    source.add_window(first, out)
    return out


@pytest.mark.parametrize("turns", [0, 1, -3, 100_000])
@pytest.mark.parametrize("offset", [-25, -10, 0, 12, 31, 400])
def test_comes_again_every_turn_and_does_not_drift(turns, offset):
    first = round((0.7 + turns * TURN) / DX) + offset
    expected = exact((first + np.arange(19)) * DX)
    # A turn is 2890.27 steps. Achieved 4e-13 m after 100 000 turns (rounding of x itself).
    np.testing.assert_allclose(window(shape(), first), expected, rtol=0, atol=1e-12)


def test_stretch_acts_from_the_middle_of_the_window():
    first = 695
    x = (first + np.arange(19)) * DX
    expected = exact(x[9] + (x - x[9]) * 1.5)
    np.testing.assert_allclose(window(shape(stretch=1.5), first), expected, rtol=0, atol=1e-16)  # achieved 4e-18


def test_a_step_lasts():
    step = shape(positions=[-1e-3, 1e-3], heights=[[0.0, 2e-4]], on="rail", origin=1.0, period=None)
    assert not window(step, 0).any()
    np.testing.assert_array_equal(window(step, 50_000), 2e-4)
    assert window(step, 991)[9] == pytest.approx(1e-4, abs=1e-18)


def test_lines_across_are_interpolated_on_their_own_surface():
    source = shape(heights=[[0.0, -1e-4, 0.0], [0.0, -3e-4, 0.0]], lateral=[-5e-3, 5e-3])
    assert source.across
    out = np.zeros((4, 1))
    source.add_surface(700, np.array([-20e-3, -5e-3, 0.0, 5e-3]), np.zeros(4), out)
    np.testing.assert_allclose(out[:, 0], [-1e-4, -1e-4, -2e-4, -3e-4], rtol=1e-12)
    on_rail = shape(heights=[[0.0, -1e-4, 0.0], [0.0, -3e-4, 0.0]], lateral=[-5e-3, 5e-3], on="rail", period=None)
    out = np.zeros((1, 1))
    on_rail.add_surface(700, np.zeros(1), np.array([2.5e-3]), out)
    assert out[0, 0] == pytest.approx(-2.5e-4, rel=1e-12)


def test_weights_reproduce_straight_lines():
    lateral = np.array([-3e-3, 0.0, 1e-3, 7e-3])
    y = np.linspace(-3e-3, 7e-3, 23)
    weights = lateral_weights(lateral, y)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, rtol=1e-15)
    np.testing.assert_allclose(weights @ (2.0 * lateral + 1.0), 2.0 * y + 1.0, rtol=1e-14)
    np.testing.assert_array_equal(lateral_weights(lateral, np.array([-1.0, 1.0])), np.eye(4)[[0, 3]])


def test_out_of_round_is_exact_after_many_turns():
    source = OutOfRound(orders=[1, 3], amplitudes=[1e-4, 2e-5], phases=[0.3, -1.0], radius=0.46, dx=DX)
    first = 28_902_653  # 10 000 turns and 40 nodes
    angle = math.fmod(first * DX, TURN) / 0.46 + np.arange(19) * DX / 0.46
    expected = 1e-4 * np.cos(angle + 0.3) + 2e-5 * np.cos(3 * angle - 1.0)
    np.testing.assert_allclose(window(source, first), expected, rtol=0, atol=1e-14)


def test_corrugation_begins_and_ends_level():
    source = Corrugation(amplitude=2e-5, wavelength=0.05, start=1.0, length=2.0, ramp=0.1, dx=DX)
    assert not window(source, 0, 1001).any()
    assert not window(source, 3000, 500).any()
    x = (1200 + np.arange(19)) * DX
    np.testing.assert_allclose(window(source, 1200), 2e-5 * np.sin(2 * np.pi * (x - 1.0) / 0.05), rtol=0, atol=1e-17)
    ramp = window(source, 1062, 1)[0]
    assert ramp == pytest.approx(2e-5 * math.sin(2 * math.pi * 0.062 / 0.05) * 0.5 * (1 - math.cos(math.pi * 0.62)))


SOURCES = [
    shape(),
    shape(heights=[[0.0, -1e-4, 0.0], [0.0, -3e-4, 0.0]], lateral=[-5e-3, 5e-3]),
    OutOfRound(orders=[1, 3], amplitudes=[1e-4, 2e-5], phases=[0.3, -1.0], radius=0.46, dx=DX),
    Corrugation(amplitude=2e-5, wavelength=0.05, start=1.0, length=2.0, ramp=0.1, dx=DX),
]


@pytest.mark.parametrize("source", SOURCES, ids=lambda s: s.kind)
def test_parts(source):
    meta, arrays = source.to_parts()
    again = source_from_parts(json.loads(json.dumps(meta)), {name: a.copy() for name, a in arrays.items()})
    assert type(again) is type(source)
    for first in (680, 1500):
        if source.across:
            a, b = np.zeros((3, 9)), np.zeros((3, 9))
            y = np.array([-2e-3, 0.0, 1e-3])
            source.add_surface(first, y, y, a)
            again.add_surface(first, y, y, b)
        else:
            a, b = window(source, first), window(again, first)
        np.testing.assert_array_equal(a, b)
    assert source.realise(dx=DX, seed_override=1) is source
    with pytest.raises(ValueError, match="was made for dx"):
        source.realise(dx=2e-3, seed_override=None)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"positions": [0.0, 0.0, 1.0]}, "increase"),
        ({"heights": [[0.0, 1.0]]}, "shape"),
        ({"heights": [[0.0, np.nan, 0.0]]}, "finite"),
        ({"period": 0.04}, "fit into its period"),
        ({"heights": [[0.0, 1e-4, 1e-4]]}, "end as it begins"),
        ({"on": "sleeper"}, "wheel"),
        ({"stretch": 0.0}, "positive"),
    ],
)
def test_nonsense_is_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        shape(**changes)
