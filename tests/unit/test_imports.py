"""Import directions, and what the run time may import."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "wheelrail"

# A part may import its own modules, those of the parts named here, and the modules directly in the package.
ALLOWED = {
    "numerics": set(),
    "wheel": {"numerics"},
    "track": {"numerics"},
    "excitation": {"numerics"},
    "contact": {"numerics"},
    "profile": {"numerics"},
    "greens": {"numerics"},
    "case": {"numerics"},
}
FORBIDDEN_EVERYWHERE_BELOW = {"analysis", "study", "cli"}
CORE = {"numerics", "wheel", "track", "excitation", "contact", "profile", "greens", "interaction"}

# Of the interaction, what turns a case into a model.
PREPARATION = {
    f"interaction/{name}.py"
    for name in ("build", "contacts", "friction", "profiles", "tracks", "wheel_sources", "wheels")
}

# Shipped inside the FMU.
RUNTIME = [
    "errors.py",
    "version.py",
    "__init__.py",
    *(
        f"interaction/{name}.py"
        for name in ("cosimulation", "inputs", "model", "model_file", "parameters", "start", "state", "step")
    ),
    *(f"interaction/{name}.py" for name in ("geometry_parts", "place_watch", "surfaces")),
    *(
        f"contact/{name}.py"
        for name in ("bedding", "geometry", "newton", "parts", "solution", "spring", "tangential_models")
    ),
    *(
        f"contact/{name}.py"
        for name in ("influence", "half_space", "half_space_contact", "normal", "rolling", "tangential")
    ),
    *(f"contact/{name}.py" for name in ("point_contact", "slip_dependent_model", "slip_dependent_rolling")),
    *(
        f"contact/friction/{name}.py"
        for name in (
            "__init__",
            "laws",
            "memory",
            "newton",
            "problem",
            "settings",
            "solutions",
            "solve",
            "thesis_iteration",
        )
    ),
    *(
        f"contact/creep/{name}.py"
        for name in (
            "__init__",
            "contact_spring",
            "creep_force",
            "friction_curve",
            "kalker_coefficients",
            "linear",
            "fastsim",
        )
    ),
    *(f"excitation/{name}.py" for name in ("line", "sampled_heights", "sinusoid", "sources", "spectrum_line")),
    *(f"excitation/{name}.py" for name in ("corrugation", "irregularity", "lateral_interpolation", "out_of_round")),
    *(
        f"excitation/{name}.py"
        for name in ("coherent_spectrum", "coherent_synthesis", "spectrum_recipe", "surface_lines")
    ),
    "excitation/synthesis.py",
    *(f"profile/{name}.py" for name in ("contact_search", "curve", "profile_geometry", "undeformed_distance")),
    *(
        f"greens/{name}.py"
        for name in ("combined", "modal", "parts", "protocol", "recursion", "sampled", "track_response")
    ),
    "numerics/array_file.py",
    "numerics/blas_threads.py",
    "numerics/third_octave_bands.py",
    *(
        f"{part}/__init__.py"
        for part in (
            "analysis",
            "contact",
            "excitation",
            "greens",
            "interaction",
            "numerics",
            "profile",
            "track",
            "wheel",
        )
    ),
]


def imported(path: Path) -> list[tuple[str, bool]]:
    """Modules that a file imports, in full, and whether relatively; imports for type checkers too."""
    found = []
    parents = ("wheelrail", *path.relative_to(PACKAGE).parent.parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(alias.name, False) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = parents[: len(parents) - node.level + 1] if node.level else ()
            module = ".".join([*base, *([node.module] if node.module else [])])
            found.append((module, node.level > 0))
            # "from .. import x" may name a part.
            found += [(f"{module}.{alias.name}", node.level > 0) for alias in node.names]
    return found


def parts_used(path: Path) -> set[str]:
    names = (module.split(".") for module, _ in imported(path) if module.startswith("wheelrail."))
    return {name[1] for name in names if (PACKAGE / name[1]).is_dir() or name[1] == "cli"}


@pytest.mark.parametrize("part", sorted(ALLOWED))
def test_parts_do_not_import_their_neighbours(part):
    files = sorted((PACKAGE / part).rglob("*.py"))
    assert files
    for path in files:
        assert parts_used(path) <= ALLOWED[part] | {part}, path


def test_nothing_below_imports_what_is_above():
    for part in CORE:
        for path in (PACKAGE / part).rglob("*.py"):
            used = parts_used(path)
            assert not used & (FORBIDDEN_EVERYWHERE_BELOW | {"reference"}), path
            if path.relative_to(PACKAGE).as_posix() not in PREPARATION:
                assert "case" not in used, path


def test_the_scanner_sees_relative_and_absolute_imports():
    # The tests above would pass if the scanner saw nothing.
    for name in ("build", "tracks", "wheels"):
        used = parts_used(PACKAGE / "interaction" / f"{name}.py")
        assert {"contact", "excitation", "case"} <= used if name == "build" else {"greens", name[:-1], "case"} <= used
    assert "numerics" in parts_used(PACKAGE / "analysis" / "third_octave.py")


@pytest.mark.parametrize("name", RUNTIME)
def test_runtime_modules_import_the_standard_library_and_numpy_only(name):
    for module, relative in imported(PACKAGE / name):
        top = module.split(".")[0]
        assert relative or top == "numpy" or top in sys.stdlib_module_names, f"{name} imports {module}"


def test_the_list_of_runtime_modules_is_complete():
    """What the run imports is what is listed, and neither scipy nor pydantic."""
    script = (
        "import sys; sys.path.insert(0, sys.argv[1]);"
        "import wheelrail.interaction.cosimulation, wheelrail.interaction.model_file;"
        "print('\\n'.join(sys.modules))"
    )
    out = subprocess.run(
        [sys.executable, "-c", script, str(PACKAGE.parent)], capture_output=True, text=True, check=True
    ).stdout.split()
    heavy = {"scipy", "pydantic", "xarray", "matplotlib", "pandas", "netCDF4", "platformdirs", "tomli_w", "tqdm"}
    assert not {name.split(".")[0] for name in out} & heavy
    loaded = {name for name in out if name.split(".")[0] == "wheelrail"}
    listed = {".".join(["wheelrail", *Path(name).with_suffix("").parts]).removesuffix(".__init__") for name in RUNTIME}
    assert loaded <= listed
