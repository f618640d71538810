"""Vollebregt's open CONTACT, rev 2707: an independent implementation of Kalker's exact theory, on equal grids.

Its figures have 10 digits; its tolerance was 1e-11 for the tractions, 1e-9 for the transients.
"""

from __future__ import annotations

import numpy as np
import pytest
from thesis_contact import DATA, FRICTION, LIMIT, LOAD, distance, grid, loaded, pressed, rows

from wheelrail.contact.rolling import rigid_shift, roll, steady_rolling

SIZES = {1e-3: 17, 0.5e-3: 33}
STEPS = {1e-3: 60, 0.5e-3: 120}


def large_ones_slow(table: list[dict[str, float]]) -> list:
    return [
        pytest.param(row, id=f"{row['dx_m']}-{row['approach_m']}", marks=[pytest.mark.slow] * (row["elements"] > 800))
        for row in table
    ]


@pytest.mark.parametrize("row", large_ones_slow(rows("half_space_approach_force.csv")))
def test_force_under_a_given_approach(row):
    dx, approach = row["dx_m"], row["approach_m"]
    half = np.ceil(np.sqrt(2.0 * 0.39 * approach) / dx)  # the overlap of the undeformed bodies
    half_space = grid(dx, 2 * int(half) + 1)
    normal = pressed(half_space, approach)
    assert normal.force == pytest.approx(row["force_N"], rel=1e-6)  # 5e-10, the table's digits
    assert normal.pressure.max() == pytest.approx(row["pressure_max_Pa"], rel=1e-6)
    assert len(normal.contact) == row["elements"]
    assert np.count_nonzero(normal.pressure > 0.0) == row["elements"]
    # the same approach follows from the force
    if len(normal.contact) < 800:
        assert loaded(half_space, load=normal.force).approach == pytest.approx(approach, rel=1e-12)


@pytest.mark.parametrize("dx", [1e-3, 0.5e-3])
def test_tractions_and_division_of_steady_rolling(dx):
    half_space = grid(dx, SIZES[dx])
    normal = loaded(half_space)
    state = steady_rolling(half_space, normal, friction=FRICTION, creepage_x=0.0, creepage_y=1e-3, creepage_spin=0.0)
    table = [row for row in rows("half_space_steady_tractions.csv") if row["dx_m"] == dx]
    column = {name: np.array([row[name] for row in table]) for name in table[0]}
    middle = (half_space.mx - 1) // 2
    element = np.rint(column["y_m"] / dx + middle) * half_space.mx + np.rint(column["x_m"] / dx + middle)
    element = element.astype(int)
    np.testing.assert_array_equal(np.sort(element), normal.contact)
    np.testing.assert_array_equal(state.slipping[element], column["slipping"] == 1.0)
    assert not np.delete(state.slipping, element).any()

    largest = np.hypot(column["traction_x_Pa"], column["traction_y_Pa"]).max()
    error = np.abs(state.tractions[:, element] - [column["traction_x_Pa"], column["traction_y_Pa"]]).max()
    assert error < 1e-5 * largest  # 4e-10
    assert np.abs(normal.pressure[element] - column["pressure_Pa"]).max() < 1e-5 * column["pressure_Pa"].max()  # 5e-10
    # resultants of the reference's file of results, N and N mm
    force, moment = {1e-3: (-7995.24847593571, 11997.331593417744), 0.5e-3: (-7851.46587488037, 12195.30016716448)}[dx]
    assert state.force_y == pytest.approx(force, rel=1e-6)  # 1e-10
    assert state.force_x == pytest.approx(0.0, abs=1e-6)
    assert state.moment_spin == pytest.approx(1e-3 * moment, rel=1e-6)


@pytest.mark.parametrize("dx", [1e-3, pytest.param(0.5e-3, marks=pytest.mark.slow)])
def test_forty_steady_creepage_combinations(dx):
    half_space = grid(dx, SIZES[dx])
    normal = loaded(half_space)
    table = [row for row in rows("creep_forces_exact.csv") if row["dx_m"] == dx]
    assert len(table) == 40
    for row in table:
        state = steady_rolling(
            half_space,
            normal,
            friction=FRICTION,
            creepage_x=row["creepage_x"],
            creepage_y=row["creepage_y"] + row["spin_1_per_m"] * dx / 6.0,  # what the reference does
            creepage_spin=row["spin_1_per_m"],
        )
        assert state.residual < 1e-10
        assert state.force_x == pytest.approx(row["force_x_N"], abs=1e-6 * LIMIT)  # 5e-6 N of 19.5 kN
        assert state.force_y == pytest.approx(row["force_y_N"], abs=1e-6 * LIMIT)
        assert state.moment_spin == pytest.approx(row["moment_spin_Nm"], abs=1e-6 * LIMIT * 5e-3)
        assert len(normal.contact) == row["elements"]
        assert np.count_nonzero(state.slipping) == row["sliding_elements"]


@pytest.mark.parametrize(("dx", "creepage"), [(1e-3, 1e-3), (0.5e-3, 1e-3), (1e-3, 1e-2)])
def test_every_step_after_a_jump_of_creepage(dx, creepage):
    half_space = grid(dx, SIZES[dx])
    normal = loaded(half_space)
    table = [row for row in rows("half_space_creepage_step.csv") if (row["dx_m"], row["creepage_y"]) == (dx, creepage)]
    assert len(table) == STEPS[dx]
    largest = max(abs(row["force_y_N"]) for row in table)
    largest_moment = max(abs(row["moment_spin_Nm"]) for row in table)
    shift = rigid_shift(half_space, creepage_x=0.0, creepage_y=creepage, creepage_spin=0.0, distance=dx)
    tractions = np.zeros((2, half_space.elements))
    for row in table:
        state = roll(half_space, normal, friction=FRICTION, shift=shift, previous=tractions)
        tractions = state.tractions
        assert abs(state.force_x - row["force_x_N"]) < 1e-6 * largest
        assert abs(state.force_y - row["force_y_N"]) < 1e-6 * largest  # 3e-6 N of 8 kN
        assert abs(state.moment_spin - row["moment_spin_Nm"]) < 1e-6 * largest_moment
        assert np.count_nonzero(state.slipping) == row["slipping"]
        assert len(normal.contact) == row["sticking"] + row["slipping"]


def test_every_step_on_a_moving_rough_surface():
    surface = np.loadtxt(DATA / "half_space_rough_surface.csv", delimiter=",")
    half_space = grid(1e-3, 19)
    smooth = distance(half_space)
    shift = rigid_shift(half_space, creepage_x=0.0, creepage_y=1e-3, creepage_spin=0.0, distance=1e-3)
    table = rows("half_space_rough.csv")
    assert len(table) == 60
    largest = {name: max(abs(row[name]) for row in table) for name in table[0]}
    tractions = np.zeros((2, half_space.elements))
    for row in table:
        step = int(row["step"])
        normal = loaded(half_space, smooth - surface[:, step : step + 19].ravel())
        state = roll(half_space, normal, friction=FRICTION, shift=shift, previous=tractions)
        tractions = state.tractions
        assert normal.force == pytest.approx(LOAD, rel=1e-12)
        assert abs(state.force_x - row["force_x_N"]) < 1e-6 * largest["force_y_N"]
        assert abs(state.force_y - row["force_y_N"]) < 1e-6 * largest["force_y_N"]  # 2e-6 N of 8 kN
        assert abs(state.moment_spin - row["moment_spin_Nm"]) < 1e-6 * largest["moment_spin_Nm"]  # 6e-10
        assert abs(normal.approach - row["approach_m"]) < 1e-6 * largest["approach_m"]
        assert abs(normal.pressure.max() - row["pressure_max_Pa"]) < 1e-6 * largest["pressure_max_Pa"]
        assert len(normal.contact) == row["elements"]
        assert np.count_nonzero(state.slipping) == row["slipping"]


@pytest.mark.parametrize(
    "row",
    rows("half_space_shift.csv"),
    ids=lambda row: f"{row['dx_m']}-{row['shift_x_m']}-{row['shift_y_m']}-{row['shift_spin_rad']}",
)
def test_shift_without_rolling(row):
    half_space = grid(row["dx_m"], SIZES[row["dx_m"]])
    normal = loaded(half_space)
    shift = rigid_shift(
        half_space,
        creepage_x=row["shift_x_m"],
        creepage_y=row["shift_y_m"],
        creepage_spin=row["shift_spin_rad"],
        distance=1.0,
    )
    state = roll(half_space, normal, friction=FRICTION, shift=shift, previous=np.zeros((2, half_space.elements)))
    assert state.force_x == pytest.approx(row["force_x_N"], abs=1e-6 * LIMIT)  # 5e-6 N of 19.5 kN
    assert state.force_y == pytest.approx(row["force_y_N"], abs=1e-6 * LIMIT)
    assert state.moment_spin == pytest.approx(row["moment_spin_Nm"], abs=1e-6 * LIMIT * 5e-3)
    assert len(normal.contact) == row["sticking"] + row["slipping"]
    assert np.count_nonzero(state.slipping) == row["slipping"]
