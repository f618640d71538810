"""Set up a virtual environment in .venv with everything, then run the main job (or what is named).

    python3 quickstart.py           build the default FMU, run it under a quarter vehicle, draw the result
    python3 quickstart.py test      run the tests

Needs Python 3.11 or later and nothing else; no compiler.
"""

import os
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ENVIRONMENT = HERE / ".venv"
PYTHON = ENVIRONMENT / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
STAMP = ENVIRONMENT / "wheelrail-installed"


def set_up() -> None:
    """Create the environment and install the project, unless that was done after the last change of its metadata."""
    metadata = HERE / "pyproject.toml"
    if STAMP.exists() and STAMP.read_bytes() == metadata.read_bytes():
        return
    print("setting up .venv ...", flush=True)
    if not PYTHON.exists():
        venv.create(ENVIRONMENT, with_pip=True)
    install = [PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--editable", f"{HERE}[test]"]
    subprocess.run(install, check=True)
    STAMP.write_bytes(metadata.read_bytes())


def main() -> int:
    """Do what the arguments say; return the exit code."""
    if sys.version_info < (3, 11):
        print(f"Python 3.11 or later is needed, this is {sys.version.split()[0]}", file=sys.stderr)
        return 2
    arguments = sys.argv[1:]
    if arguments and arguments[0] != "test":
        print(__doc__)
        return 0 if arguments[0] in ("-h", "--help") else 2
    try:
        set_up()
    except (subprocess.CalledProcessError, OSError) as error:
        print(
            f"the environment could not be set up: {error}\n"
            "On Debian and Ubuntu, the package python3-venv is needed as well.",
            file=sys.stderr,
        )
        return 2
    job = ["-m", "pytest", *arguments[1:]] if arguments else [str(HERE / "examples" / "quarter_vehicle.py")]
    return subprocess.run([PYTHON, *job], cwd=HERE, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
