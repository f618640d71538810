"""The friction of a case file as the contact takes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wheelrail.case import case_from_dict, load_case
from wheelrail.contact.friction.laws import ConstantLaw, ExponentialLaw, KraftLaw, PolachLaw, RationalLaw, TableLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.slip_dependent_model import SlipDependentRolling
from wheelrail.contact.tangential_models import TransientRolling
from wheelrail.interaction.build import build_model
from wheelrail.interaction.friction import law_of, slip_friction_of, static_friction_of

CASE = load_case(Path(__file__).parents[4] / "examples" / "cases" / "rolling_contact.toml").to_dict()


@pytest.mark.parametrize(
    ("friction", "law", "static"),
    [
        ({"law": "constant", "coefficient": 0.4}, ConstantLaw(), 0.4),
        ({"law": "kraft", "coefficient": 0.4, "normalise": False}, KraftLaw(False), 0.4),
        ({"law": "polach", "coefficient": 0.4, "ratio": 0.3, "decay": 2}, PolachLaw(0.3, 2.0), 0.4),
        ({"law": "exponential", "coefficient": 0.4, "ratio": 0.3, "half_speed": 0.1}, ExponentialLaw(0.3, 0.1), 0.4),
        (
            {"law": "rational", "coefficient": 0.4, "ratio": 0.3, "half_speed": 0.1}
            | {"square_share": 0.2, "square_half_speed": 5.0},
            RationalLaw(0.3, 0.1, 0.2, 5.0),
            0.4,
        ),
        ({"law": "table", "speeds": [0, 0.5], "coefficients": [0.4, 0.1]}, TableLaw((0.0, 0.5), (1.0, 0.25)), 0.4),
    ],
    ids=lambda value: value["law"] if isinstance(value, dict) else "",
)
def test_the_friction_of_a_case(friction, law, static):
    case = case_from_dict({**CASE, "friction": friction})
    assert (law_of(case), static_friction_of(case)) == (law, static)
    model = build_model(case)
    assert model.parameters.friction_coefficient == static
    if isinstance(law, ConstantLaw):
        assert slip_friction_of(case) is None
        assert isinstance(model.tangential, TransientRolling)
        return
    assert slip_friction_of(case) == SlipFriction(law)
    others = {"memory_distance": 1e-5, "memory_speed": 2e-3}
    others |= {"solver": "broyden", "branch": "high-slip", "find_solutions": True}
    case = case_from_dict({**CASE, "friction": friction | others})
    expected = SlipFriction(law, FrictionMemory(1e-5, 2e-3), "broyden", "high-slip", True)
    assert slip_friction_of(case) == expected
    tangential = build_model(case).tangential
    assert isinstance(tangential, SlipDependentRolling)
    assert tangential.friction == expected


def test_rational_law_without_square_part():
    keys = {"law": "rational", "coefficient": 0.3, "ratio": 0.2, "half_speed": 0.1}
    law = law_of(case_from_dict({**CASE, "friction": keys}))
    assert law.evaluate(np.array([0.0, 0.1, 0.3]))[0] == pytest.approx([1.0, 0.6, 0.4], rel=1e-14)


def test_no_friction_without_tangential_contact():
    data = {key: value for key, value in CASE.items() if key != "friction"}
    data["contact"] = CASE["contact"] | {"tangential": "none"}
    case = case_from_dict(data)
    assert static_friction_of(case) == 0.0
    assert slip_friction_of(case) is None
    assert law_of(case) == ConstantLaw()
