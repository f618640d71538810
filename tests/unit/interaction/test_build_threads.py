"""What is built must not depend on the number of cores or threads."""

import os
import subprocess
import sys
from pathlib import Path

SCRIPT = """
import sys
from pathlib import Path
from wheelrail.case import parse_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.model_file import save_model
case = parse_case(Path(sys.argv[1]).read_text())
save_model(build_model(case), sys.argv[2])
"""
CASE = """
[simulation]
speed = 25.0
dx = 5e-3
duration = 0.01
start_position = 0.0
[wheel]
preset = "thesis-2dof"
[track]
preset = "thesis-discrete"
memory = 0.03
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
[load]
preload = 65e3
coupling = "load"
"""


def test_one_and_two_threads_build_the_same_bytes(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    built = []
    for threads in ("1", "2"):
        names = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), threads)
        path = os.pathsep.join([str(Path(__file__).parents[3]), os.environ.get("PYTHONPATH", "")])
        environment = {**os.environ, **names, "WHEELRAIL_CACHE": str(tmp_path / threads), "PYTHONPATH": path}
        target = tmp_path / f"model{threads}"
        subprocess.run(
            [sys.executable, "-c", SCRIPT, str(tmp_path / "case.toml"), str(target)], env=environment, check=True
        )
        built.append(target.read_bytes())
    assert built[0] == built[1]
