"""The command line: what it prints, its exit codes, and that mistakes get one message."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from wheelrail.case import default_case_text, load_case, parse_case
from wheelrail.cli import main
from wheelrail.results import open_result
from wheelrail.run import run_case
from wheelrail.version import __version__

CASE = """
title = "small"
[simulation]
speed = 30.0
dx = 5e-3
duration = 0.05
start_position = 0.0
[wheel]
preset = "thesis-1dof"
[track]
model = "rigid"
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
"""


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.toml").write_text(CASE)


def command(*arguments, **options):
    # The tests run where the package is not installed, too.
    paths = [str(Path(__file__).parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.Popen(
        [sys.executable, "-m", "wheelrail", *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )


def test_run_writes_the_result_and_sums_it_up(capsys):
    assert main(["run", "small.toml"]) == 0
    out, err = capsys.readouterr()
    assert err == ""  # no terminal, no bar
    with open_result("small.nc") as result:  # named after the case
        force = result["force_z"].values
        assert len(force) == 301
    assert "steps            300 of 166.7 us" in out
    assert f"min {force.min() / 1e3:.3f} kN, mean {force.mean() / 1e3:.3f} kN, max {force.max() / 1e3:.3f} kN" in out
    assert "out of contact   0 % of the time" in out
    assert "small.nc" in out


def test_run_options(capsys):
    assert main(["run", "small.toml", "--output", "other.nc", "--duration", "0.02", "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")
    with open_result("other.nc") as result:
        assert result.sizes["time"] == 121
    assert main(["run", "small.toml", "--output", "other.nc", "--resume"]) == 0
    assert "300 of 166.7 us, continued after 120 steps" in capsys.readouterr().out
    assert main(["run", "small.toml", "--output", "other.nc", "--resume"]) == 0
    assert "other.nc is complete already: 300 steps" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["run", "missing.toml"], "missing.toml: 1 fault\n  - no such file"),
        (["run", "small.toml", "--output", "nowhere/x.nc"], "the folder nowhere does not exist"),
        (["run", "small.toml", "--duration", "-1"], "simulation.duration = -1"),
        (["run", "small.toml", "--output", "small.toml"], "small.toml: is not a netCDF file"),
        (["run", "small.toml", "--resume"], "no such file to continue"),
        (["plot", "missing.nc"], "missing.nc: no such file"),
        (["explain", "missing.toml"], "no such file"),
        (["build", "missing.toml"], "no such file"),
    ],
)
def test_mistakes_get_one_message_and_exit_code_2(capsys, arguments, words):
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: ")
    assert words in err
    assert "Traceback" not in err
    assert Path("small.toml").read_text() == CASE


@pytest.mark.skipif(os.name == "nt", reason="no SIGINT to another process")
def test_ctrl_c_saves_what_there_is_and_says_how_to_continue():
    process = command(
        "run",
        "small.toml",
        "--duration",
        "600",
        # A shell that puts a command into the background has it ignore SIGINT, and that is inherited.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    deadline = time.monotonic() + 60.0
    while not os.path.exists("small.nc.part") and time.monotonic() < deadline:
        time.sleep(0.05)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert out == ""
    with open_result("small.nc") as result:
        steps = result.sizes["time"] - 1
        assert result.attrs["complete"] == 0
    assert f"the {steps} steps up to there are in small.nc" in err
    assert "to continue: wheelrail run small.toml --duration 600 --resume" in err
    assert "Traceback" not in err
    assert not os.path.exists("small.nc.part")


def test_an_interrupted_result_is_not_replaced_without_a_word(capsys):
    def interrupt(_):
        raise KeyboardInterrupt

    run_case(load_case("small.toml"), "small.nc", progress=interrupt, block=50)
    assert main(["run", "small.toml"]) == 0
    assert "small.nc holds an interrupted run, which will be replaced" in capsys.readouterr().err
    assert main(["run", "small.toml"]) == 0
    assert capsys.readouterr().err == ""


def test_ctrl_c_before_anything_is_saved(capsys, monkeypatch):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("wheelrail.run.build_model", interrupt)
    assert main(["run", "small.toml"]) == 130
    assert capsys.readouterr().err == "interrupted; nothing was saved\n"
    assert os.listdir() == ["small.toml"]


def test_closed_pipe_gives_no_traceback():
    process = command("schema")
    process.stdout.close()  # before anything is printed
    err = process.stderr.read()
    process.stderr.close()
    assert process.wait(timeout=60) == 141
    assert err == ""


def test_default_case_and_schema(capsys):
    assert main(["default-case"]) == 0
    text = capsys.readouterr().out
    assert text == default_case_text()
    parse_case(text)
    assert main(["schema"]) == 0
    assert "simulation" in json.loads(capsys.readouterr().out)["properties"]


def test_no_case_is_the_default_case_and_says_so(capsys):
    assert main(["explain"]) == 0
    out, err = capsys.readouterr()
    title = parse_case(default_case_text()).title
    assert err.count("\n") == 1
    assert f'the default case, "{title}"' in err
    assert out.startswith(title)


def test_version(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out.strip() == f"wheelrail {__version__}"


def test_cache_is_listed_and_cleared(capsys, tmp_path):
    text = CASE.replace('model = "rigid"', 'preset = "thesis-discrete"\nbays = 20\nmemory = 0.02')
    (tmp_path / "track.toml").write_text(text)
    assert main(["cache"]) == 0
    assert "0 files" in capsys.readouterr().out
    assert main(["run", "track.toml", "--quiet"]) == 0
    assert main(["cache", "list"]) == 0
    out = capsys.readouterr().out
    assert "DiscreteTrack, 108 km/h, dx 5 mm: 130 functions" in out
    assert main(["cache", "clear"]) == 0
    assert "1 file removed" in capsys.readouterr().out
    assert not list((tmp_path / "cache").iterdir())


def test_plot_names_its_files(capsys):
    assert main(["run", "small.toml", "--quiet"]) == 0
    os.mkdir("figures")
    assert main(["plot", "small.nc", "--output", "figures", "--format", "svg"]) == 0
    out, err = capsys.readouterr()
    names = out.split()
    assert sorted(os.path.basename(name) for name in names) == sorted(os.listdir("figures"))
    assert len(names) == 4
    assert err == ""


@pytest.mark.fmu
def test_build_writes_the_fmu(capsys):
    assert main(["build", "small.toml"]) == 0
    assert capsys.readouterr().out.startswith("WheelRail.fmu: ")
    assert os.path.getsize("WheelRail.fmu") > 10_000


def test_a_study_is_not_a_case_nor_a_case_a_study(tmp_path, capsys):
    examples = Path(__file__).parents[2] / "examples"
    assert main(["run", str(examples / "studies" / "speed_and_preload.toml"), "--output", str(tmp_path / "a.nc")]) == 2
    assert "vary: unknown key; this is a study file: wheelrail study runs it" in capsys.readouterr().err
    assert main(["study", str(examples / "cases" / "sine.toml"), "--output", str(tmp_path / "b.nc")]) == 2
    assert "this is a case file: wheelrail run runs it" in capsys.readouterr().err


def test_an_option_without_effect_is_refused(tmp_path, capsys):
    line = Path(__file__).parents[2] / "examples" / "data" / "rail_roughness_sample.csv"
    assert main(["roughness", str(line), "--wheel-radius", "0.46", "--output", str(tmp_path)]) == 2
    assert "only used with on = wheel" in capsys.readouterr().err
