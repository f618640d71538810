"""Faults of ``[friction]`` have their lines."""

import pytest
from case_faults import changed, faults_of

from wheelrail.case import case_from_dict

KRAFT = {"law": "kraft", "coefficient": 0.3, "normalise": True}
POLACH = {"law": "polach", "coefficient": 0.3, "ratio": 0.4, "decay": 0.6}
EXPONENTIAL = {"law": "exponential", "coefficient": 0.3, "ratio": 0.4, "half_speed": 0.1}
RATIONAL = {"law": "rational", "coefficient": 0.3, "ratio": 0.4, "half_speed": 0.1}
TABLE = {"law": "table", "speeds": [0.0, 0.1, 1.0], "coefficients": [0.3, 0.2, 0.1]}
CREEPAGE = {"x": 0.0, "y": 5e-3, "spin": 0.0}
FRICTION_LAWS = "constant, kraft, polach, exponential, rational, table"

SINGLE = [
    *(
        (
            {"friction": {**law, "memory_distance": 3e-6}},
            "friction.memory_speed: missing; friction.memory_distance needs it (m/s); 1e-3 is usual",
        )
        for law in (KRAFT, POLACH, EXPONENTIAL, RATIONAL, TABLE)
    ),
    *(
        (
            {"contact.tangential": "fastsim", "creepage": CREEPAGE, "friction": law},
            f'friction.law = "{law["law"]}": only with contact.tangential = "transient" or "friction-curve"',
        )
        for law in (KRAFT, POLACH, EXPONENTIAL, RATIONAL, TABLE)
    ),
    *(
        (
            {"contact.tangential": "friction-curve", "creepage": CREEPAGE, "friction": {**KRAFT, key: value}},
            f'friction.{key}: only with contact.tangential = "transient"; leave it out',
        )
        for key, value in (("solver", "broyden"), ("branch", "high-slip"), ("find_solutions", True))
    ),
    (
        {"friction": {**RATIONAL, "square_share": 0.3}},
        "friction.square_half_speed: missing; friction.square_share needs it (m/s)",
    ),
    (
        {"friction": {**TABLE, "speeds": [0.01, 0.1, 1.0]}},
        "friction.speeds: the first is 0.01; it must be 0 (m/s), where the static coefficient belongs",
    ),
    ({"friction": {**TABLE, "speeds": [0.0, 0.5, 0.5]}}, "friction.speeds: value 3 is 0.5 after 0.5; they must rise"),
    ({"friction": {**TABLE, "speeds": [0.0, 0.5, 0.1]}}, "friction.speeds: value 3 is 0.1 after 0.5; they must rise"),
    (
        {"friction": {**TABLE, "coefficients": [0.3, 0.2]}},
        "friction.coefficients: 2 values for 3 speeds; give one for each",
    ),
    (
        {"friction": {**TABLE, "speeds": "fast"}},
        'friction.speeds = "fast": must be a list of two or more finite numbers >= 0 (m/s), rising from 0',
    ),
    (
        {"friction": {**TABLE, "coefficients": 0.3}},
        "friction.coefficients = 0.3: must be a list of two or more finite numbers > 0",
    ),
    (
        {"friction": {**TABLE, "speeds": [0.0, "x", 1.0]}},
        'friction.speeds[1] = "x": must be a finite number >= 0 (m/s)',
    ),
    ({"friction": {"law": "table", "speeds": [0.0, 1.0]}}, "friction.coefficients: missing; give it"),
    (
        {"friction": {**KRAFT, "law": "krafft"}},
        f"friction.law = \"krafft\": did you mean 'kraft'? must be one of: {FRICTION_LAWS}",
    ),
    ({"friction": {**KRAFT, "law": "coulomb"}}, f'friction.law = "coulomb": must be one of: {FRICTION_LAWS}'),
    ({"friction": {**KRAFT, "law": 3}}, f"friction.law = 3: must be one of: {FRICTION_LAWS}"),
    ({"friction": {"coefficient": 0.3}}, f"friction.law: missing; give one of: {FRICTION_LAWS}"),
    (
        {"friction": {**KRAFT, "solver": "newtn"}},
        "friction.solver = \"newtn\": did you mean 'newton'? must be one of: newton, broyden",
    ),
    (
        {"friction": {**KRAFT, "branch": "low_slip"}},
        "friction.branch = \"low_slip\": did you mean 'low-slip'? must be one of: previous, low-slip, high-slip",
    ),
    ({"friction": {**KRAFT, "solver": True}}, "friction.solver = true: must be one of: newton, broyden"),
    ({"friction": {"law": "kraft", "normalise": True}}, "friction.coefficient: missing; give it"),
    ({"friction": {**KRAFT, "coefficient": "x"}}, 'friction.coefficient = "x": must be a finite number >= 0'),
    ({"friction": {**KRAFT, "memory_distance": -1e-6}}, "friction.memory_distance = -1e-06: must be >= 0 (m)"),
    (
        {"friction": {**KRAFT, "memory_distance": "x"}},
        'friction.memory_distance = "x": must be a finite number >= 0 (m)',
    ),
    (
        {"friction": {**KRAFT, "memory_distance": 1e-6, "memory_speed": 0.0}},
        "friction.memory_speed = 0.0: must be > 0 (m/s)",
    ),
    ({"friction": {**POLACH, "ratio": 1.5}}, "friction.ratio = 1.5: must be >= 0 and <= 1"),
    ({"friction": {**POLACH, "decay": -1.0}}, "friction.decay = -1.0: must be >= 0 (s/m)"),
    ({"friction": {**EXPONENTIAL, "half_speed": 0.0}}, "friction.half_speed = 0.0: must be > 0 (m/s)"),
    (
        {"friction": {"law": "exponential", "coefficient": 0.3, "ratio": 0.4}},
        "friction.half_speed: missing; give it (m/s)",
    ),
    (
        {"friction": {**RATIONAL, "square_share": 0.3, "square_half_speed": 0.0}},
        "friction.square_half_speed = 0.0: must be > 0 (m/s)",
    ),
]


@pytest.mark.parametrize(("changes", "line"), SINGLE, ids=lambda value: str(value)[:60])
def test_one_fault_gives_exactly_its_line(changes, line):
    assert faults_of(changed(changes)) == [line]


def test_keys_of_another_friction_law_name_those_of_this_one():
    """In whichever order."""
    common = {"law", "coefficient", "memory_distance", "memory_speed", "solver", "branch", "find_solutions"}
    for friction, start, allowed in (
        ({**KRAFT, "decay": 1.0}, 'friction.decay: not used with law = "kraft"; ', common | {"normalise"}),
        (
            {**POLACH, "half_speed": 1.0},
            'friction.half_speed: not used with law = "polach"; ',
            common | {"ratio", "decay"},
        ),
        (
            {**TABLE, "coefficient": 0.3},
            'friction.coefficient: not used with law = "table"; ',
            common - {"coefficient"} | {"speeds", "coefficients"},
        ),
        (
            {"law": "constant", "coefficient": 0.3, "normalise": True},
            'friction.normalise: not used with law = "constant"; ',
            common,
        ),
        (
            {**KRAFT, "normalize": True},
            "friction.normalize: unknown key; did you mean 'normalise'? ",
            common | {"normalise"},
        ),
    ):
        (fault,) = faults_of(changed({"friction": friction}))
        assert fault.startswith(f"{start}allowed: ")
        assert set(fault.split("allowed: ")[1].split(", ")) == allowed


def test_all_faults_of_a_friction_table_come_together():
    speeds = {**TABLE, "speeds": [0.1, 0.05], "memory_distance": 1e-6, "solver": "newtn", "colour": 1}
    assert [line.split(":")[0].split(" =")[0] for line in faults_of(changed({"friction": speeds}))] == [
        "friction.memory_speed",
        "friction.speeds",
        "friction.speeds",
        "friction.coefficients",
        "friction.solver",
        "friction.colour",
    ]


@pytest.mark.parametrize(
    "friction",
    [
        {**KRAFT, "memory_distance": 0.0},
        {**KRAFT, "memory_distance": 3e-6, "memory_speed": 1e-3, "solver": "newton", "branch": "previous"},
        {**RATIONAL, "square_share": 0.0},
        {**TABLE, "speeds": [0, 1], "coefficients": [1, 2]},
        {"law": "constant", "coefficient": 0.3, "memory_distance": 3e-6},
    ],
)
def test_good_friction_tables(friction):
    for tangential, normal in (("none", "winkler"), ("linear", "winkler"), ("friction-curve", "winkler")):
        data = changed({"contact.tangential": tangential, "contact.normal": normal, "friction": friction})
        case_from_dict(data | {"creepage": CREEPAGE})


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        ({**KRAFT, "normalise": "yes"}, "true or false"),
        ({**KRAFT, "find_solutions": 1}, "true or false"),
        ({**TABLE, "coefficients": [0.3, 0.2, 0.0]}, "> 0"),
        ({**TABLE, "speeds": [0.0, 0.1, -1.0]}, ">= 0"),
    ],
)
def test_friction_faults_say_what_is_allowed(friction, words):
    assert any(words in fault for fault in faults_of(changed({"friction": friction})))


def test_a_table_of_one_point_is_refused_in_the_words_of_the_file():
    faults = faults_of(changed({"friction": {**TABLE, "speeds": [0.0], "coefficients": [0.3]}}))
    assert [line.split(" = ")[0] for line in faults] == ["friction.speeds", "friction.coefficients"]
    assert all("two or more" in line for line in faults)


@pytest.mark.parametrize(
    "friction",
    [
        {**KRAFT, "memory_distance": True},
        {**RATIONAL, "square_share": True},
        {**RATIONAL, "square_share": 1.5},
    ],
)
def test_a_bad_value_has_one_line(friction):
    assert len(faults_of(changed({"friction": friction}))) == 1
