"""What is in the FMU: validity, reproducibility, completeness, nothing of the machine that built it."""

from __future__ import annotations

import csv
import io
import os
import sys
import tempfile
import zipfile
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from fmu_host import UnpackedFmu

import fmu_src.build
from fmu_src.build import build_fmu
from fmu_src.command import main
from fmu_src.errors import BuildError
from fmu_src.variables import OUTPUTS, UNITS, VARIABLES, structured_name
from wheelrail.case import Case, case_from_dict
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation

pytestmark = pytest.mark.fmu

# fmu-interface: names are final
INTERFACE = {
    "input": "creepage_x creepage_y creepage_spin wheel_force_z wheel_force_x wheel_force_y wheel_z wheel_y "
    "lateral_shift",
    "output": "force_x force_y force_z force_x_mean force_y_mean force_z_mean force_z_max force_z_min moment_spin "
    "wheel_disp_x wheel_disp_y wheel_disp_z rail_disp_x rail_disp_y rail_disp_z contact_stiffness_z contact_area "
    "contact_length contact_width pressure_max slip_fraction friction_power approach in_contact distance "
    "solver_iterations solver_residual friction_method friction_solutions friction_force_spread "
    "contact_y_wheel contact_y_rail contact_angle rolling_radius contact_points missed_overlap",
    "parameter": "speed friction_coefficient start_position lateral_position coupling balance input_extrapolation "
    "roughness_scale random_seed record",
}


def contents(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.mark.parametrize("name", ["quick_path", "small_path"])
def test_validation_finds_nothing(name: str, request: pytest.FixtureRequest) -> None:
    assert validate_fmu(str(request.getfixturevalue(name))) == []


def test_interface_is_complete(quick_path: Path) -> None:
    description = read_model_description(str(quick_path))
    for causality, names in INTERFACE.items():
        found = [variable.name for variable in description.modelVariables if variable.causality == causality]
        assert found == names.split()
    assert all(structured_name(variable.name) for variable in VARIABLES)
    assert all(variable.unit in UNITS for variable in VARIABLES if variable.kind == "Real")
    assert all(variable.description for variable in VARIABLES)


def test_description_says_what_hosts_ask(quick_path: Path, quick_case: Case) -> None:
    root = ElementTree.fromstring(contents(quick_path)["modelDescription.xml"])
    options = root.find("CoSimulation")
    assert options is not None
    for option in ("canHandleVariableCommunicationStepSize", "canGetAndSetFMUstate", "canSerializeFMUstate"):
        assert options.get(option) == "true"
    assert options.get("needsExecutionTool") == "false"
    assert options.get("modelIdentifier") == root.get("modelName") == "WheelRail"
    assert "{" not in (root.get("guid") or "{")
    experiment = root.find("DefaultExperiment")
    assert experiment is not None
    assert float(experiment.get("stopTime", "nan")) == quick_case.simulation.duration
    # no direct dependency at communication points, the true ones at initialisation
    for unknown in root.iterfind("ModelStructure/Outputs/Unknown"):
        assert unknown.get("dependencies") == ""
    for unknown in root.iterfind("ModelStructure/InitialUnknowns/Unknown"):
        known = {VARIABLES[int(index) - 1].role for index in (unknown.get("dependencies") or "").split()}
        unknown_role = VARIABLES[int(unknown.get("index", "0")) - 1].role
        assert known == ({"input", "parameter"} if unknown_role == "output" else {"parameter"})
    for variable in root.iterfind("ModelVariables/ScalarVariable"):
        assert variable.get("causality")
        assert variable.get("variability")
        assert variable.get("initial") or variable.get("causality") == "input"


def test_two_builds_have_the_same_bytes(quick_case: Case, quick_path: Path, tmp_path: Path) -> None:
    assert build_fmu(quick_case, tmp_path).read_bytes() == quick_path.read_bytes()


def test_another_case_has_another_identity(quick_case: Case, quick_path: Path, tmp_path: Path) -> None:
    data = quick_case.to_dict()
    data["load"]["preload"] = 66e3
    other = build_fmu(case_from_dict(data), tmp_path)
    guids = [read_model_description(str(path)).guid for path in (quick_path, other)]
    assert guids[0] != guids[1]


def test_other_code_has_other_names_and_runs_beside(
    quick_case: Case, quick_fmu: UnpackedFmu, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runtime = fmu_src.build._runtime()
    runtime["errors.py"] += b"\n# another version\n"
    monkeypatch.setattr(fmu_src.build, "_runtime", lambda: dict(runtime))
    path = build_fmu(quick_case, tmp_path)
    other = UnpackedFmu(path, tmp_path / "unpacked")
    scripts = [Path(fmu.folder, "resources", "slavemodule.txt").read_text() for fmu in (quick_fmu, other)]
    assert scripts[0] != scripts[1]
    instances = [fmu.instance() for fmu in (quick_fmu, other)]
    for instance in instances:
        instance.step(1e-3)
    assert instances[0].get("force_z") == instances[1].get("force_z")
    for instance in instances:
        instance.close()
    packages = {name.partition(".")[0] for name in sys.modules if name.startswith("wheelrail_rt_")}
    assert {script.replace("_fmu_", "_rt_") for script in scripts} <= packages


def test_build_date_comes_from_the_environment_only(
    quick_case: Case, quick_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert read_model_description(str(quick_path)).generationDateAndTime is None
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    dated = read_model_description(str(build_fmu(quick_case, tmp_path)))
    assert dated.generationDateAndTime == "2023-11-14T22:13:20Z"


def test_nothing_of_the_building_machine(small_path: Path) -> None:
    places = {str(Path(__file__).parents[2]), str(Path.home()), tempfile.gettempdir(), os.getcwd()} - {"/"}
    for name, content in contents(small_path).items():
        if name.startswith("binaries/") or name == "documentation/index.html":
            continue  # PythonFMU's; and a page that speaks of paths in general
        for place in places:
            assert place.encode() not in content, (name, place)
    page = contents(small_path)["documentation/index.html"]
    assert str(Path(__file__).parents[2]).encode() not in page


def test_folders_of_absolute_paths_stay_at_home() -> None:
    data = {
        "excitation": [{"file": "/home/someone/line.csv"}, {"file": "C:\\data\\line.csv"}, {"file": "sub/line.csv"}]
    }
    found = [item["file"] for item in fmu_src.build._without_folders(data)["excitation"]]
    assert found == ["line.csv", "line.csv", "sub/line.csv"]


def test_archive_is_tidy(quick_path: Path) -> None:
    with zipfile.ZipFile(quick_path) as archive:
        entries = archive.infolist()
    names = [entry.filename for entry in entries]
    assert names[0] == "modelDescription.xml"
    assert names[1:] == sorted(names[1:])
    assert {entry.compress_type for entry in entries} == {zipfile.ZIP_DEFLATED}
    assert {entry.date_time for entry in entries} == {(1980, 1, 1, 0, 0, 0)}
    for entry in entries:
        assert entry.external_attr >> 16 == (0o100755 if entry.filename.startswith("binaries/") else 0o100644)
    for name in (
        "binaries/linux64/WheelRail.so",
        "binaries/win64/WheelRail.dll",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "documentation/licenses/pythonfmu.txt",
        "model.png",
        "resources/case.toml",
        "resources/model.wrm",
    ):
        assert name in names
    assert not any(name.startswith("resources/pythonfmu") for name in names)


def test_licences_are_the_right_ones(quick_path: Path) -> None:
    files = contents(quick_path)
    assert b"Apache License" in files["documentation/licenses/license.txt"]
    assert b"NTNU" in files["documentation/licenses/pythonfmu.txt"]


class _Balance(HTMLParser):
    """Collects text and checks that elements close in order."""

    VOID = frozenset({"meta", "br", "path", "circle", "rect"})

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: object) -> None:
        del attrs
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            while self.open[-1] != tag and self.open[-1] in ("td", "tr", "li", "p"):
                self.open.pop()
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_documentation_has_every_variable_and_the_case(small_path: Path) -> None:
    page = contents(small_path)["documentation/index.html"].decode()
    parser = _Balance()
    parser.feed(page)
    assert parser.open == []
    for variable in VARIABLES:
        assert f"<code>{variable.name}</code>" in page
    assert "thesis" not in parser.text.split("The case")[0]
    assert "preload = 50000.0" in parser.text
    assert "LD_PRELOAD=<prefix>/lib/libpython3.11.so.1.0 PATH=<venv>/bin:$PATH host" in parser.text
    assert "$" not in parser.text.replace("$PATH", "")


def test_reference_result_is_what_the_fmu_gives(small_path: Path, small_fmu: UnpackedFmu) -> None:
    files = contents(small_path)
    folder = "extra/org.fmi-standard.fmi-ls-ref"
    manifest = ElementTree.fromstring(files[f"{folder}/fmi-ls-manifest.xml"])
    namespace = "{http://fmi-standard.org/fmi-ls-manifest}"
    assert manifest.get(f"{namespace}fmi-ls-name") == "org.fmi-standard.fmi-ls-ref"
    (related,) = manifest
    rows = list(csv.DictReader(io.StringIO(files[f"{folder}/{related.get('source')}"].decode())))
    assert related.get("role") == "result"
    assert len(rows) == 11  # 10 ms at 1 ms
    instance = small_fmu.instance()
    for number, row in enumerate(rows):
        if number:
            instance.step(1e-3)
        for name in OUTPUTS:
            assert float(row[name]) == instance.get(name), (number, name)
    instance.close()


def test_start_values_of_the_table_are_those_of_the_model(small_case: Case, small_fmu: UnpackedFmu) -> None:
    simulation = CoSimulation(build_model(small_case))
    for name in INTERFACE["input"].split():
        assert float(small_fmu.variables[name].start) == simulation.inputs[name]
    assert float(small_fmu.variables["wheel_force_z"].start) == small_case.load.preload
    instance = small_fmu.instance()
    assert instance.get("time_step") == small_case.simulation.dx / small_case.simulation.speed
    instance.close()


def test_other_pythonfmu_is_refused(quick_case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fmu_src.build, "WRAPPER_VERSION", "0.6.9")
    with pytest.raises(BuildError, match=r"PythonFMU 0\.7\.0 is refused"):
        build_fmu(quick_case, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_failed_build_leaves_the_old_fmu(quick_case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "WheelRail.fmu"
    path.write_bytes(b"old")

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(zipfile.ZipFile, "writestr", full)
    with pytest.raises(BuildError, match="No space left"):
        build_fmu(quick_case, tmp_path)
    assert [each.name for each in tmp_path.iterdir()] == ["WheelRail.fmu"]
    assert path.read_bytes() == b"old"


def test_command(quick_case: Case, quick_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "quick.toml"
    file.write_text(quick_case.to_toml(), encoding="utf-8")
    assert main([str(file), "--output", str(tmp_path / "deep" / "er")]) == 0
    out = capsys.readouterr().out
    path = tmp_path / "deep" / "er" / "WheelRail.fmu"
    assert out == f"{path}: {path.stat().st_size / 1e3:.0f} kB, 45 ports\n"
    assert path.read_bytes() == quick_path.read_bytes()


def test_command_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path / "none.toml"), "--output", str(tmp_path)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert "no such file" in captured.err
    assert "Traceback" not in captured.err


def test_command_output_that_is_a_file(quick_case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "quick.toml"
    file.write_text(quick_case.to_toml(), encoding="utf-8")
    before = file.read_bytes()
    assert main([str(file), "--output", str(file)]) == 2
    assert "is a file" in capsys.readouterr().err
    assert file.read_bytes() == before


def test_data_files_leave_no_path(quick_case: Case, tmp_path: Path) -> None:
    line = tmp_path / "deep" / "line.csv"
    line.parent.mkdir()
    rows = "\n".join(f"{position * 1e-3:.3f},{(position * 7 % 11) * 1e-7:.7e}" for position in range(600))
    line.write_text(f"x [m],height [m]\n{rows}\n")
    data = quick_case.to_dict()
    data["excitation"] = [{"type": "measured", "file": str(line), "on": "rail", "beyond_end": "repeat"}]
    files = contents(build_fmu(case_from_dict(data), tmp_path))
    assert b'file = "line.csv"' in files["resources/case.toml"]
    for name, content in files.items():
        assert str(tmp_path).encode() not in content, name
