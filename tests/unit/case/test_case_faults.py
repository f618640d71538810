"""Every kind of fault has its line, and all faults of a file come together."""

import copy

import pytest
from case_faults import base, changed, faults_of

from wheelrail.case import case_from_dict, load_case, parse_case
from wheelrail.case.presets import presets_of
from wheelrail.case.track_sections import RAIL_SECTIONS
from wheelrail.case.wheel_sections import WHEEL_SECTIONS
from wheelrail.errors import CaseError

HERTZ = {"normal": "hertz", "rail_radius": 0.3, "youngs_modulus": 207e9, "poisson_ratio": 0.3}

WHEEL = {"preset": None, **presets_of("wheel")["synthetic-c20"].values}
for _key in ("lateral_mass", "lateral_stiffness", "lateral_damping"):
    del WHEEL[_key]
MEASURED = {
    "preset": None,
    **dict.fromkeys(WHEEL),
    "model": "flexible",
    "radius": 0.46,
    "receptances": __file__,
    "low_frequency": "static",
}
RAIL = {"preset": None, **presets_of("track")["thesis-waveguide-60e1"].values}


SINGLE = [
    # out of range
    ({"track.pad_stiffness": -1}, "track.pad_stiffness = -1: must be > 0 (N/m)"),
    ({"track.pad_damping": -0.5}, "track.pad_damping = -0.5: must be >= 0 (N s/m)"),
    ({"track.bays": 8}, "track.bays = 8: must be an even whole number >= 20"),
    ({"track.bays": 11}, "track.bays = 11: must be an even whole number >= 20"),
    ({"track.elements_per_bay": 0}, "track.elements_per_bay = 0: must be >= 1"),
    ({"simulation.speed": 0}, "simulation.speed = 0: must be > 0 and <= 200 (m/s)"),
    ({"simulation.speed": 201.0}, "simulation.speed = 201.0: must be > 0 and <= 200 (m/s)"),
    ({"simulation.duration": -1.0}, "simulation.duration = -1.0: must be >= 0 (s)"),
    ({"wheel.contact_damping": 0.0}, "wheel.contact_damping = 0.0: must be > 0 (N s/m)"),
    ({"wheel.suspension_stiffness": -1.0}, "wheel.suspension_stiffness = -1.0: must be >= 0 (N/m)"),
    ({"contact.poisson_ratio": 0.5}, "contact.poisson_ratio = 0.5: must be >= 0 and < 0.5"),
    ({"load.preload": 0.0}, "load.preload = 0.0: must be > 0 (N)"),
    ({"excitation.0.seed": -1}, "excitation #1.seed = -1: must be >= 0 and <= 2147483647"),
    ({"friction": {"law": "constant", "coefficient": -0.1}}, "friction.coefficient = -0.1: must be >= 0"),
    # not finite
    ({"wheel.mass": float("nan")}, "wheel.mass = nan: must be a finite number > 0 (kg)"),
    ({"simulation.start_position": float("inf")}, "simulation.start_position = inf: must be a finite number (m)"),
    # wrong type
    ({"wheel.mass": "3"}, 'wheel.mass = "3": must be a finite number > 0 (kg)'),
    ({"wheel.mass": True}, "wheel.mass = true: must be a finite number > 0 (kg)"),
    ({"track.bays": True}, "track.bays = true: must be an even whole number >= 20"),
    ({"track.bays": 70.0}, "track.bays = 70.0: must be an even whole number >= 20"),
    ({"title": 3}, "title = 3: must be text"),
    ({"output.file": 3}, "output.file = 3: must be text, not empty"),
    ({"wheel": 3}, "wheel = 3: must be a table"),
    ({"load": [1]}, "load = [1]: must be a table"),
    ({"excitation": {"type": "sinusoid"}}, "excitation: must be an array of tables; write [[excitation]]"),
    ({"excitation": [3]}, "excitation #1 = 3: must be a table"),
    # unknown key
    (
        {"creepage": {"x": 0, "y": 0, "spin": 0, "spinn": 1}},
        "creepage.spinn: unknown key; did you mean 'spin'? allowed: x, y, spin",
    ),
    (
        {"wheel.masss": 3.0},
        "wheel.masss: unknown key; did you mean 'mass'? allowed: model, radius, mass, suspension_stiffness, "
        "suspension_damping, contact_mass, contact_stiffness, contact_damping, preset",
    ),
    (
        {"wheels": {}},
        "wheels: unknown key; did you mean 'wheel'? allowed: title, simulation, wheel, track, contact, friction, "
        "load, creepage, excitation, output",
    ),
    ({"speed": 3.0}, "speed: unknown key; it belongs in a table: [simulation]"),
    (
        {"wheel": {"model": "rigid", "radius": 0.46, "mass": 3.0}},
        'wheel.mass: not used with model = "rigid"; allowed: model, radius, preset',
    ),
    # missing
    ({"simulation.dx": None}, "simulation.dx: missing; give it (m)"),
    ({"contact.length": None}, "contact.length: missing; give it (m)"),
    ({"load.preload": None}, 'load.preload: missing; give it (N) or name a preset (preset = "thesis-65kN")'),
    ({"load.coupling": None}, "load.coupling: missing; give one of: load, displacement"),
    ({"contact.normal": None}, "contact.normal: missing; give one of: hertz, winkler, half-space"),
    (
        {"excitation.1.type": None},
        "excitation #2.type: missing; give one of: sinusoid, measured, spectrum, wheel-flat, rail-joint, dent, "
        "corrugation, out-of-round",
    ),
    (
        {"simulation": None},
        "simulation: missing; add a table [simulation] with speed, dx, duration, start_position",
    ),
    (
        {"track": {}},
        'track.model: missing; give one of: rigid, discrete, waveguide; or name a preset (preset = "thesis-discrete" '
        'or preset = "thesis-waveguide-bv50" or preset = "thesis-waveguide-60e1" '
        'or preset = "waveguide-60e1-sleepers")',
    ),
    # not one of the names
    ({"load.coupling": "lod"}, "load.coupling = \"lod\": did you mean 'load'? must be one of: load, displacement"),
    ({"excitation.0.on": "sleeper"}, 'excitation #1.on = "sleeper": must be one of: wheel, rail'),
    (
        {"contact.normal": "herz"},
        "contact.normal = \"herz\": did you mean 'hertz'? must be one of: hertz, winkler, half-space",
    ),
    ({"contact.normal": 3}, "contact.normal = 3: must be one of: hertz, winkler, half-space"),
    ({"output.record": []}, None),
    # in later versions
    (
        {
            "contact.tangential": "transient",
            "friction": {"law": "constant", "coefficient": 0.3},
            "creepage": {"x": 0.0, "y": 0.0, "spin": 0.0},
        },
        'contact.tangential = "transient": only with contact.normal = "half-space"',
    ),
    (
        {"contact.tangential": "linear"},
        'creepage: missing; contact.tangential = "linear" needs the section [creepage] with x, y, spin; '
        "an FMU starts with these values",
    ),
    (
        {"excitation": [{"type": "wheel-flat", "depth": 1e-3, "length": 0.1, "shape": "oval", "angle": 0.0}]},
        'excitation #1.shape = "oval": must be one of: new, rounded, measured',
    ),
    (
        {"excitation.0.coherence": 1.0},
        "excitation #1.lines: missing; coherence is that of several lines; give their positions across (m)",
    ),
    # presets
    (
        {"wheel.preset": "thesis-3dof"},
        'wheel.preset = "thesis-3dof": no such preset; known for [wheel]: thesis-1dof, thesis-2dof, synthetic-c20',
    ),
    (
        {"track.preset": 3},
        "track.preset = 3: no such preset; known for [track]: thesis-discrete, thesis-waveguide-bv50, "
        "thesis-waveguide-60e1, waveguide-60e1-sleepers",
    ),
    (
        {"wheel.model": "rigid-1dof"},
        'wheel.preset = "thesis-2dof": is for model = "rigid-2dof", but wheel.model = "rigid-1dof"',
    ),
    # flexible wheel
    (
        {"wheel": {**WHEEL, "section": None}},
        "wheel.section: missing; give section (a preset or file), modes (a file) or receptances (a file), or name a "
        'preset (preset = "synthetic-c20")',
    ),
    ({"wheel": {**WHEEL, "modes": __file__}}, "wheel: section and modes given together; give one of them"),
    ({"wheel": {**WHEEL, "density": None}}, "wheel.density: missing; a wheel from section needs it (kg/m3)"),
    ({"wheel": {**WHEEL, "mass": None}}, "wheel.mass: missing; a wheel from section needs it (kg)"),
    ({"wheel": {**WHEEL, "node": 3}}, "wheel.node: not used with section; leave it out"),
    (
        {"wheel": {**WHEEL, "receptances_as": "modes"}},
        "wheel.receptances_as: not used with section; leave it out",
    ),
    (
        {"wheel": {**MEASURED, "receptances_as": "modess"}},
        "wheel.receptances_as = \"modess\": did you mean 'modes'? must be one of: modes, functions",
    ),
    (
        {"wheel": {**MEASURED, "receptances_as": "functions", "remove_modes": ["fit-1"]}},
        'wheel.remove_modes: not used with receptances_as = "functions"; leave it out',
    ),
    ({"wheel": {**MEASURED, "low_frequency": None}}, "wheel.low_frequency: missing; a wheel from receptances needs it"),
    (
        {"wheel": {**WHEEL, "lateral_mass": 300.0, "lateral_damping": 1e3}},
        "wheel.lateral_stiffness: missing; this motion (lateral_mass, lateral_stiffness, lateral_damping) needs it "
        "(N/m)",
    ),
    (
        {"wheel": {**WHEEL, "damping": "thesiss"}},
        'wheel.damping = "thesiss": did you mean \'thesis\'? must be a finite number >= 0, "thesis", or a table of '
        "these by name of the mode",
    ),
    (
        {"wheel": {**WHEEL, "damping": {"2,0,a": -1.0}}},
        'wheel.damping = {"2,0,a": -1.0}: must be a finite number >= 0, "thesis", or a table of these by name of the '
        "mode",
    ),
    (
        {"wheel": {**WHEEL, "remove_modes": "7,0,a"}},
        'wheel.remove_modes = "7,0,a": must be a list of names of modes, such as ["7,0,a"]',
    ),
    ({"wheel": {**WHEEL, "max_frequency": 3e4}}, "wheel.max_frequency = 30000.0: must be > 0 and <= 20000.0 (Hz)"),
    ({"wheel": {**WHEEL, "suspension": 3}}, None),
    (
        {"wheel": {"preset": "synthetic-c20", "modes": "m.csv"}},
        'wheel.preset = "synthetic-c20": is for section, but modes is given; give the keys themselves',
    ),
    # waveguide track
    ({"track": {**RAIL, "density": None}}, None),
    (
        {"track": {**RAIL, "pad_thickness": None}},
        'track.pad_thickness: missing; support = "continuous" needs it (m)',
    ),
    (
        {"track": {**RAIL, "sleeper_mass": 100.0}},
        'track.sleeper_mass: not used with support = "continuous"; leave it out',
    ),
    (
        {"track": {"preset": "waveguide-60e1-sleepers", "sleeper_spacing": 0.6005}},
        "track.sleeper_spacing = 0.6005: must be a multiple of simulation.dx = 0.001 (m); "
        "the nearest dx that fits is 0.00100083333333",
    ),
    (
        {"track": {"preset": "thesis-waveguide-60e1", "support": "discrete"}},
        'track.preset = "thesis-waveguide-60e1": is for support = "continuous", but track.support = "discrete"; give '
        "the keys themselves",
    ),
    (
        {"track": {**RAIL, "support": "ballast"}},
        'track.support = "ballast": must be one of: continuous, discrete',
    ),
    # several keys together
    (
        {"contact.length": 0.02},
        "contact.length = 0.02: must be an odd number of simulation.dx = 0.001 (m); nearest: 0.019 and 0.021",
    ),
    (
        {"contact.length": 0.0004},
        "contact.length = 0.0004: must be an odd number of simulation.dx = 0.001 (m); nearest: 0.001",
    ),
    (
        {"contact.width": 0.01, "contact.dy": 0.001},
        "contact.width = 0.01: must be an odd number of contact.dy = 0.001 (m); nearest: 0.009 and 0.011",
    ),
    (
        {"simulation.start_position": 0.1234},
        "simulation.start_position = 0.1234: must be a multiple of simulation.dx = 0.001 (m); the nearest is 0.123",
    ),
    (
        {"track.sleeper_spacing": 0.6005},
        "track.sleeper_spacing = 0.6005: must be a multiple of simulation.dx = 0.001 (m); "
        "the nearest dx that fits is 0.00100083333333",
    ),
    (
        {"contact.prefilter": "average"},
        'contact.prefilter = "average": only with contact.normal = "hertz"; with "winkler", which filters by itself, '
        'it must be "none"',
    ),
    (
        {"contact": {**HERTZ, "prefilter": "winkler"}},
        'contact.length: missing; contact.prefilter = "winkler" needs it (m)',
    ),
    (
        {"excitation": [{"type": "sinusoid", "amplitude": 1e-6, "wavelength": 0.002}]},
        "excitation #1.wavelength = 0.002: must be > 2 simulation.dx = 0.002 (m); the grid can't carry a shorter one",
    ),
    ({"excitation.0.file": "s.csv"}, None),
    (
        {"excitation.0.name": None},
        "excitation #1.name: missing; give name (a spectrum that comes with the program) or file (a CSV file)",
    ),
    (
        {"excitation.0.length": 3.0005},
        "excitation #1.length = 3.0005: must be a multiple of simulation.dx = 0.001 (m); the nearest is 3",
    ),
    (
        {"excitation.1.length": 3.0},
        'excitation #2.length: not used with on = "wheel": the line repeats every turn; leave it out',
    ),
    (
        {"output.record": ["force_z", "force_z"]},
        'output.record: "force_z" is given 2 times; once is enough',
    ),
]


@pytest.mark.parametrize(("changes", "line"), [pair for pair in SINGLE if pair[1]], ids=lambda value: str(value)[:60])
def test_one_fault_gives_exactly_its_line(changes, line):
    assert faults_of(changed(changes)) == [line]


def test_sections_and_files_of_flexible_bodies_must_exist(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "mine.csv").write_text("r,z\n")
    data = changed({"wheel": {**WHEEL, "section": "synthetic-c2"}, "track": {**RAIL, "section": "folder"}})
    assert faults_of(data, folder=tmp_path) == [
        "wheel.section = \"synthetic-c2\": did you mean 'synthetic-c20'? it comes with the program (synthetic-c20) or "
        f"is a file; looked for {tmp_path / 'synthetic-c2'}",
        'track.section = "folder": is a folder; give a data file',
    ]
    modes = {"model": "flexible", "radius": 0.4, "modes": "m.csv", "mass": 300.0, "suspension_stiffness": 0.0}
    faults = faults_of(changed({"wheel": {**modes, "suspension_damping": 0.0}}), folder=tmp_path)
    assert faults == [f'wheel.modes = "m.csv": no such file; looked for {tmp_path / "m.csv"}']
    case_from_dict(changed({"wheel": {**WHEEL, "section": "mine.csv"}, "track": RAIL}), folder=tmp_path)


def test_the_sections_that_come_with_the_program_are_those_that_the_case_knows():
    from wheelrail.track.section_sources import PRESETS as RAILS
    from wheelrail.wheel.section import PRESETS as WHEELS

    assert tuple(WHEELS) == WHEEL_SECTIONS
    assert tuple(RAILS) == RAIL_SECTIONS


def test_missing_quantity_names_the_preset_of_its_model():
    data = changed({"wheel": {"model": "rigid-2dof", "radius": 0.46, "mass": 3, "suspension_stiffness": 0}})
    faults = faults_of(data)
    assert len(faults) == 4
    assert 'wheel.contact_mass: missing; give it (kg) or name a preset (preset = "thesis-2dof")' in faults


def test_unknown_output_lists_the_known():
    (fault,) = faults_of(changed({"output.record": ["force_z", "forcez"]}))
    assert fault.startswith("output.record[1] = \"forcez\": did you mean 'force_z'? must be one of: force_x, ")
    assert "wheel_disp_x, wheel_disp_y, wheel_disp_z" in fault


def test_empty_record_is_refused():
    (fault,) = faults_of(changed({"output.record": []}))
    assert fault.startswith("output.record = []: must be a list of at least one of: force_x")


def test_unknown_spectrum_lists_the_known():
    (fault,) = faults_of(changed({"excitation.0.name": "iso3095"}))
    assert fault.startswith('excitation #1.name = "iso3095": ')
    assert "cnossos-wheel-disc-brake" in fault


@pytest.mark.parametrize("column", [0, -1, "", 1.5, True])
def test_bad_column_is_one_fault(column, tmp_path):
    (tmp_path / "r.csv").write_text("x_m,r_um\n")
    data = changed({"excitation": [{"type": "measured", "file": "r.csv", "on": "rail", "column": column}]})
    (fault,) = faults_of(data, folder=tmp_path)
    assert fault.startswith("excitation #1.column = ")
    assert fault.endswith("must be text, not empty, or a whole number >= 1")


def test_data_files_must_exist(tmp_path):
    (tmp_path / "folder").mkdir()
    data = changed(
        {
            "excitation": [
                {"type": "measured", "file": "nix.csv", "on": "rail"},
                {"type": "spectrum", "file": "folder", "on": "rail", "seed": 1},
            ]
        }
    )
    assert faults_of(data, folder=tmp_path) == [
        f'excitation #1.file = "nix.csv": no such file; looked for {tmp_path / "nix.csv"}',
        'excitation #2.file = "folder": is a folder; give a data file',
    ]


def test_name_and_file_exclude_each_other(tmp_path):
    (tmp_path / "s.csv").write_text("")
    faults = faults_of(changed({"excitation.0.file": "s.csv"}), folder=tmp_path)
    assert faults == ["excitation #1: name and file both given; give one of them"]


def test_wheel_line_has_no_end(tmp_path):
    (tmp_path / "r.csv").write_text("")
    entry = {"type": "measured", "file": "r.csv", "on": "wheel", "beyond_end": "stop"}
    faults = faults_of(changed({"excitation": [entry]}), folder=tmp_path)
    assert faults == ['excitation #1.beyond_end: not used with on = "wheel": the line repeats every turn; leave it out']


def test_all_faults_in_one_report():
    data = changed(
        {
            "title": 3,
            "simulation.speed": -1,
            "simulation.start_position": 0.00025,
            "wheel.preset": "thesis-9dof",
            "wheel.radius": 0,
            "wheel.masss": 1,
            "track.pad_stiffness": "stiff",
            "track.sleeper_spacing": 0.6005,
            "contact.normal": "elastic",
            "contact.youngs_modulus": -1,
            "contact.tangential": "sticky",
            "contact.length": 0.02,
            "load.preload": None,
            "excitation.0.type": "sinusoid",
            "excitation.1.seed": 1.5,
            "output.record": ["nothing"],
            "extra": {},
        }
    )
    with pytest.raises(CaseError) as caught:
        case_from_dict(data, source="my.toml")
    keys = [line.split(":")[0].split(" =")[0] for line in caught.value.faults]
    assert keys == [
        "title",
        "simulation.start_position",
        "simulation.speed",
        "wheel.preset",
        "wheel.radius",
        "wheel.masss",
        "track.sleeper_spacing",
        "track.pad_stiffness",
        "contact.length",
        "contact.normal",
        "contact.tangential",
        "contact.youngs_modulus",
        "load.preload",
        "excitation #1.amplitude",
        "excitation #1.wavelength",
        "excitation #1.name",
        "excitation #1.on",
        "excitation #1.seed",
        "excitation #2.seed",
        "output.record[0]",
        "extra",
    ]
    report = str(caught.value)
    assert report.startswith("my.toml: 21 faults\n")
    assert all(f"  - {line}" in report for line in caught.value.faults)


def test_pydantic_does_not_show():
    data = changed({"wheel.mass": "x", "track.bays": 1.5, "excitation.0.seed": "x", "contact.length": "x"})
    text = "\n".join(faults_of(data))
    for word in ("Input should", "spectrum.", "discrete.", "rigid-2dof", "winkler", "pydantic", "type="):
        assert word not in text


def test_empty_file_names_every_required_table():
    with pytest.raises(CaseError) as caught:
        parse_case("")
    assert [line.split(":")[0] for line in caught.value.faults] == ["simulation", "wheel", "track", "contact", "load"]


def test_input_is_not_changed():
    data = base()
    before = copy.deepcopy(data)
    case_from_dict(data, source="x.toml")
    assert data == before


@pytest.mark.parametrize(
    ("text", "where"),
    [("[wheel]\nmass = = 3\n", "(at line 2, column 8)"), ('title = "x', "(at end of file, line 1, column 11)")],
)
def test_syntax_error_gives_line_and_column(text, where):
    with pytest.raises(CaseError, match="not valid TOML") as caught:
        parse_case(text, source="x.toml")
    assert len(caught.value.faults) == 1
    assert caught.value.faults[0].endswith(where)


def test_unreadable_files(tmp_path):
    with pytest.raises(CaseError, match=r"none\.toml: 1 fault\n  - no such file"):
        load_case(tmp_path / "none.toml")
    with pytest.raises(CaseError, match="is a folder"):
        load_case(tmp_path)
    latin = tmp_path / "latin.toml"
    latin.write_bytes('title = "Gleisbögen"'.encode("latin-1"))
    with pytest.raises(CaseError, match="not UTF-8 text: byte 15 is 0xf6"):
        load_case(latin)
