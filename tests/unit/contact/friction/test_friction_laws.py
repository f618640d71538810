"""Friction laws: published formulas, slopes, relations between them, and their description."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from slip_conditions import KINDS, law_and_formula

from wheelrail.contact.friction.laws import (
    ConstantLaw,
    ExponentialLaw,
    KraftLaw,
    PolachLaw,
    RationalLaw,
    TableLaw,
    falls,
    law_from_parts,
    steepest_fall,
)

SPEEDS = np.concatenate([[0.0], np.geomspace(1e-6, 60.0, 400)])
TABLE = TableLaw((0.0, 0.1, 0.4, 2.0), (1.0, 0.6, 0.7, 0.25))
SMOOTH = [
    KraftLaw(False),
    KraftLaw(True),
    PolachLaw(0.4, 0.6),
    ExponentialLaw(0.3, 0.1),
    RationalLaw(0.2, 0.05, 0.3, 4.0),
]


def name_of(law: object) -> str:
    return repr(law)[:40]


@pytest.mark.parametrize("kind", KINDS)
def test_published_formulas(kind):
    generator = np.random.default_rng(1)
    for _ in range(5):
        law, formula = law_and_formula(kind, generator)
        expected = [formula(float(s)) for s in SPEEDS]
        np.testing.assert_allclose(law.evaluate(SPEEDS)[0], expected, rtol=1e-13)  # 5e-16


def test_values_of_kraft_as_printed():
    """Pieringer (2011), eq. 3.57: the sum at s = 0 is 0.2 + 0.5."""
    speed = np.array([0.0, 0.01, 0.1, 0.5, 1.0, 2.0, 5.0])
    printed = [0.7, 0.67619, 0.533313, 0.342358, 0.281353, 0.237762, 0.179231]
    value = KraftLaw(normalise=False).evaluate(speed)[0]
    np.testing.assert_allclose(value, printed, rtol=0, atol=5e-7)  # the digits given
    np.testing.assert_allclose(KraftLaw(normalise=True).evaluate(speed)[0], value / 0.7, rtol=1e-15)


def test_values_of_the_others():
    speed = np.array([0.0, 0.1, 0.2, 1e3])
    np.testing.assert_allclose(ExponentialLaw(0.6, 0.1).evaluate(speed)[0], [1.0, 0.8, 0.7, 0.6], rtol=1e-15)
    np.testing.assert_allclose(PolachLaw(0.4, 10.0).evaluate(speed)[0][:2], [1.0, 0.4 + 0.6 / math.e], rtol=1e-15)
    np.testing.assert_allclose(RationalLaw(0.5, 0.1, 0.0, 1.0).evaluate(speed)[0][:2], [1.0, 0.75], rtol=1e-15)
    np.testing.assert_allclose(RationalLaw(0.5, 9.9, 1.0, 0.1).evaluate(speed)[0][:3], [1.0, 0.75, 0.6], rtol=1e-15)
    np.testing.assert_array_equal(ConstantLaw().evaluate(speed), [[1.0] * 4, [0.0] * 4])


@pytest.mark.parametrize("law", SMOOTH, ids=name_of)
def test_slopes_are_the_derivatives(law):
    for s in (1e-4, 1e-2, 0.1, 0.37, 1.0, 4.0, 15.0):
        h = 1e-4 * s
        (below, above), _ = law.evaluate(np.array([s - h, s + h]))
        slope = law.evaluate(np.array([s]))[1][0]
        assert slope <= 0.0
        assert slope == pytest.approx((above - below) / (2.0 * h), rel=1e-6, abs=1e-15 / h)  # 1.4e-7, and rounding
    # at rest that to the right
    (start, after), slope = law.evaluate(np.array([0.0, 1e-9]))
    assert slope[0] == pytest.approx((after - start) / 1e-9, rel=1e-5)


def test_kraft_is_a_rational_law():
    kraft, rational = KraftLaw(normalise=True), RationalLaw(0.0, 0.2, 2.0 / 7.0, 10.0)
    for one, other in zip(kraft.evaluate(SPEEDS), rational.evaluate(SPEEDS), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-14)  # 9e-16


def test_exponential_is_polach_by_another_parameter():
    exponential, polach = ExponentialLaw(0.3, 0.25), PolachLaw(0.3, math.log(2.0) / 0.25)
    for one, other in zip(exponential.evaluate(SPEEDS), polach.evaluate(SPEEDS), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-14)


def test_rational_law_with_one_part_ignores_the_other():
    for share, first, second in (
        (0.0, (0.2, 0.1, 0.0, 1.0), (0.2, 0.1, 0.0, 7.0)),
        (1.0, (0.2, 1, 1, 3), (0.2, 9, 1, 3)),
    ):
        assert first[2] == share
        np.testing.assert_array_equal(RationalLaw(*first).evaluate(SPEEDS), RationalLaw(*second).evaluate(SPEEDS))


def test_table():
    value, slope = TABLE.evaluate(np.array([0.0, 0.05, 0.1, 0.25, 0.4, 1.2, 2.0, 3.0, 1e3]))
    np.testing.assert_allclose(value, [1.0, 0.8, 0.6, 0.65, 0.7, 0.475, 0.25, 0.25, 0.25], rtol=1e-14)
    third = 0.1 / 0.3
    # at a point that to its right, 0 from the last on
    np.testing.assert_allclose(slope, [-4.0, -4.0, third, third, *[-0.45 / 1.6] * 2, 0.0, 0.0, 0.0], rtol=1e-13)


def test_evaluation_keeps_the_shape():
    for law in (ConstantLaw(), TABLE, *SMOOTH):
        for shape in ((0,), (3,), (2, 5)):
            value, slope = law.evaluate(np.full(shape, 0.2))
            assert value.shape == slope.shape == shape


def test_huge_slip_velocities_give_finite_numbers():
    for law in (ConstantLaw(), TABLE, *SMOOTH):
        assert np.isfinite(law.evaluate(np.array([1e6, 1e100]))).all()


@pytest.mark.parametrize("law", [ConstantLaw(), TABLE, *SMOOTH], ids=name_of)
def test_description_is_json_and_gives_the_same_law(law):
    again = law_from_parts(json.loads(json.dumps(law.to_parts())))
    assert again == law
    assert type(again) is type(law)
    np.testing.assert_array_equal(again.evaluate(SPEEDS), law.evaluate(SPEEDS))
    assert hash(again) == hash(law)


@pytest.mark.parametrize(
    "meta", [{"kind": "coulomb"}, {}, {"kind": "kraft"}, {"kind": "polach", "ratio": 0.3, "half_speed": 0.1}]
)
def test_bad_descriptions_are_refused(meta):
    with pytest.raises((KeyError, TypeError)):
        law_from_parts(meta)


@pytest.mark.parametrize("law", SMOOTH, ids=name_of)
def test_steepest_fall_of_smooth_laws(law):
    for highest in (0.05, 0.5, 20.0):
        speed = np.linspace(0.0, highest, 2_000_001)
        expected = np.max(-speed * law.evaluate(speed)[1])
        assert steepest_fall(law, highest_speed=highest) == pytest.approx(expected, rel=1e-5)  # 3e-6
    assert steepest_fall(ExponentialLaw(0.3, 0.1), highest_speed=5.0) == pytest.approx(0.7 / math.e, rel=1e-5)


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        # supremum at the end of each falling line
        (TableLaw((0.0, 0.1, 0.4, 2.0), (1.0, 0.6, 0.5, 0.25)), 0.4),
        (TableLaw((0.0, 0.1, 0.101, 1.0), (1.0, 0.9, 0.5, 0.4)), 0.101 * 400.0),
        (ExponentialLaw(0.3, 1e-4), 0.7 / math.e),
    ],
    ids=name_of,
)
def test_steepest_fall_of_narrow_laws(law, expected):
    assert steepest_fall(law, highest_speed=10.0) == pytest.approx(expected, rel=1e-3)


def test_steepest_fall_of_laws_that_do_not_fall():
    assert steepest_fall(ConstantLaw(), highest_speed=10.0) == 0.0
    assert steepest_fall(TableLaw((0.0, 1.0), (0.5, 1.0)), highest_speed=10.0) == 0.0
    assert not falls(ConstantLaw())
    assert not falls(TableLaw((0.0, 1.0), (0.5, 1.0)))


def test_every_law_that_falls_somewhere_falls():
    for law in (TABLE, *SMOOTH, TableLaw((0.0, 0.005), (1.0, 0.5)), TableLaw((0.0, 5.0, 5.01), (1.0, 2.0, 1.99))):
        assert falls(law)
