"""Shen, Hedrick and Elkins (1983) against the exact theory: forces under moderate spin."""

from __future__ import annotations

import math

import pytest
from exact_creep_forces import ELASTIC, FRICTION, LIMIT, exact_cases, worst_by_kind

from wheelrail.contact.creep.creep_force import CreepForce
from wheelrail.contact.creep.linear import linear_creep_force
from wheelrail.contact.creep.shen_hedrick_elkins import shen_hedrick_elkins
from wheelrail.contact.creep.vermeulen_johnson import vermeulen_johnson


def law(creepage: dict[str, float]) -> CreepForce:
    return shen_hedrick_elkins(**creepage, **ELASTIC, **FRICTION)


def test_exact_theory():
    worst = worst_by_kind(law)
    # Achieved, of mu N: pure 3.5 %, combined 2.7 %, with spin 3.4 %, spin alone (up to 1 / m) 9.4 %.
    assert worst["pure"] < 0.04
    assert worst["combined"] < 0.03
    assert worst["combined with spin"] < 0.04
    assert 0.08 < worst["spin"] < 0.10


def test_spin_moment_is_a_rough_one():
    """Scaled like the forces: right for small creepages and for spin, not where the contact slides."""
    spin = [case for case in exact_cases(0.5e-3) if case.kind == "spin"]
    for case in spin:
        # Achieved: -14 to +13 %; at small spin the reference's grid has 9 to 14 % too much.
        assert law(case.creepage).moment_spin == pytest.approx(case.force.moment_spin, rel=0.15)
    (sliding,) = (case for case in exact_cases(0.5e-3) if case.creepage["creepage_y"] == 0.02)
    assert law(sliding.creepage).moment_spin > 50.0 * sliding.force.moment_spin


def test_without_spin_it_is_vermeulen_and_johnson():
    for x, y in ((1e-4, 0.0), (1e-3, -2e-3), (0.0, 4e-3), (0.02, 0.01)):
        with_spin = law({"creepage_x": x, "creepage_y": y, "spin": 0.0})
        without = vermeulen_johnson(creepage_x=x, creepage_y=y, **ELASTIC, **FRICTION)
        assert (with_spin.force_x, with_spin.force_y) == (without.force_x, without.force_y)


def test_small_and_large_creepage():
    creepage = {"creepage_x": 1e-9, "creepage_y": -2e-9, "spin": 3e-7}
    tiny, linear = law(creepage), linear_creep_force(**creepage, **ELASTIC)
    for name in ("force_x", "force_y", "moment_spin"):
        assert getattr(tiny, name) == pytest.approx(getattr(linear, name), rel=1e-5)
    large = law({"creepage_x": 0.02, "creepage_y": -0.01, "spin": 0.1})
    assert math.hypot(large.force_x, large.force_y) == pytest.approx(LIMIT, rel=1e-14)
    assert law({"creepage_x": 0.0, "creepage_y": 0.0, "spin": 0.0}) == CreepForce(0.0, 0.0, 0.0)
