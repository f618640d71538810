"""A shared model is the one that would have been built for the point alone."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.case import case_from_dict
from wheelrail.interaction.build import build_model
from wheelrail.interaction.simulate import Simulation
from wheelrail.study.sharing import groups_of, model_for

# A tangential contact, so that creepages and friction reach the result.
ROLLING = """
[set]
"contact.normal" = "hertz"
"contact.tangential" = "fastsim"
"creepage.x" = 1e-3
"creepage.y" = 0.0
"creepage.spin" = 0.0
"""

FREE = [
    ("creepage.x", "[1e-3, 2e-3]"),
    ("creepage.y", "[0.0, 2e-3]"),
    ("creepage.spin", "[0.0, 0.1]"),
    ("contact.lateral_shift", "[0.0, 1e-3]"),
    ("friction.coefficient", "[0.3, 0.2]"),
    ("simulation.start_position", "[0.0, 0.05]"),
    ("simulation.duration", "[0.02, 0.01]"),
    ("load.coupling", '["load", "displacement"]'),
]
SHAPING = [
    ("load.preload", "[65e3, 50e3]"),
    ("simulation.speed", "[30.0, 20.0]"),
    ("wheel.mass", "[300.0, 350.0]"),
    ("contact.rail_radius", "[0.3, 0.4]"),
    ("excitation.1.amplitude", "[10e-6, 5e-6]"),
    ("excitation.2.seed", "[1, 2]"),
    ("simulation.first_sample", '["kept", "zero"]'),
]


def vary(study_of, key, values):
    kept = "\n".join(line for line in ROLLING.splitlines() if not line.startswith(f'"{key}"'))
    return study_of(f'{kept}\n[vary]\n"{key}" = {values}')


@pytest.mark.parametrize(("key", "values"), FREE)
def test_points_that_differ_in_free_keys_share_a_model_without_a_difference(study_of, key, values):
    study = vary(study_of, key, values)
    (group,) = groups_of(study.points)
    shared = build_model(group.points[0].case)
    for point in group.points:
        own, lent = build_model(point.case), model_for(shared, point.case)
        assert lent.fingerprint == own.fingerprint
        assert lent.parameters == own.parameters
        assert lent.start_inputs == own.start_inputs
        assert lent.case == own.case
        record = ("force_x", "force_y", "force_z")
        rows = [Simulation(m, duration=0.01, record=record).collect() for m in (own, lent)]
        for name in record:
            assert np.array_equal(rows[0][name], rows[1][name])


@pytest.mark.parametrize(("key", "values"), SHAPING)
def test_points_that_differ_in_what_is_precomputed_have_their_own(study_of, key, values):
    assert len(groups_of(vary(study_of, key, values).points)) == 2


def test_the_preload_shapes_the_model(study_of):
    # Why it is not among the free keys: the bedding is calibrated by it.
    study = study_of('[vary]\n"load.preload" = [65e3, 50e3]')
    contacts = [build_model(point.case).contact.to_parts() for point in study.points]
    assert contacts[0] != contacts[1]


def test_groups_know_which_have_the_same_greens_functions(study_of):
    study = study_of('[vary]\n"load.preload" = [65e3, 50e3]\n"simulation.speed" = [30.0, 20.0]')
    structures = [group.structure for group in groups_of(study.points)]
    assert structures[0] == structures[2] != structures[1] == structures[3]


def test_a_friction_table_is_not_free(study_of):
    study = study_of('[set]\n"friction.law" = "constant"\n[vary]\n"friction.coefficient" = [0.3, 0.2]')
    data = study.points[0].case.to_dict()
    cases = []
    for coefficients in ([0.3, 0.2], [0.4, 0.2]):
        data["friction"] = {"law": "table", "speeds": [0.0, 1.0], "coefficients": coefficients}
        cases.append(case_from_dict(data))
    points = [type(point)(point.index, "", case) for point, case in zip(study.points, cases, strict=True)]
    assert len(groups_of(points)) == 2


@pytest.mark.parametrize("normal", ["hertz", "half-space"])
def test_where_profiles_touch_decides_on_the_model(study_of, normal):
    """A shift on profiles is more than an input: radii and the height that the approach counts from are those there."""
    study = study_of(
        f"""
[set]
"contact.normal" = "{normal}"
"contact.rail_profile" = "circular"
"contact.wheel_profile" = "cone"
"contact.conicity" = 0.05
"contact.inclination" = 0.025
"contact.dy" = 5e-3
"contact.width" = 45e-3
[vary]
"contact.lateral_shift" = [-5e-3, -9e-3]
"""
    )
    assert len(groups_of(study.points)) == 2
    shapes = [build_model(point.case).geometry.place(-9e-3).lift for point in study.points]
    assert shapes[0] != shapes[1] == 0.0
