"""Result files: what is in them, what happens when a run is interrupted, and what is refused."""

from __future__ import annotations

import os
import signal
import tomllib

import netCDF4
import numpy as np
import pytest

from fmu_src.variables import VARIABLES
from wheelrail.case import case_from_dict, parse_case
from wheelrail.case.sections import OUTPUT_NAMES as RECORDABLE
from wheelrail.errors import ExcitationRangeError
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import OUTPUT_NAMES
from wheelrail.interaction.simulate import Statistics, simulate
from wheelrail.results import (
    OUTPUTS,
    ResultFileError,
    ResultWriter,
    case_differences,
    case_of_result,
    open_result,
    read_checkpoint,
)
from wheelrail.run import run_case
from wheelrail.version import __version__

CASE = """
title = "Prüfstand $1"
[simulation]
speed = 30.0
dx = 5e-3
duration = 0.05
start_position = 0.1
[wheel]
preset = "thesis-2dof"
[track]
preset = "thesis-discrete"
bays = 20
memory = 0.02
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
[load]
preload = 65e3
coupling = "load"
[[excitation]]
type = "sinusoid"
amplitude = 10e-6
wavelength = 0.13
[output]
record = ["force_z", "rail_disp_z", "in_contact", "solver_iterations"]
"""


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    folder = tmp_path_factory.getbasetemp() / "result_cache"
    monkeypatch.setenv("WHEELRAIL_CACHE", str(folder))


@pytest.fixture
def case():
    return parse_case(CASE)


def changed(case, **sections):
    data = case.to_dict()
    for name, keys in sections.items():
        data[name].update(keys)
    return case_from_dict(data)


def same_data(left, right):
    with open_result(left) as a, open_result(right) as b:
        assert set(a.variables) == set(b.variables)
        for name in a.variables:
            assert a[name].dtype == b[name].dtype
            np.testing.assert_array_equal(a[name].values, b[name].values, err_msg=name)
        assert a.attrs["state_digest"] == b.attrs["state_digest"]
        assert a.attrs["complete"] == b.attrs["complete"]


class Interrupter:
    """Progress callback that interrupts the run at a step."""

    def __init__(self, at, number=None):
        self.at, self.number = at, number

    def __call__(self, step):
        if step >= self.at:
            self.at = float("inf")
            if self.number is None:
                raise KeyboardInterrupt
            os.kill(os.getpid(), self.number)


def test_every_output_has_a_unit_the_fmu_agrees_with():
    assert set(OUTPUTS) == set(OUTPUT_NAMES) == set(RECORDABLE)
    spelling = {None: "1", "N.m": "N m", "N/m": "N m-1"}
    for variable in VARIABLES:
        if variable.role == "output":
            assert OUTPUTS[variable.name][0] == spelling.get(variable.unit, variable.unit), variable.name


def test_file_holds_the_run_and_says_what_it_is(case, tmp_path):
    path = tmp_path / "run.nc"
    summary = run_case(case, path, block=64)
    assert summary.complete
    assert summary.steps == summary.planned == 300
    model = build_model(case)
    expected = simulate(model, duration=0.05, record=case.output.record).collect()
    with open_result(path) as result:
        assert set(result.data_vars) == {*case.output.record, "final_state"}
        for name in ("time", "distance", *case.output.record):
            np.testing.assert_array_equal(result[name].values, expected[name], err_msg=name)
        assert set(result["force_z"].coords) == {"time", "distance"}
        assert result["force_z"].attrs["units"] == "N"
        assert result["time"].attrs["units"] == "s"
        assert result["in_contact"].attrs["flag_meanings"] == "out_of_contact in_contact"
        assert all(result[name].attrs["long_name"] for name in result.variables)
        attributes = result.attrs
        assert attributes["title"] == "Prüfstand $1"
        assert attributes["wheelrail_version"] == __version__
        assert attributes["complete"] == 1
        assert tomllib.loads(attributes["case"]) == case.to_dict()
        # The case can be had back, without the excitation and its files.
        assert case_of_result(result, source="x").track == case.track
    with netCDF4.Dataset(path) as file:
        assert file.dimensions["time"].isunlimited()
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.nc"]


@pytest.mark.parametrize("number", [None, signal.SIGINT, signal.SIGTERM])
def test_interrupted_and_resumed_equals_uninterrupted(case, tmp_path, number):
    whole, path = tmp_path / "whole.nc", tmp_path / "run.nc"
    run_case(case, whole)
    summary = run_case(case, path, block=50, progress=Interrupter(100, number))
    assert not summary.complete
    assert summary.interrupted_by == (number or signal.SIGINT)
    with open_result(path) as result:
        assert result.attrs["complete"] == 0
        # The start is the first row of the first block.
        assert result.sizes["time"] == summary.steps + 1 == 150
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    # Twice more, so that an interrupted continuation is covered too.
    again = run_case(case, path, block=50, resume=True, progress=Interrupter(180, number))
    assert not again.complete
    assert again.resumed_from == summary.steps < again.steps
    last = run_case(case, path, resume=True)
    assert last.complete
    assert last.resumed_from == again.steps
    same_data(whole, path)
    assert last.statistics.samples == 301
    with open_result(whole) as a:
        force = a["force_z"].values
    assert last.statistics.force_max == force.max()
    assert last.statistics.force_mean == pytest.approx(force.mean(), rel=1e-12)
    assert not list(tmp_path.glob("*.part"))


def test_resume_of_a_complete_run_changes_nothing_or_makes_it_longer(case, tmp_path):
    whole, path = tmp_path / "whole.nc", tmp_path / "run.nc"
    longer = changed(case, simulation={"duration": 0.08})
    run_case(longer, whole)
    run_case(case, path)
    before = path.read_bytes()
    summary = run_case(case, path, resume=True)
    assert summary.complete
    assert summary.resumed_from == summary.steps == 300
    assert path.read_bytes() == before
    run_case(longer, path, resume=True)
    same_data(whole, path)
    with pytest.raises(ResultFileError, match=r"holds 0.08 s already, more than the 0.05 s"):
        run_case(case, path, resume=True)


def test_resume_refuses_another_case_and_says_where_it_differs(case, tmp_path):
    path = tmp_path / "run.nc"
    run_case(case, path, block=50, progress=Interrupter(100))
    before = path.read_bytes()
    other = changed(case, load={"preload": 60e3}, track={"bays": 22})
    with pytest.raises(ResultFileError) as refusal:
        run_case(other, path, resume=True)
    assert "load.preload: 65000.0 in the file, 60000.0 in the case" in str(refusal.value)
    assert "track.bays: 20 in the file, 22 in the case" in str(refusal.value)
    assert "wheel" not in str(refusal.value)
    assert path.read_bytes() == before


def test_resume_refuses_a_changed_data_file(tmp_path):
    data = tmp_path / "line.csv"
    text = CASE[: CASE.index("[[excitation]]")] + '[[excitation]]\ntype = "measured"\nfile = "line.csv"\non = "rail"\n'

    def write(scale):
        rows = [f"{0.005 * i:.3f},{scale * np.sin(i):.6f}" for i in range(600)]
        data.write_text("position (m),height (um)\n" + "\n".join(rows) + "\n")

    write(3.0)
    case = parse_case(text, folder=tmp_path)
    path = tmp_path / "run.nc"
    assert not run_case(case, path, block=50, progress=Interrupter(100)).complete
    write(4.0)
    with pytest.raises(ResultFileError, match="a data file"):
        run_case(case, path, resume=True)
    write(3.0)
    assert run_case(case, path, resume=True).complete


def test_case_differences():
    before = {"a": {"x": 1.0, "y": [1, 2]}, "excitation": [{"type": "s"}], "simulation": {"duration": 1.0}}
    assert case_differences(before, before) == []
    now = {"a": {"x": 2.0, "y": [1, 2]}, "excitation": [{"type": "t"}, {"seed": 1}], "simulation": {"duration": 9.0}}
    assert case_differences(before, now) == [
        "a.x: 1.0 in the file, 2.0 in the case",
        "excitation #1.type: s in the file, t in the case",
        "excitation #2.seed: left out in the file, 1 in the case",
    ]


def test_a_run_that_can_not_go_on_keeps_what_it_has(case, tmp_path):
    rows = [f"{0.005 * i:.3f},{np.sin(i):.6f}" for i in range(-20, 120)]
    (tmp_path / "line.csv").write_text("position (m),height (um)\n" + "\n".join(rows) + "\n")
    data = case.to_dict()
    data["excitation"] = [{"type": "measured", "file": "line.csv", "on": "rail"}]
    data["simulation"]["start_position"] = 0.0
    path = tmp_path / "run.nc"
    with pytest.raises(ExcitationRangeError) as error:
        run_case(case_from_dict(data, folder=tmp_path), path)
    with open_result(path) as result:
        steps = result.sizes["time"] - 1
        assert result.attrs["complete"] == 0
        # The line ends at 0.595 m.
        assert steps == 119
    assert any(str(path) in note and "0.0198333 s" in note for note in error.value.__notes__)


def test_a_failed_run_leaves_the_older_result(case, tmp_path):
    path = tmp_path / "run.nc"
    run_case(case, path)
    before = path.read_bytes()

    def fail(_):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run_case(case, path, block=50, progress=fail)
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.nc"]


def test_an_unfinished_writer_leaves_nothing(tmp_path):
    path = tmp_path / "run.nc"
    with ResultWriter(path, attributes={}, record=("force_z",), continued=False) as writer:
        writer.append({name: np.zeros(3) for name in ("time", "distance", "force_z")})
        assert not path.exists()
    assert not list(tmp_path.iterdir())


def test_a_finished_writer_replaces(tmp_path):
    path = tmp_path / "run.nc"
    for length in (3, 5):
        with ResultWriter(path, attributes={}, record=("force_z",), continued=False) as writer:
            writer.append({name: np.zeros(length) for name in ("time", "distance", "force_z")})
            writer.finish(state=b"12345678", digest="d", statistics=Statistics(), complete=True)
        with open_result(path) as result:
            assert result.sizes["time"] == length
            assert result["final_state"].values.tobytes() == b"12345678"


def test_foreign_files_are_refused_in_words(case, tmp_path):
    text = tmp_path / "text.nc"
    text.write_text("hello")
    foreign = tmp_path / "foreign.nc"
    with netCDF4.Dataset(foreign, "w") as file:
        file.createDimension("time", 3)
    cut = tmp_path / "cut.nc"
    run_case(case, cut)
    cut.write_bytes(cut.read_bytes()[:3000])
    for path, words in (
        (tmp_path / "none.nc", "no such file"),
        (tmp_path, "is a folder"),
        (text, "is not a netCDF file"),
        (foreign, "not one that wheelrail run has written"),
        (cut, "damaged"),
    ):
        with pytest.raises(ResultFileError, match=words):
            open_result(path)
    # Neither are they overwritten.
    for path in (text, foreign):
        before = path.read_bytes()
        with pytest.raises(ResultFileError, match="not overwritten"):
            run_case(case, path)
        assert path.read_bytes() == before
    with pytest.raises(ResultFileError, match=r"the folder .* does not exist"):
        run_case(case, tmp_path / "nowhere" / "run.nc")
    with pytest.raises(ResultFileError, match="no such file to continue"):
        read_checkpoint(tmp_path / "none.nc")
