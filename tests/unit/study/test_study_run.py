"""Running a study in one process: its numbers, its failures, and how it goes on after an interruption."""

from __future__ import annotations

import logging

import numpy as np
import pytest
import xarray as xr
from study_points import BROKEN, crest

from wheelrail.analysis.third_octave import third_octave
from wheelrail.case import load_case
from wheelrail.cli import main
from wheelrail.errors import ParameterError
from wheelrail.results import ResultFileError, open_result
from wheelrail.run import run_case
from wheelrail.study import run_study
from wheelrail.study.store import parts_path


def test_numbers_are_those_of_single_runs(study_of, tmp_path):
    """Against the result files of `wheelrail run`, which knows nothing of studies, and sums by hand."""
    study = study_of(BROKEN)
    run_study(study, tmp_path / "study.nc", workers=0)
    base = load_case(tmp_path / "base.toml").to_toml()
    with xr.open_dataset(tmp_path / "study.nc") as data:
        for preload in (50e3, 60e3):
            text = base.replace("preload = 65000.0", f"preload = {preload}")
            assert text != base
            (tmp_path / "one.toml").write_text(text)
            run_case(load_case(tmp_path / "one.toml"), tmp_path / "one.nc")
            with open_result(tmp_path / "one.nc") as single:
                force, time = single["force_z"].values, single["time"].values
            point = data.sel(load_preload=preload, friction_coefficient=0.2)
            assert np.array_equal(point["force_z_history"], force)
            part = force[time >= 0.01 - 1e-9]
            found = {str(name): float(point["force_z"].sel(statistic=name)) for name in data["statistic"].values}
            assert found["mean"] == part.sum() / len(part) or abs(found["mean"] / part.mean() - 1) < 1e-14
            assert (found["min"], found["max"]) == (part.min(), part.max())
            assert found["rms"] ** 2 == pytest.approx(found["mean"] ** 2 + found["std"] ** 2, rel=1e-13)
            assert np.mean(part <= found["p90"]) == pytest.approx(0.9, abs=1.5 / len(part))
            assert point["dt"] == time[1]
            assert point["samples"] == len(force)
            spectrum = third_octave(part, spacing=time[1], lowest=100.0)
            bands = point["force_z_third_octave"]
            # Nyquist is 3 kHz: bands above it can't be there, those that are too narrow for 0.04 s neither.
            assert np.all(np.isnan(bands.sel(band=slice(2800.0, None))))
            assert np.isnan(bands[0])
            good = np.isfinite(bands.values)
            assert good.sum() > 8
            both = np.intersect1d(bands["band"].values[good], spectrum.centres)
            assert len(both) == good.sum()
            expected = spectrum.rms[np.isin(spectrum.centres, both)]
            assert np.allclose(bands.values[good], expected, rtol=1e-12)


def test_a_broken_point_is_reported_with_its_reason_and_the_rest_is_done(study_of, tmp_path):
    summary = run_study(study_of(BROKEN), tmp_path / "study.nc", workers=0)
    assert summary.complete
    assert [point.case.load.preload for point, _ in summary.failures] == [500e3, 500e3]
    reason = summary.failures[0][1]
    assert "contact.length" in reason or "potential contact area" in reason
    with xr.open_dataset(tmp_path / "study.nc") as data:
        assert data.sizes == {
            "load_preload": 3,
            "friction_coefficient": 2,
            "statistic": 6,
            "band": 16,
            "step": 301,
        }
        assert data["status"].values.tolist() == [[0, 0], [0, 0], [1, 1]]
        assert data["reason"].values.tolist() == [["", ""], ["", ""], [reason, reason]]
        assert np.all(np.isnan(data["force_z"].sel(load_preload=500e3)))
        assert np.all(np.isfinite(data["force_z"].sel(load_preload=[50e3, 60e3])))
        assert data.attrs["failed_points"] == 2


def test_the_data_set_is_labelled(study_of, tmp_path):
    study = study_of('title = "Steps"\n' + BROKEN)
    run_study(study, tmp_path / "study.nc", workers=0)
    with xr.open_dataset(tmp_path / "study.nc") as data:
        preload = data["load_preload"]
        assert preload.values.tolist() == [50e3, 60e3, 500e3]
        assert preload.attrs == {
            "key": "load.preload",
            "long_name": "Quasi-static vertical load on the wheel",
            "units": "N",
        }
        assert data["force_z"].attrs["units"] == "N"
        assert data["band"].attrs["units"] == "Hz"
        assert data.attrs["title"] == "Steps"
        assert data.attrs["study"] == study.text
        assert data.attrs["case"] == (tmp_path / "base.toml").read_text()


def test_a_list_and_values_that_are_no_numbers(study_of, tmp_path):
    study = study_of(
        'combine = "list"\n[vary]\n"contact.length" = [25e-3, 35e-3]\n"load.coupling" = ["load", "displacement"]\n'
        '[results]\nhistories = ["force_z"]\noutputs = []'
    )
    run_study(study, tmp_path / "study.nc", workers=0)
    with xr.open_dataset(tmp_path / "study.nc") as data:
        assert data["force_z_history"].dims == ("point", "step")
        assert data["load_coupling"].values.tolist() == ["load", "displacement"]
        assert data["case_contact_length"].values.tolist() == [25e-3, 35e-3]  # contact_length is an output
        assert data["point"].values.tolist() == [1, 2]


def test_histories_of_different_length_are_filled_up(study_of, tmp_path):
    study = study_of('[vary]\n"simulation.duration" = [0.02, 0.01]\n[results]\nhistories = ["force_z"]')
    run_study(study, tmp_path / "study.nc", workers=0)
    with xr.open_dataset(tmp_path / "study.nc") as data:
        long, short = data["force_z_history"].values
    assert np.array_equal(short[:61], long[:61])
    assert np.all(np.isnan(short[61:]))
    assert np.all(np.isfinite(long))


def test_squeal_measures(study_of, tmp_path):
    study = study_of(
        '[set]\n"contact.normal" = "hertz"\n"contact.tangential" = "fastsim"\n"creepage.x" = 0.0\n'
        '"creepage.y" = 1e-3\n"creepage.spin" = 0.0\n[vary]\n"friction.coefficient" = [0.1, 0.4]\n'
        "[results]\nsqueal = true\noutputs = []"
    )
    run_study(study, tmp_path / "study.nc", workers=0)
    with xr.open_dataset(tmp_path / "study.nc") as data:
        less, more = data["squeal_stick_share"].values
        assert 0.0 < less < more == 1.0  # with friction enough, some of the contact always sticks
        assert np.all(data["squeal_force_rms"] > 0.0)
        assert data["squeal_main_frequency"].attrs["units"] == "Hz"


def test_a_measure_of_ones_own(study_of, tmp_path):
    run_study(study_of(BROKEN), tmp_path / "study.nc", workers=0, measure=crest)
    with xr.open_dataset(tmp_path / "study.nc") as data:
        force = data["force_z"].sel(load_preload=50e3, friction_coefficient=0.3)
        expected = max(abs(force.sel(statistic="max")), abs(force.sel(statistic="min"))) / force.sel(statistic="rms")
        own = data.sel(load_preload=50e3, friction_coefficient=0.3)
        assert float(own["crest"]) == pytest.approx(float(expected), rel=1e-14)
        assert np.array_equal(own["first_forces"], own["force_z_history"][60:63])
        assert np.all(np.isnan(data["crest"].sel(load_preload=500e3)))


def test_a_measure_that_fails_fails_its_points_only(study_of, tmp_path):
    def faulty(run):
        return {"force_z": 1.0} if run.case.load.preload == 50e3 else {"fine": {}["missing"]}

    summary = run_study(study_of(BROKEN), tmp_path / "study.nc", workers=0, measure=faulty)
    reasons = [reason for _, reason in summary.failures]
    assert "names must be identifiers that the data set does not use already" in reasons[0]
    assert reasons[2] == "KeyError: 'missing'"


def test_warnings_are_kept_with_their_points(study_of, tmp_path):
    def warn(run):
        if run.case.load.preload == 60e3:
            logging.getLogger("wheelrail.somewhere").warning("take care of %g N", run.case.load.preload)
        return {}

    run_study(study_of('[vary]\n"load.preload" = [50e3, 60e3]'), tmp_path / "study.nc", workers=0, measure=warn)
    with xr.open_dataset(tmp_path / "study.nc") as data:
        assert data["remarks"].values.tolist() == ["", "take care of 60000 N"]


def interrupted_after(count):
    def stop(_, finished):
        if finished == count:
            raise KeyboardInterrupt

    return stop


def test_continued_after_an_interruption_it_gives_the_same_bytes(study_of, tmp_path):
    study = study_of(BROKEN)
    run_study(study, tmp_path / "whole.nc", workers=0)
    path = tmp_path / "study.nc"
    summary = run_study(study, path, workers=0, progress=interrupted_after(3))
    assert (summary.finished, summary.complete, path.exists()) == (3, False, False)
    before = {file.name: file.stat().st_mtime_ns for file in parts_path(path).glob("*.point")}
    computed = []
    summary = run_study(study, path, workers=0, resume=True, progress=lambda outcome, _: computed.append(outcome))
    assert (summary.finished, summary.resumed_from) == (6, 3)
    assert [outcome.index for outcome in computed if outcome] == [3, 4, 5]  # what was there is not done again
    after = {file.name: file.stat().st_mtime_ns for file in parts_path(path).glob("*.point")}
    assert before.items() <= after.items()
    assert path.read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_a_complete_study_is_complete(study_of, tmp_path):
    study, path = study_of('[vary]\n"load.preload" = [50e3, 60e3]'), tmp_path / "study.nc"
    run_study(study, path, workers=0)
    assert not parts_path(path).exists()
    content = path.read_bytes()
    summary = run_study(study, path, workers=0, resume=True)
    assert (summary.finished, summary.resumed_from, summary.models) == (2, 2, 0)
    assert path.read_bytes() == content
    other = study_of('[vary]\n"load.preload" = [50e3, 70e3]')
    with pytest.raises(ResultFileError, match="no interrupted study to continue"):
        run_study(other, path, workers=0, resume=True)


def test_damaged_and_half_written_points_are_computed_again(study_of, tmp_path):
    study, path = study_of(BROKEN), tmp_path / "study.nc"
    run_study(study, path, workers=0)
    content = path.read_bytes()
    points = sorted(parts_path(path).glob("*.point"))
    points[0].write_bytes(points[0].read_bytes()[:-1])
    (parts_path(path) / ".point-000001.point.x.part").write_bytes(b"half")
    assert run_study(study, path, workers=0, resume=True).resumed_from == 5
    assert path.read_bytes() == content


def test_failed_points_are_tried_again_only_when_asked(study_of, tmp_path):
    study, path = study_of(BROKEN), tmp_path / "study.nc"
    run_study(study, path, workers=0)
    assert run_study(study, path, workers=0, resume=True).resumed_from == 6
    again = run_study(study, path, workers=0, retry_failed=True)
    assert (again.resumed_from, len(again.failures)) == (4, 2)


@pytest.mark.parametrize(
    ("before", "now", "words"),
    [
        (
            '"load.preload" = [50e3, 60e3, 500e3]',
            '"load.preload" = [50e3, 60e3, 400e3]',
            "vary: load.preload #3: 500000.0",
        ),
        ("from = 0.01", "from = 0.02", "results: settle: 0.01 before, 0.02 now"),
        ("\n[vary]", "seed = 3\n[vary]", "seed: left out before, 3 now"),
        (
            '[vary]\n"load.preload"',
            '[set]\nwheel.mass = 99.0\n[vary]\n"load.preload"',
            "case: wheel: mass: left out before",
        ),
    ],
)
def test_another_study_is_not_continued(study_of, tmp_path, before, now, words):
    assert before in BROKEN
    path = tmp_path / "study.nc"
    run_study(study_of(BROKEN), path, workers=0)
    with pytest.raises(ResultFileError, match="it belongs to another study") as error:
        run_study(study_of(BROKEN.replace(before, now)), path, workers=0, resume=True)
    assert words in str(error.value)


def test_changed_data_files_and_measures_are_noticed(study_of, tmp_path):
    path, spectrum = tmp_path / "study.nc", tmp_path / "spectrum.csv"
    spectrum.write_text("wavelength (m),level (dB)\n0.1,10\n0.08,9\n0.063,8\n")
    case = (tmp_path / "base.toml").read_text().replace('name = "iso3095-2013-limit"', 'file = "spectrum.csv"')
    (tmp_path / "base.toml").write_text(case)
    study = study_of(BROKEN)
    run_study(study, path, workers=0)
    with pytest.raises(ResultFileError, match=r"measure: left out before, .*crest"):
        run_study(study, path, workers=0, resume=True, measure=crest)
    spectrum.write_text(spectrum.read_text().replace("0.08,9", "0.08,9.5"))
    with pytest.raises(ResultFileError, match=r"data files: spectrum\.csv: .* before"):
        run_study(study_of(BROKEN), path, workers=0, resume=True)


def test_what_is_not_a_study_is_not_overwritten(study_of, tmp_path):
    study = study_of(BROKEN)
    run_case(load_case(tmp_path / "base.toml"), tmp_path / "run.nc")
    with pytest.raises(ResultFileError, match="is not a data set of wheelrail study"):
        run_study(study, tmp_path / "run.nc", workers=0)
    with pytest.raises(ResultFileError, match="does not exist"):
        run_study(study, tmp_path / "none" / "study.nc", workers=0)
    (tmp_path / "study.nc.parts").mkdir()
    (tmp_path / "study.nc.parts" / "mine.txt").write_text("mine")
    with pytest.raises(ResultFileError, match="is in the way"):
        run_study(study, tmp_path / "study.nc", workers=0)
    with pytest.raises(ParameterError, match="workers"):
        run_study(study, tmp_path / "other.nc", workers=-1)


def test_command(study_of, capsys):
    study_of(BROKEN)
    assert main(["study", "study.toml", "--workers", "0"]) == 1
    out, err = capsys.readouterr()
    assert "points           4 done, 2 failed" in out
    assert "failed: point 5 (load.preload = 500000.0, friction.coefficient = 0.2): " in err
    assert main(["study", "study.toml", "--workers", "0", "--resume", "--quiet"]) == 1
    study_of('[vary]\n"load.preload" = [50e3]')
    assert main(["study", "study.toml", "--workers", "0", "--resume"]) == 2
    assert "it belongs to another study" in capsys.readouterr().err
    assert main(["study", "study.toml", "--workers", "0"]) == 0
    out, err = capsys.readouterr()
    assert "1 done, 0 failed" in out
    assert "--resume would continue it" in err
    assert main(["study", "none.toml"]) == 2


def test_a_measure_does_not_hide_what_the_data_set_has(study_of, tmp_path):
    def clumsy(run):
        return {"load_preload": 3.0} if run.case.load.preload == 50e3 else {"status": 1.0}

    study = study_of('[vary]\n"load.preload" = [50e3, 60e3]')
    summary = run_study(study, tmp_path / "study.nc", workers=0, measure=clumsy)
    ((point, reason),) = summary.failures
    assert point.case.load.preload == 60e3
    assert "measure = 'status'" in reason
    with xr.open_dataset(tmp_path / "study.nc") as data:
        assert list(data["load_preload"].values) == [50e3, 60e3]
        assert data["measured_load_preload"].values[0] == 3.0
        assert list(data["status"].values) == [0, 1]


def test_a_long_title_is_no_file_name(study_of, tmp_path):
    base = tmp_path / "base.toml"
    base.write_text(base.read_text().replace('title = "small"', f'title = "{"long " * 100}"'))
    study = study_of('[vary]\n"load.preload" = [50e3]')
    assert run_study(study, tmp_path / "study.nc", workers=0).complete
