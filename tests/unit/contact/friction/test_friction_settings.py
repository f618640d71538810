"""What a run takes along of its friction: description, names, coefficient at rest."""

from __future__ import annotations

import json

import pytest

from wheelrail.contact.friction.laws import ConstantLaw, ExponentialLaw, KraftLaw, TableLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.settings import BRANCHES, SlipFriction
from wheelrail.contact.friction.solve import SOLVERS


@pytest.mark.parametrize(
    "friction",
    [
        SlipFriction(KraftLaw(True)),
        SlipFriction(KraftLaw(False), FrictionMemory(3e-6, 1e-3), "broyden", "high-slip", True),
        SlipFriction(TableLaw((0.0, 0.5), (1.0, 0.4)), FrictionMemory(1e-5, 2e-3), branch="low-slip"),
    ],
)
def test_description_is_json_and_gives_the_same(friction):
    assert SlipFriction.from_parts(json.loads(json.dumps(friction.to_parts()))) == friction


@pytest.mark.parametrize("what", [{"solver": "secant"}, {"branch": "middle"}, {"solver": ""}])
def test_unknown_names_are_refused(what):
    with pytest.raises(ValueError, match="is not known"):
        SlipFriction(KraftLaw(True), **what)


def test_all_names_are_taken():
    for solver in SOLVERS:
        for branch in BRANCHES:
            assert SlipFriction(KraftLaw(True), None, solver, branch).to_parts()["branch"] == branch


def test_coefficient_at_rest():
    for law, expected in (
        (ConstantLaw(), 1.0),
        (KraftLaw(True), 1.0),
        (KraftLaw(False), 0.7),
        (ExponentialLaw(0.2, 0.1), 1.0),
        (TableLaw((0.0, 1.0), (1.0, 0.1)), 1.0),
    ):
        assert SlipFriction(law).at_rest == pytest.approx(expected, rel=1e-15)
