"""Creep-force curves: values against direct calls, symmetry, order of the axes, file, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

from wheelrail.analysis.creep_force_curves import LAWS, creep_force_curves
from wheelrail.contact.creep.fastsim import fastsim
from wheelrail.contact.creep.linear import linear_creep_force
from wheelrail.contact.creep.shen_hedrick_elkins import shen_hedrick_elkins
from wheelrail.contact.creep.vermeulen_johnson import vermeulen_johnson
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import steady_rolling
from wheelrail.errors import ContactGridError, ParameterError

FRICTION, LOAD, SHEAR, POISSON = 0.3, 65e3, 207e9 / 2.6, 0.3
AXES = {"semi_axis_x": 5.9e-3, "semi_axis_y": 4.8e-3}
PHYSICS = {
    **AXES,
    "load": LOAD,
    "friction_coefficient": FRICTION,
    "shear_modulus": SHEAR,
    "poisson_ratio": POISSON,
}
XI, ETA, PHI = [-1e-3, 0.0, 5e-4], [1e-3, 0.0], [0.0, 0.2, -0.4, 0.1]


def contact(elements=13, load=LOAD):
    grid = HalfSpace(elements, elements, 1e-3, 1e-3, SHEAR, POISSON)
    distance = grid.x**2 / (2 * 0.39) + grid.y**2 / (2 * 0.30)
    return grid, solve_normal(NormalProblem(grid, distance, weight=0.0, compliance=1.0, rhs=load))


def curves(**changed):
    grid, normal = contact()
    given = {"half_space": grid, "normal": normal, "friction": FRICTION, **AXES}
    given |= {"creepage_x": 0.0, "creepage_y": 0.0, "creepage_spin": 0.0}
    return creep_force_curves(**{**given, **changed})


@pytest.fixture(scope="module")
def grid_of_all():
    return curves(creepage_x=XI, creepage_y=ETA, creepage_spin=PHI)


def test_every_value_is_that_of_a_direct_call(grid_of_all):
    data = grid_of_all
    assert data.force_x.dims == ("law", "creepage_x", "creepage_y", "creepage_spin")
    assert data.force_x.shape == (5, 3, 2, 4)
    grid, normal = contact()
    for xi in XI:
        for eta in ETA:
            for phi in PHI:
                here = data.sel(creepage_x=xi, creepage_y=eta, creepage_spin=phi)
                creepages = {"creepage_x": xi, "creepage_y": eta}
                exact = steady_rolling(grid, normal, friction=FRICTION, **creepages, creepage_spin=phi)
                assert here.slip_fraction == exact.slip_fraction
                assert here.residual == exact.residual
                assert exact.residual < 1e-10
                elastic = {name: PHYSICS[name] for name in (*AXES, "shear_modulus", "poisson_ratio")}
                # The load is the sum of the pressures: equal to rounding.
                expected = {
                    "exact": exact,
                    "fastsim": fastsim(**creepages, spin=phi, **PHYSICS),
                    "shen-hedrick-elkins": shen_hedrick_elkins(**creepages, spin=phi, **PHYSICS),
                    "linear": linear_creep_force(**creepages, spin=phi, **elastic),
                }
                if phi == 0.0:
                    expected["vermeulen-johnson"] = vermeulen_johnson(**creepages, **PHYSICS)
                for law in LAWS:
                    for name in ("force_x", "force_y", "moment_spin"):
                        found = float(here[name].sel(law=law))
                        if law in expected:
                            assert found == pytest.approx(getattr(expected[law], name), rel=1e-12, abs=1e-12)
                        else:  # the theory has no spin, so no number either
                            assert math.isnan(found)


def test_forces_turn_with_the_creepages():
    data = curves(creepage_x=[-1e-3, 1e-3], creepage_y=[-5e-4, 5e-4], creepage_spin=[-0.3, 0.3])
    turned = data.isel(creepage_x=[1, 0], creepage_y=[1, 0], creepage_spin=[1, 0])
    mirrored = data.isel(creepage_y=[1, 0], creepage_spin=[1, 0])  # left and right
    limit = FRICTION * LOAD
    for name, scale in (("force_x", limit), ("force_y", limit), ("moment_spin", limit * 5e-3)):
        values = data[name].values / scale
        np.testing.assert_allclose(mirrored[name].values / scale, values * (1 if name == "force_x" else -1), atol=1e-9)
    # Rolling has a direction, so turning all creepages turns all forces, but nothing else does.
    for name, scale in (("force_x", limit), ("force_y", limit), ("moment_spin", limit * 5e-3)):
        np.testing.assert_allclose(turned[name].values / scale, -data[name].values / scale, atol=1e-9)


def test_exact_force_saturates_and_the_linear_one_does_not():
    data = curves(creepage_y=np.linspace(0.0, 2e-2, 5)).squeeze()
    size = -data.force_y / (FRICTION * LOAD)
    exact, linear = size.sel(law="exact"), size.sel(law="linear")
    assert float(exact[0]) == 0.0
    assert np.all(np.diff(exact) > 0.0)
    assert float(exact[-1]) == pytest.approx(1.0, abs=1e-4)  # achieved: 5e-5
    assert float(linear[-1]) > 5.0
    assert float(data.slip_fraction[-1]) == 1.0
    for law in ("fastsim", "shen-hedrick-elkins", "vermeulen-johnson"):
        assert np.abs(size.sel(law=law) - exact).max() < 0.06


def test_units_and_what_it_was_made_from_survive_a_file(tmp_path):
    data = curves(creepage_x=[0.0, 1e-3], laws=("exact",), semi_axis_x=None, semi_axis_y=None)
    assert data.law.values.tolist() == ["exact"]
    path = tmp_path / "curves.nc"
    data.to_netcdf(path, engine="netcdf4")
    with xr.open_dataset(path, engine="netcdf4") as read:
        xr.testing.assert_equal(read, data)
        assert {name: read[name].units for name in ("force_x", "moment_spin", "creepage_spin", "normal_force")} == {
            "force_x": "N",
            "moment_spin": "N m",
            "creepage_spin": "m-1",
            "normal_force": "N",
        }
        assert float(read.normal_force) == pytest.approx(LOAD, rel=1e-12)
        assert read.attrs["dx"] == 1e-3
        assert read.attrs["mx"] == 13
        assert "semi_axis_x" not in read.attrs


def test_laws_can_be_chosen_and_progress_is_told():
    seen = []
    data = curves(creepage_x=[1e-3, 2e-3], creepage_spin=[0.1, 0.2], laws=("linear", "fastsim"), progress=seen.append)
    assert data.law.values.tolist() == ["linear", "fastsim"]
    assert "slip_fraction" not in data
    assert seen == [0.25, 0.5, 0.75, 1.0]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"creepage_x": math.nan}, r"creepage_x = nan .*between -1 and 1"),
        ({"creepage_y": [0.0, 1.0]}, r"creepage_y\[1\] = 1\.0 "),
        ({"creepage_spin": [0.1, math.inf]}, r"creepage_spin\[1\] = inf .*1/m"),
        ({"creepage_spin": "fast"}, "creepage_spin = 'fast'"),
        ({"creepage_x": [[1e-3]]}, r"shape \(1, 1\)"),
        ({"creepage_x": []}, r"shape \(0,\)"),
        ({"creepage_y": [1e-3, 0.0, 1e-3]}, r"creepage_y = 0\.001 .*more than once"),
        ({"friction": 0.0}, "friction = 0.0"),
        ({"friction": math.nan}, "friction = nan"),
        ({"laws": ("exact", "polach")}, "laws = 'polach' .*fastsim"),
        ({"laws": ("exact", "exact")}, "each once"),
        ({"laws": ()}, "name one of"),
        ({"semi_axis_y": None}, "semi_axis_y = None .*'exact'"),
        ({"semi_axis_x": 0.0}, "semi_axis_x must be positive"),
        ({"semi_axis_x": 1.0}, "axis ratios"),
    ],
)
def test_refusals(changed, message):
    with pytest.raises(ParameterError, match=message):
        curves(**changed)


def test_contacts_that_are_refused():
    grid, normal = contact(load=0.0)
    with pytest.raises(ParameterError, match="need a load"):
        curves(half_space=grid, normal=normal)
    with pytest.raises(ParameterError, match="169 elements"):
        curves(half_space=contact(elements=15)[0])
    grid, normal = contact(elements=9)
    with pytest.raises(ContactGridError, match=r"0\.009 m long"):
        curves(half_space=grid, normal=normal)
