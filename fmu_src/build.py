"""Build ``WheelRail.fmu`` from a case: model, variable table, runtime, documentation, one reproducible archive."""

from __future__ import annotations

import importlib.metadata
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

import tomli_w

from wheelrail.case import Case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model
from wheelrail.version import __version__

from .archive import write_archive
from .documentation import documentation
from .errors import BuildError
from .guard import WRAPPER_VERSION
from .model_description import MODEL_IDENTIFIER, Description, guid, model_description
from .reference import reference_files
from .runtime_files import content_hash, runtime_files
from .slave import IDENTITY_FILE, MODEL_FILE
from .variables import CONSTANTS, VARIABLES

__all__ = ["BuiltFmu", "build_fmu", "describe_fmu"]

STEP_SIZE = 1e-3
"""Communication step of the default experiment (s)."""

REFERENCE_STEPS = 20_000
"""Internal steps that the reference result covers at most."""

_MODEL_ENTRIES = ("errors.py", "version.py", "interaction/cosimulation.py", "interaction/model_file.py")
_SLAVE_ENTRIES = ("slave.py",)
_ENTRY_TEMPLATE = "entry_template.txt"


@dataclass(frozen=True)
class BuiltFmu:
    """What a finished build can say about itself.

    Attributes
    ----------
    path : Path
        The FMU.
    size : int
        Its size (bytes).
    ports : int
        Number of inputs and outputs.
    """

    path: Path
    size: int
    ports: int


def describe_fmu(path: Path) -> BuiltFmu:
    """Return path, size and number of ports of a built FMU."""
    return BuiltFmu(path, path.stat().st_size, sum(variable.role in ("input", "output") for variable in VARIABLES))


def build_fmu(case: Case, output_dir: str | Path, progress: Callable[[float], None] | None = None) -> Path:
    """Build ``WheelRail.fmu``.

    Two builds of the same case with the same versions give the same bytes. An old FMU is replaced when the new one is
    complete.

    Parameters
    ----------
    case : Case
        What the FMU computes.
    output_dir : str or Path
        Folder of the FMU, made where it is missing.
    progress : callable, optional
        Called with the share of the Green's functions done.

    Returns
    -------
    Path
        The FMU.

    Raises
    ------
    WheelrailError
        If the model can't be built.
    BuildError
        If PythonFMU is missing or of another version, or the FMU can't be written.
    """
    if Path(output_dir).is_file():
        raise BuildError(f"{output_dir}: is a file; --output takes the folder that the FMU is to be written to.")
    binaries = _binaries()
    licences = _licences()
    model_bytes = _model_bytes(case, progress)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, MODEL_FILE)
        path.write_bytes(model_bytes)
        model = load_model(path)  # what the FMU will read, so that the reference result is the FMU's

    runtime = _runtime()
    version = content_hash(runtime)[:12]
    package, script = f"wheelrail_rt_{version}", f"wheelrail_fmu_{version}"
    entry = runtime.pop(_ENTRY_TEMPLATE).replace(b"RUNTIME_PACKAGE", package.encode())

    simulation = CoSimulation(model)
    constants = _constants(case, model.geometry.description)
    start = {**simulation.inputs, **simulation.parameters, **constants}
    stop_time = float(case.simulation.duration) or STEP_SIZE
    step_size = min(STEP_SIZE, stop_time)
    given = [variable.name for variable in VARIABLES if variable.role not in ("output", "calculated")]
    missing = [name for name in given if name not in start]
    if missing:
        raise BuildError(f"no start value for {', '.join(missing)}: variable table and co-simulation disagree.")

    def described(identity: str) -> bytes:
        return model_description(Description(start, identity, stop_time, step_size, __version__, _title(case)))

    model_sha256 = content_hash({MODEL_FILE: model_bytes})
    files: dict[str, bytes] = {
        f"resources/{script}.py": entry,
        "resources/slavemodule.txt": script.encode(),
        f"resources/{MODEL_FILE}": model_bytes,
        "resources/case.toml": _case_text(case).encode(),
        f"resources/{IDENTITY_FILE}": json.dumps(
            {"model_sha256": model_sha256, "constants": constants}, sort_keys=True, indent=2
        ).encode(),
        **{f"resources/{package}/{name}": source for name, source in runtime.items()},
        **binaries,
        **licences,
        "model.png": resources.files("fmu_src").joinpath("model.png").read_bytes(),
    }
    files |= reference_files(
        simulation,
        stop_time=stop_time,
        step_size=step_size,
        duration=REFERENCE_STEPS * case.simulation.dx / case.simulation.speed,
    )
    files["documentation/index.html"] = documentation(
        start=start,
        lateral=model.lateral,
        case_text=_case_text(case),
        title=_title(case),
        version=__version__,
        step_size=step_size,
    ).encode()
    files["modelDescription.xml"] = described(guid(described(""), *(files[name] for name in sorted(files))))
    path = Path(output_dir) / f"{MODEL_IDENTIFIER}.fmu"
    write_archive(path, files)
    return path


def _model_bytes(case: Case, progress: Callable[[float], None] | None) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, MODEL_FILE)
        model = build_model(case, progress=progress)
        save_model(replace(model, case=_case_text(case)), path)
        return path.read_bytes()


def _runtime() -> dict[str, bytes]:
    """Collect what the FMU runs, laid out as inside the runtime package, and the template of the entry script."""
    model_root = Path(str(resources.files("wheelrail")))
    own_root = Path(str(resources.files("fmu_src")))
    files = runtime_files(model_root, _MODEL_ENTRIES)
    files |= {f"fmu_src/{name}": source for name, source in runtime_files(own_root, _SLAVE_ENTRIES).items()}
    files[_ENTRY_TEMPLATE] = (own_root / _ENTRY_TEMPLATE).read_bytes()
    return files


def _binaries() -> dict[str, bytes]:
    """Return PythonFMU's binaries under the name of this FMU."""
    try:
        found = importlib.metadata.version("pythonfmu")
        root = resources.files("pythonfmu") / "resources" / "binaries"
    except ImportError as error:  # PackageNotFoundError is one
        raise BuildError(f"PythonFMU is missing: pip install pythonfmu=={WRAPPER_VERSION}.") from error
    if found != WRAPPER_VERSION:
        raise BuildError(
            f"PythonFMU {found} is refused: what works round the defects of its binary (fmu_src/guard.py) belongs to "
            f"version {WRAPPER_VERSION}. pip install pythonfmu=={WRAPPER_VERSION}."
        )
    files: dict[str, bytes] = {}
    for platform in sorted(root.iterdir(), key=lambda folder: folder.name):
        for binary in platform.iterdir():
            suffix = PurePosixPath(binary.name).suffix
            if suffix in (".so", ".dll", ".dylib"):
                files[f"binaries/{platform.name}/{MODEL_IDENTIFIER}{suffix}"] = binary.read_bytes()
    if not files:
        raise BuildError(f"PythonFMU {found} has no binaries in {root}; install its wheel from PyPI.")
    return files


def _licences() -> dict[str, bytes]:
    """Return the licence texts of this package and of PythonFMU, whose binaries are in the FMU."""
    beside = Path(str(resources.files("fmu_src"))).parent / "LICENSE"
    own = beside.read_bytes() if beside.is_file() else _distribution_licence("wheelrail")
    return {
        "documentation/licenses/license.txt": own,
        "documentation/licenses/pythonfmu.txt": _distribution_licence("pythonfmu"),
    }


def _distribution_licence(name: str) -> bytes:
    for file in importlib.metadata.files(name) or ():
        if file.name == "LICENSE" and ".dist-info" in file.as_posix():
            return file.read_binary()
    raise BuildError(f"the licence text of {name} is missing from its installation; install it again.")


def _constants(case: Case, geometry: str) -> dict[str, Any]:
    """Return the fixed values that the FMU shows."""
    values: dict[str, Any] = {
        "dx": float(case.simulation.dx),
        "wheel_radius": float(case.wheel.radius),
        "wheel_model": case.wheel.model,
        "track_model": case.track.model,
        "normal_contact_model": case.contact.normal,
        "tangential_contact_model": case.contact.tangential,
        "friction_law": "none" if case.friction is None else case.friction.law,
        "contact_geometry": geometry,
        "case_title": _title(case),
    }
    return {name: values[name] for name in CONSTANTS}


def _title(case: Case) -> str:
    return " ".join((case.title or "untitled case").split())


def _case_text(case: Case) -> str:
    """Return the case with the folders of absolute paths left out: they belong to the machine that builds."""
    return tomli_w.dumps(_without_folders(case.to_dict()))


def _without_folders(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_folders(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_without_folders(item) for item in value]
    if isinstance(value, str):
        for kind in (PurePosixPath, PureWindowsPath):
            if kind(value).is_absolute():
                return kind(value).name
    return value
