"""The JSON schema describes the file as a user writes it."""

import copy
import json
import tomllib
from pathlib import Path

import pytest

from wheelrail.case import default_case_text, json_schema, load_case

jsonschema = pytest.importorskip("jsonschema")

MEASURED = {"model": "flexible", "radius": 0.46, "receptances": "r.csv", "low_frequency": "static"}
EXAMPLES = sorted((Path(__file__).parents[3] / "examples" / "cases").glob("*.toml"))


@pytest.fixture(scope="module")
def validator():
    return jsonschema.Draft202012Validator(json_schema())


def default():
    return tomllib.loads(default_case_text())


def test_is_a_schema_and_json():
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    assert json.loads(json.dumps(schema)) == schema
    assert schema["$schema"].endswith("2020-12/schema")


def test_accepts_default(validator):
    validator.validate(default())


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_accepts_examples_with_and_without_presets(validator, path):
    validator.validate(tomllib.loads(path.read_text(encoding="utf-8")))
    validator.validate(load_case(path).to_dict())


@pytest.mark.parametrize(
    ("section", "table"),
    [
        ("wheel", {"preset": "thesis-2dof", "masss": 3.0}),
        ("wheel", {"preset": "thesis-2dof", "model": "rigid-1dof"}),
        ("wheel", {"preset": "thesis-3dof"}),
        ("wheel", {"model": "rigid-1dof", "radius": 0.46}),
        ("wheel", {"model": "flexible", "radius": 0.46}),
        ("wheel", {"model": "flexible", "radius": 0.46, "section": "a.csv", "modes": "b.csv"}),
        ("wheel", {"preset": "synthetic-c20", "damping": -1.0}),
        ("wheel", {"preset": "synthetic-c20", "axes": ["x", "y"]}),
        ("wheel", {**MEASURED, "receptances_as": "impulses"}),
        ("track", {"model": "waveguide"}),
        ("track", {"preset": "thesis-waveguide-60e1", "support": "ballast"}),
        ("track", {"preset": "thesis-discrete", "pad_stiffness": -1.0}),
        ("track", {"preset": "thesis-discrete", "bays": 71}),
        ("load", {"coupling": "load"}),
        ("load", {"preset": "thesis-65kN"}),
        ("output", {"record": ["forcez"]}),
        ("excitation", [{"type": "spectrum", "on": "rail", "seed": 1}]),
        ("excitation", [{"type": "spectrum", "on": "wheel", "seed": 1, "name": "iso3095-2013-limit", "length": 2.0}]),
        ("excitation", [{"type": "measured", "on": "wheel", "file": "x.csv", "beyond_end": "stop"}]),
    ],
)
def test_refuses(validator, section, table):
    data = default()
    data[section] = table
    assert not validator.is_valid(data)


@pytest.mark.parametrize(
    ("section", "table"),
    [
        ("wheel", {"preset": "thesis-1dof", "mass": 400}),
        ("wheel", {"model": "rigid-2dof", "preset": "thesis-2dof"}),
        ("wheel", {"preset": "synthetic-c20", "contact_position": 10e-3, "remove_modes": ["7,0,a"]}),
        ("wheel", {"preset": "synthetic-c20", "damping": {"others": "thesis", "7,0,a": 1e-3}}),
        ("wheel", {"model": "flexible", "radius": 0.46, "modes": "m.unv", "axes": ["x", "-z", "y"], "damping": 1e-3}),
        ("wheel", MEASURED),
        ("wheel", {**MEASURED, "receptances_as": "modes", "remove_modes": ["fit-2"]}),
        ("track", {"preset": "waveguide-60e1-sleepers", "contact_position": -5e-3}),
        ("load", {"preset": "thesis-65kN", "coupling": "displacement"}),
        ("excitation", [{"type": "measured", "on": "rail", "file": "x.csv", "column": "left"}]),
        ("excitation", []),
    ],
)
def test_accepts(validator, section, table):
    data = default()
    data[section] = table
    validator.validate(data)


def test_prefilter_rules(validator):
    data = default()
    data["contact"]["prefilter"] = "winkler"
    assert not validator.is_valid(data)
    data["contact"]["normal"] = "hertz"
    validator.validate(data)
    del data["contact"]["length"]
    assert not validator.is_valid(data)


def test_every_key_is_described_and_every_number_has_a_unit():
    schema = json_schema()
    tables = [definition for definition in schema["$defs"].values() if "properties" in definition]
    assert len(tables) == 28
    for table in tables:
        for key, part in copy.deepcopy(table["properties"]).items():
            assert part.get("description"), (table["title"], key)
            if part.get("type") in ("number", "integer"):
                assert part.get("unit"), (table["title"], key)
