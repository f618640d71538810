"""Studies on worker processes: the same bytes as in one process, however they are interrupted."""

from __future__ import annotations

import os
import signal
import time

import pytest
from distributed import LocalCluster
from study_points import BROKEN, command, crest, die_at_60_kn

from wheelrail.errors import ParameterError
from wheelrail.study import run_study
from wheelrail.study.store import parts_path

LONG = """
[set]
"simulation.duration" = 0.4
"contact.length" = 45e-3
[vary]
"load.preload" = { from = 40e3, to = 60e3, count = 5 }
"friction.coefficient" = [0.2, 0.3]
"""


@pytest.mark.slow
def test_one_worker_four_and_none_give_the_same_bytes(study_of, tmp_path):
    study, found = study_of(BROKEN), []
    for workers in (0, 1, 4):
        path = tmp_path / f"{workers}.nc"
        summary = run_study(study, path, workers=workers, measure=crest)
        assert (summary.workers, len(summary.failures)) == (workers, 2)
        found.append(path.read_bytes())
    assert found[0] == found[1] == found[2]


def test_an_existing_cluster(study_of, tmp_path):
    study = study_of(BROKEN)
    run_study(study, tmp_path / "here.nc", workers=0)
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
        run_study(study, tmp_path / "there.nc", scheduler=cluster.scheduler_address)
    assert (tmp_path / "there.nc").read_bytes() == (tmp_path / "here.nc").read_bytes()


def test_a_scheduler_that_is_not_there_is_refused(study_of, tmp_path, monkeypatch):
    monkeypatch.setattr("wheelrail.study.cluster._ANSWER", 0.5)
    with pytest.raises(ParameterError, match="no Dask scheduler answers there"):
        run_study(study_of(BROKEN), tmp_path / "study.nc", scheduler="tcp://127.0.0.1:9")


@pytest.mark.slow
def test_a_worker_that_dies_fails_its_point_only(study_of, tmp_path):
    study = study_of('[vary]\n"load.preload" = [50e3, 60e3, 70e3]')
    summary = run_study(study, tmp_path / "study.nc", workers=1, measure=die_at_60_kn)
    ((point, reason),) = summary.failures
    assert point.case.load.preload == 60e3
    assert reason == "its worker process died twice, for lack of memory or by a crash"


def wait_for_points(process, folder, count):
    deadline = time.monotonic() + 60.0
    while len(list(folder.glob("*.point"))) < count:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL")
def test_killed_at_half_and_continued_it_gives_the_same_bytes(study_of, tmp_path):
    study, path = study_of(LONG), tmp_path / "study.nc"
    run_study(study, tmp_path / "whole.nc", workers=0)
    process = command("study", "study.toml", "--workers", "2")
    wait_for_points(process, parts_path(path), 5)
    process.kill()
    process.wait()
    kept = len(list(parts_path(path).glob("*.point")))
    assert 5 <= kept < 10
    assert not path.exists()
    summary = run_study(study, path, workers=0, resume=True)
    assert (summary.resumed_from, summary.finished) == (kept, 10)
    assert path.read_bytes() == (tmp_path / "whole.nc").read_bytes()


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="no signals to another process")
@pytest.mark.parametrize(("number", "workers"), [(signal.SIGINT, "2"), (signal.SIGTERM, "0")])
def test_stopped_it_says_how_to_continue_and_nothing_else(study_of, tmp_path, number, workers):
    study_of(LONG.replace("0.4", "1.2"))  # so that it is not done before it can be stopped
    path = tmp_path / "study.nc"
    process = command(
        "study",
        "study.toml",
        "--workers",
        workers,
        start_new_session=True,
        # A shell that puts a command into the background has it ignore SIGINT, and that is inherited.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    wait_for_points(process, parts_path(path), 2)
    # The terminal sends Ctrl-C to the workers as well.
    os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
    out, err = process.communicate(timeout=60)
    kept = len(list(parts_path(path).glob("*.point")))
    assert process.returncode == 128 + number
    assert out == ""
    assert err == (
        f"interrupted; {kept} of 10 points are finished and kept\nto continue: wheelrail study study.toml --resume\n"
    )


@pytest.mark.slow
def test_a_map_of_108_points_runs_unattended(study_of, tmp_path):
    study = study_of(
        '[set]\n"simulation.duration" = 0.5\n"contact.length" = 45e-3\n[vary]\n'
        '"simulation.speed" = { from = 10.0, to = 30.0, count = 6 }\n'
        '"load.preload" = { from = 40e3, to = 80e3, count = 6 }\n"friction.coefficient" = [0.1, 0.2, 0.3]'
    )
    summary = run_study(study, tmp_path / "study.nc")
    assert (summary.finished, summary.failures, summary.models) == (108, (), 36)
