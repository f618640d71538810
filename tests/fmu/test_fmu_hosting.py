"""Hosts: errors leave them alive, a bare environment suffices, instances and FMUs stay apart, unusual folders."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fmu_host import UnpackedFmu

pytestmark = pytest.mark.fmu

Run = Callable[..., subprocess.CompletedProcess[str]]

MANY_ERRORS = """
import gc, sys, math
from pathlib import Path
from fmu_host import UnpackedFmu
fmu = UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2]))
instance = fmu.instance()
failures = 0
def fails(call, *arguments, **values):
    global failures
    before = len(instance.log)
    try:
        call(*arguments, **values)
    except Exception as error:
        failures += 1
        assert len(instance.log) > before, "no word in the FMI log"
    else:
        raise AssertionError("accepted")
before = instance.get("force_z")
for _ in range(25):
    fails(instance.set, wheel_force_z=math.nan)
    fails(instance.set, speed=-1.0)
    fails(instance.set, force_z=1.0)
    fails(instance.slave.getReal, [9999])
    fails(instance.slave.doStep, instance.time, -1e-3)
    fails(instance.slave.doStep, instance.time, math.nan)
    state = instance.slave.deSerializeFMUstate(b"nonsense" * 9)
    fails(instance.slave.setFMUState, state)
    instance.slave.freeFMUState(state)
assert instance.get("force_z") == before
instance.step(1e-3)
after = instance.get("force_z")
instance.slave.reset()
instance.time = 0.0
instance.begin()
instance.step(1e-3)
assert instance.get("force_z") == after
instance.close()
gc.collect()
left = [thing for thing in gc.get_objects() if type(thing).__name__ == "WheelRail"]
assert not left, "references given back that nothing had dropped"
for status, category, text in instance.log:
    print(status, category, text.replace("\\n", " | "))
print("failures", failures)
"""


def test_many_exceptions_leave_the_host_alive_and_are_explained(
    quick_path: Path, tmp_path: Path, run_host: Run
) -> None:
    done = run_host(MANY_ERRORS, quick_path, tmp_path / "unpacked")
    assert done.returncode == 0, done.stderr
    assert "failures 175" in done.stdout
    for text in (done.stdout, done.stderr):
        assert text.count("wheel_force_z = nan is refused") >= 25
        assert text.count("speed = -1.0 is refused") >= 25
        assert text.count("force_z = 1.0 is refused") >= 25
        assert text.count("value reference 9999 is refused") >= 25
        assert text.count("do_step: ") == 50
        assert text.count("was not saved by this version") >= 25
    assert done.stderr.count("WheelRail wheel: error: ") == 175
    assert "Traceback" not in done.stderr  # all of them are the user's


THREADS = """
import sys, math, threading
from pathlib import Path
from fmu_host import UnpackedFmu
fmu = UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2]))
results = []
def run(number):
    instance = fmu.instance(f"thread{number}")
    for _ in range(20):
        try:
            instance.set(wheel_z=math.inf)
        except Exception:
            pass
        instance.step(1e-4)
    results.append(instance.get("force_z"))
    instance.close()
threads = [threading.Thread(target=run, args=(number,)) for number in range(5)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
assert len(results) == 5 and len(set(results)) == 1, results
"""


def test_exceptions_in_several_threads(quick_path: Path, tmp_path: Path, run_host: Run) -> None:
    done = run_host(THREADS, quick_path, tmp_path / "unpacked")
    assert done.returncode == 0, done.stderr
    for number in range(5):
        assert done.stderr.count(f"WheelRail thread{number}: error: set_real: wheel_z = inf") == 20


HUNDRED = """
import gc, sys
from pathlib import Path
from fmu_host import UnpackedFmu
path_before = list(sys.path)
fmu = UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2]))
instances = [fmu.instance(f"i{number}", wheel_force_z=60e3 + 100 * number) for number in range(100)]
assert sys.path == path_before, "resources stay in sys.path"
sources = {id(o.sources) for o in gc.get_objects() if type(o).__name__ == "Model"}
assert len(sources) == 1, sources
for _ in range(2):
    for instance in instances:
        instance.step(1e-3)
forces = [instance.get("force_z") for instance in instances]
assert len(set(forces)) == 100
lone = fmu.instance("lone", wheel_force_z=60e3 + 100 * 42)
lone.step(1e-3); lone.step(1e-3)
assert lone.get("force_z") == forces[42]
for instance in instances:
    instance.close()
gc.collect()
slaves = [o for o in gc.get_objects() if type(o).__name__ == "WheelRail"]
assert len(slaves) == 1, slaves
lone.step(1e-3)
for _ in range(100):  # again and again in one process: the entry script runs each time
    again = fmu.instance("again"); again.close(); gc.collect()
lone.step(1e-3)
lone.close()
"""


def test_hundred_instances_share_the_model_and_nothing_else(quick_path: Path, tmp_path: Path, run_host: Run) -> None:
    done = run_host(HUNDRED, quick_path, tmp_path / "unpacked")
    assert done.returncode == 0, done.stderr


def test_two_fmus_in_one_process_keep_apart(quick_fmu: UnpackedFmu, small_fmu: UnpackedFmu) -> None:
    alone = {}
    for name, fmu in (("quick", quick_fmu), ("small", small_fmu)):
        instance = fmu.instance()
        for _ in range(5):
            instance.step(1e-3)
        alone[name] = instance.get("force_z")
        instance.close()
    quick, small = quick_fmu.instance(), small_fmu.instance()
    for _ in range(5):
        quick.step(1e-3)
        small.step(1e-3)
    assert quick.get("force_z") == alone["quick"]
    assert small.get("force_z") == alone["small"]
    assert alone["quick"] != alone["small"]
    assert quick.get("case_title") != small.get("case_title")
    quick.close()
    small.close()


BARE = """
import sys
class Bare:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {"wheelrail", "fmu_src", "pythonfmu", "scipy", "pydantic", "matplotlib", "xarray"}:
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Bare())
from fmpy import simulate_fmu
result = simulate_fmu(sys.argv[1], stop_time=0.005, output_interval=1e-3, output=["force_z"])
print(*[repr(float(value)) for value in result["force_z"]])
"""


def test_runs_where_only_numpy_and_a_host_are(quick_path: Path, quick_fmu: UnpackedFmu, run_host: Run) -> None:
    done = run_host(BARE, quick_path, isolated=True)
    assert done.returncode == 0, done.stderr
    instance = quick_fmu.instance()
    forces = [instance.get("force_z")]
    for _ in range(5):
        instance.step(1e-3)
        forces.append(instance.get("force_z"))
    assert [float(text) for text in done.stdout.split()] == forces
    instance.close()


def test_missing_numpy_is_said(quick_path: Path, tmp_path: Path, run_host: Run) -> None:
    script = """
import sys
from pathlib import Path
from fmu_host import UnpackedFmu
import fmpy.fmi2
fmu = UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2]))
for name in [name for name in sys.modules if name.partition(".")[0] == "numpy"]:
    del sys.modules[name]
sys.modules["numpy"] = None
try:
    fmu.instance()
except Exception as error:
    print("refused", error)
"""
    done = run_host(script, quick_path, tmp_path / "unpacked")
    assert done.returncode == 0, done.stderr
    assert "refused" in done.stdout
    assert "the FMU needs numpy in the host's Python" in done.stderr


def test_reset_with_the_model_gone_is_an_error_and_no_crash(quick_path: Path, tmp_path: Path, run_host: Run) -> None:
    script = """
import shutil, sys
from pathlib import Path
from fmu_host import UnpackedFmu
fmu = UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2]))
instance = fmu.instance()
shutil.rmtree(Path(fmu.folder, "resources"))
instance.slave.reset()
for _ in range(50):
    try:
        instance.begin()
    except Exception as error:
        continue
    raise AssertionError("accepted")
instance.slave.freeInstance()
"""
    done = run_host(script, quick_path, tmp_path / "unpacked")
    assert done.returncode == 0, done.stderr
    assert "fmi2Reset failed" in done.stderr


def test_folder_with_a_space(quick_path: Path, tmp_path: Path) -> None:
    forces = []
    for folder in ("plain", "with space"):
        instance = UnpackedFmu(quick_path, tmp_path / folder).instance()
        instance.step(1e-3)
        forces.append(instance.get("force_z"))
        instance.close()
    assert forces[0] == forces[1] > 0.0


@pytest.mark.parametrize("letter", ["é", "#", "%"])
def test_folder_the_wrapper_cannot_open(letter: str, quick_path: Path, tmp_path: Path, run_host: Run) -> None:
    """The wrapper crashes before anything of the FMU runs; once this fails, the documentation can be shorter."""
    script = """
import sys
from pathlib import Path
from fmu_host import UnpackedFmu
UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2])).instance().close()
print("runs")
"""
    done = run_host(script, quick_path, tmp_path / f"a{letter}b")
    assert "runs" not in done.stdout
    assert done.returncode != 0


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the double release is on Linux only")
def test_interpreter_object_is_released_once_at_exit(quick_path: Path, tmp_path: Path, run_host: Run) -> None:
    """The second release reads freed memory: rarely a crash, so that the registration is checked instead."""
    script = """
import atexit, sys
from pathlib import Path
from fmu_host import UnpackedFmu
fmu = UnpackedFmu(Path(sys.argv[1]), Path(sys.argv[2]))
for _ in range(3):
    fmu.instance().close()
guard = next(module for name, module in sys.modules.items() if name.endswith(".fmu_src.guard"))
assert len(guard._released_at_exit) == 1
print("registered", atexit._ncallbacks() >= 1)
"""
    done = run_host(script, quick_path, tmp_path / "unpacked")
    assert done.returncode == 0, done.stderr
    assert "registered True" in done.stdout
