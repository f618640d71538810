"""What the tests of running studies share: a study with a point that fails, measures of one's own, and the command."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

# The contact of the last preload is longer than the potential contact area, which shows when the run begins.
BROKEN = """
[vary]
"load.preload" = [50e3, 60e3, 500e3]
"friction.coefficient" = [0.2, 0.3]
[results]
from = 0.01
outputs = ["force_z"]
statistics = ["mean", "std", "rms", "min", "max", "p90"]
histories = ["force_z", "wheel_disp_z"]
third_octave = { outputs = ["force_z"], lowest = 100.0, highest = 5000.0 }
"""


def crest(run):
    """Measure a run: crest factor of the force, and the force at three instants."""
    force = run.outputs["force_z"][run.settled]
    return {"crest": np.max(np.abs(force)) / np.sqrt(np.mean(force**2)), "first_forces": force[:3]}


def die_at_60_kn(run):
    """End the process as the system does when memory runs out."""
    if run.case.load.preload == 60e3:
        os._exit(9)
    return {}


def command(*arguments, **options):
    """Start ``wheelrail`` in a process of its own."""
    paths = [str(Path(__file__).parents[3]), *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.Popen(
        [sys.executable, "-m", "wheelrail", *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )
