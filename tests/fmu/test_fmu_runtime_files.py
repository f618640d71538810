"""The choice of what travels in the FMU."""

from __future__ import annotations

from pathlib import Path

import pytest

import wheelrail
from fmu_src.build import _MODEL_ENTRIES, _runtime
from fmu_src.errors import BuildError
from fmu_src.runtime_files import content_hash, runtime_files


def write(folder: Path, **files: str) -> None:
    for name, text in files.items():
        path = folder / (name.replace("__", "/") + ".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def test_follows_relative_imports_with_their_packages(tmp_path: Path) -> None:
    write(tmp_path, a__one="from ..b import two\nimport numpy.linalg, json\n", b__two="from .three import x\n")
    write(tmp_path, b__three="def f():\n    from .. import four\nx = 1\n", four="", five="import scipy\n")
    for package in ("", "a", "b"):
        (tmp_path / package / "__init__.py").write_text("")
    found = runtime_files(tmp_path, ["a/one.py"])
    assert list(found) == sorted(
        ["__init__.py", "a/__init__.py", "a/one.py", "b/__init__.py", "b/three.py", "b/two.py", "four.py"]
    )


@pytest.mark.parametrize(
    "text",
    ["import scipy", "from scipy.sparse import x", "def f():\n    import pydantic", "from wheelrail.errors import X"],
)
def test_refuses_what_a_host_may_lack(tmp_path: Path, text: str) -> None:
    (tmp_path / "__init__.py").write_text("")
    write(tmp_path, one="from .two import x", two=text)
    with pytest.raises(BuildError, match=r"two\.py, line \d: import of"):
        runtime_files(tmp_path, ["one.py"])


def test_type_checking_imports_do_not_count(tmp_path: Path) -> None:
    (tmp_path / "__init__.py").write_text("")
    write(tmp_path, one="from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import scipy\n")
    assert "one.py" in runtime_files(tmp_path, ["one.py"])


def test_missing_module_is_said(tmp_path: Path) -> None:
    (tmp_path / "__init__.py").write_text("")
    write(tmp_path, one="from .none import x")
    with pytest.raises(BuildError, match=r"none\.py"):
        runtime_files(tmp_path, ["one.py"])


def test_the_package_keeps_the_rule() -> None:
    found = runtime_files(Path(wheelrail.__file__).parent, _MODEL_ENTRIES)
    assert "interaction/cosimulation.py" in found
    assert not any(name.startswith(("case/", "study/", "analysis/", "reference/")) for name in found)


def test_hash_holds_names_and_content() -> None:
    files = _runtime()
    one = content_hash(files)
    assert one == content_hash(dict(reversed(files.items())))
    assert one != content_hash({**files, "errors.py": files["errors.py"] + b"\n"})
    assert one != content_hash({f"x{name}": source for name, source in files.items()})
