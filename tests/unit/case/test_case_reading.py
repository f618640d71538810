"""What a good case file gives: values, presets, defaults, round trips."""

import shutil
import tomllib
from pathlib import Path

import pytest
from pydantic import ValidationError

from wheelrail.case import Case, case_from_dict, default_case_text, load_case, parse_case
from wheelrail.case.excitations import SPECTRUM_NAMES
from wheelrail.case.presets import load_presets, presets_of
from wheelrail.case.sections import OUTPUT_NAMES

EXAMPLES = sorted((Path(__file__).parents[3] / "examples" / "cases").glob("*.toml"))
CONTRACT = """
title = "Rolling over measured roughness"
[simulation]
speed = 27.78
dx = 1e-3
duration = 0.5
start_position = 0.0
[wheel]
model = "rigid-2dof"
preset = "thesis-2dof"
[track]
model = "discrete"
preset = "thesis-discrete"
[contact]
normal = "winkler"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
dy = 1e-3
length = 19e-3
width = 19e-3
prefilter = "none"
tangential = "none"
lateral_shift = 0.0
[friction]
law = "constant"
coefficient = 0.3
[load]
preload = 65e3
coupling = "load"
[creepage]
x = 0.0
y = 0.0
spin = 0.0
[[excitation]]
type = "sinusoid"
amplitude = 10e-6
wavelength = 0.05
[output]
record = ["force_x", "force_y", "force_z"]
file = "run.nc"
"""


def minimal():
    return {
        "simulation": {"speed": 20, "dx": 1e-3, "duration": 1, "start_position": 0},
        "wheel": {"model": "rigid", "radius": 0.46},
        "track": {"model": "rigid"},
        "contact": {"normal": "hertz", "rail_radius": 0.3, "youngs_modulus": 207e9, "poisson_ratio": 0.3},
        "load": {"preload": 65e3, "coupling": "load"},
    }


def test_all_sections():
    case = parse_case(CONTRACT)
    assert case.title == "Rolling over measured roughness"
    assert case.simulation.speed == 27.78
    assert case.wheel.model == "rigid-2dof"
    assert case.wheel.contact_mass == 3.0
    assert case.track.sleeper_spacing == 0.65
    assert case.contact.width == 19e-3
    assert case.friction is not None
    assert case.friction.coefficient == 0.3
    assert case.creepage is not None
    assert case.creepage.spin == 0.0
    assert case.excitation[0].wavelength == 0.05
    assert case.output.record == ("force_x", "force_y", "force_z")
    assert case.output.file == "run.nc"


def test_defaults_are_not_physical():
    case = case_from_dict(minimal())
    assert case.contact.prefilter == "none"
    assert case.contact.tangential == "none"
    assert case.contact.lateral_shift == 0.0
    assert case.contact.wheel_transverse_radius is None
    assert case.friction is None
    assert case.creepage is None
    assert case.excitation == ()
    assert case.output.record == ("force_z",)


def test_whole_number_becomes_float():
    speed = case_from_dict(minimal()).simulation.speed
    assert speed == 20.0
    assert isinstance(speed, float)


def test_plain_values_may_hold_none_and_tuples():
    data = minimal()
    data["contact"] |= {"length": None, "dy": None}
    data["output"] = {"record": ("force_z", "distance"), "file": None}
    case = case_from_dict(data)
    assert case.contact.length is None
    assert case.output.record == ("force_z", "distance")


def test_case_is_immutable():
    case = case_from_dict(minimal())
    with pytest.raises(ValidationError):
        case.simulation.speed = 3.0  # type: ignore[misc]


def test_model_itself_checks_keys_together():
    data = minimal()
    data["contact"]["length"] = 0.02
    with pytest.raises(ValidationError, match="odd number"):
        Case.model_validate(data)


def test_file_overrides_preset():
    text = default_case_text().replace(
        'preset = "thesis-discrete"', 'preset = "thesis-discrete"\nsleeper_spacing = 0.6'
    )
    track = parse_case(text).track
    assert track.sleeper_spacing == 0.6
    assert track.pad_stiffness == 120e6


def test_result_file_is_named_after_the_case_file(tmp_path):
    path = tmp_path / "night train.toml"
    path.write_text(default_case_text(), encoding="utf-8")
    assert load_case(path).output.file == "night train.nc"
    assert parse_case(default_case_text()).output.file == "run.nc"


def test_byte_order_mark_and_windows_lines(tmp_path):
    path = tmp_path / "bom.toml"
    path.write_bytes(b"\xef\xbb\xbf" + CONTRACT.replace("\n", "\r\n").encode())
    assert load_case(path) == parse_case(CONTRACT)


@pytest.mark.parametrize("length", [19e-3, 0.019000000000000003, 0.7 * 19e-3 / 0.7])
def test_decimal_fractions_fit_the_grid(length):
    data = minimal()
    data["contact"] |= {"normal": "winkler", "length": length}
    assert case_from_dict(data).contact.length == length


def test_half_millimetre_grid():
    data = minimal()
    data["simulation"]["dx"] = 0.5e-3
    data["contact"]["length"] = 18.5e-3
    assert case_from_dict(data).contact.length == 18.5e-3


def test_unsprung_wheel_is_allowed():
    data = minimal()
    data["wheel"] = {
        "model": "rigid-1dof",
        "radius": 0.46,
        "mass": 488.5,
        "suspension_stiffness": 0,
        "suspension_damping": 0,
    }
    assert case_from_dict(data).wheel.suspension_stiffness == 0.0


def test_measured_line_stops_on_the_rail_only(tmp_path):
    (tmp_path / "r.csv").write_text("")
    data = minimal()
    data["excitation"] = [{"type": "measured", "file": "r.csv", "on": on} for on in ("rail", "wheel")]
    rail, wheel = case_from_dict(data, folder=tmp_path).excitation
    assert rail.beyond_end == "stop"
    assert wheel.beyond_end is None


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example_round_trip(path):
    case = load_case(path)
    again = parse_case(case.to_toml(), folder=path.parent)
    assert again == case
    assert hash(again) == hash(case)
    assert case_from_dict(case.to_dict(), folder=path.parent) == case


def test_examples_are_there():
    assert {path.stem for path in EXAMPLES} >= {"smooth", "sine", "broadband"}


def test_default_case():
    case = parse_case(default_case_text())
    assert (case.wheel.model, case.track.model, case.contact.normal) == ("rigid-2dof", "discrete", "winkler")
    assert [entry.on for entry in case.excitation] == ["rail", "wheel"]


def test_different_cases_differ():
    data = minimal()
    case = case_from_dict(data)
    data["simulation"]["speed"] = 20.000001
    assert case_from_dict(data) != case


def test_to_toml_holds_resolved_presets():
    data = tomllib.loads(parse_case(default_case_text()).to_toml())
    assert "preset" not in data["wheel"]
    assert data["wheel"]["mass"] == 341.5


MEMORY = {"memory_distance": 3e-6, "memory_speed": 1e-3}
ALL = {**MEMORY, "solver": "broyden", "branch": "low-slip", "find_solutions": True}


@pytest.mark.parametrize("others", [{}, MEMORY, ALL], ids=["alone", "memory", "all keys"])
@pytest.mark.parametrize(
    "law",
    [
        {"law": "kraft", "coefficient": 0.3, "normalise": False},
        {"law": "polach", "coefficient": 0.3, "ratio": 0.4, "decay": 0.6},
        {"law": "exponential", "coefficient": 0.3, "ratio": 0.4, "half_speed": 0.1},
        {"law": "rational", "coefficient": 0.3, "ratio": 0.4, "half_speed": 0.1},
        {"law": "rational", "coefficient": 0.3, "ratio": 0, "half_speed": 0.2}
        | {"square_share": 2 / 7, "square_half_speed": 10},
        {"law": "table", "speeds": [0, 0.1, 1.0], "coefficients": [0.3, 0.2, 0.15]},
    ],
    ids=lambda law: f"{law['law']} {len(law)}",
)
def test_friction_law_round_trip(law, others):
    data = minimal()
    data["contact"] |= {"normal": "half-space", "tangential": "transient", "dy": 1e-3, "length": 0.019, "width": 0.019}
    data |= {"creepage": {"x": 0.0, "y": 5e-3, "spin": 0.0}, "friction": {**law, **others}}
    case = case_from_dict(data)
    again = parse_case(case.to_toml())
    assert (again, again.friction) == (case, case.friction)
    read = tomllib.loads(case.to_toml())["friction"]
    assert {key: read[key] for key in {**law, **others}} == {**law, **others}


def test_defaults_of_a_friction_law():
    data = minimal()
    data["friction"] = {"law": "kraft", "coefficient": 0.3, "normalise": True}
    friction = case_from_dict(data).friction
    assert (friction.memory_distance, friction.memory_speed) == (0.0, None)
    assert (friction.solver, friction.branch, friction.find_solutions) == ("newton", "previous", False)
    data["friction"] = {"law": "rational", "coefficient": 0.3, "ratio": 0.2, "half_speed": 0.1}
    friction = case_from_dict(data).friction
    assert (friction.square_share, friction.square_half_speed) == (0.0, None)


def test_round_trip_in_another_folder(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    (first / "data").mkdir(parents=True)
    (first / "data" / "line.csv").write_text("x")
    (first / "case.toml").write_text(
        default_case_text() + '\n[[excitation]]\ntype = "measured"\nfile = "data/line.csv"\non = "rail"\ncolumn = 1\n',
        encoding="utf-8",
    )
    case = load_case(first / "case.toml")
    assert case.data_path(case.excitation[2].file) == first / "data" / "line.csv"
    assert str(tmp_path) not in case.to_toml()
    shutil.copytree(first / "data", second / "data")
    (second / "other.toml").write_text(case.to_toml(), encoding="utf-8")
    moved = load_case(second / "other.toml")
    assert moved == case
    assert moved.folder == second
    assert moved.data_path("data/line.csv") == second / "data" / "line.csv"


@pytest.mark.parametrize("preset", load_presets(), ids=lambda preset: preset.name)
def test_preset_has_source_and_valid_values(preset):
    assert len(preset.source) > 20
    data = minimal()
    data[preset.section] = {"preset": preset.name, **({"coupling": "load"} if preset.section == "load" else {})}
    section = case_from_dict(data).to_dict()[preset.section]
    assert {key: section[key] for key in preset.values} == preset.values


def test_preset_names_are_unique():
    assert sum(len(presets_of(section)) for section in ("wheel", "track", "load")) == len(load_presets())


def test_output_names():
    assert len(OUTPUT_NAMES) == len(set(OUTPUT_NAMES)) == 36
    data = minimal()
    data["output"] = {"record": list(OUTPUT_NAMES)}
    assert case_from_dict(data).output.record == OUTPUT_NAMES


def test_named_spectra_are_those_of_the_program():
    table = Path(__file__).parents[3] / "wheelrail" / "excitation" / "named_spectra.csv"
    lines = table.read_text(encoding="utf-8").splitlines()
    header = next(line for line in lines if not line.startswith("#"))
    assert tuple(header.split(",")[1:]) == SPECTRUM_NAMES
