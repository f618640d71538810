"""Simple polygons."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.numerics.polygon import Outline, clean_polygon, is_inside, polygon_area

SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def test_a_clockwise_polygon_is_turned_round():
    assert polygon_area(clean_polygon(SQUARE[::-1])) == 1.0
    np.testing.assert_array_equal(clean_polygon(SQUARE), SQUARE)


def test_repeated_points_are_dropped():
    assert len(clean_polygon([SQUARE[0], *SQUARE, SQUARE[3], SQUARE[0]])) == 4


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "crosses or touches itself: the side from"),
        ([(0, 0), (2, 0), (2, 1), (1, 0), (0, 1)], "crosses or touches"),  # a corner on another side
        ([(0, 0), (2, 0), (1, 0), (1, 1)], "crosses or touches"),  # turns back on itself
        ([(0, 0), (1, 0), (2, 0)], "enclose an area"),
        ([(0, 0), (1, 0)], "at least three"),
        ([(0, 0), (1, 0), (np.nan, 1)], "finite"),
        ([0, 1, 2], "two columns"),
    ],
)
def test_what_is_no_simple_polygon_is_refused(points, message):
    with pytest.raises(ValueError, match=message):
        clean_polygon(points)


def test_inside():
    bent = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)], dtype=float)
    points = np.array([(0.5, 0.5), (2.0, 0.5), (0.5, 2.0), (2.0, 2.0), (-0.1, 0.5), (3.1, 0.5)])
    assert is_inside(bent, points).tolist() == [True, True, True, False, False, False]


def test_places_along_an_outline():
    outline = Outline(np.array(SQUARE))
    assert outline.length == 4.0
    np.testing.assert_allclose(outline.at([0.5, 1.5, 3.25, 4.5]), [(0.5, 0), (1, 0.5), (0, 0.75), (0.5, 0)])
    np.testing.assert_allclose(outline.turning, np.pi / 2)
