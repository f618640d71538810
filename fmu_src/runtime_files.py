"""Which source files an FMU carries: the entry modules and all that they import, nothing that the host may lack."""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from .errors import BuildError

__all__ = ["ALLOWED", "content_hash", "runtime_files"]

ALLOWED = frozenset({"numpy"})
"""Packages beside the standard library that the runtime may import."""


def runtime_files(root: Path, entries: Iterable[str]) -> dict[str, bytes]:
    """Collect modules and, through their relative imports, everything that they need.

    Parameters
    ----------
    root : Path
        Folder of a package.
    entries : iterable of str
        Modules to start from, relative to the folder, such as ``"interaction/cosimulation.py"``.

    Returns
    -------
    dict of str to bytes
        Source by path relative to the folder, with ``/``; the ``__init__.py`` of all packages on the way are in it.

    Raises
    ------
    BuildError
        If a file imports anything but the standard library, numpy and modules below the folder, or does not exist.
    """
    found: dict[str, bytes] = {}
    waiting = list(entries)
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        path = root / name
        if not path.is_file():
            raise BuildError(f"{path}: the FMU needs this module, and it is not there.")
        found[name] = path.read_bytes()
        folder = Path(name).parent
        waiting += [(parent / "__init__.py").as_posix() for parent in (folder, *folder.parents)]
        waiting += _imports(root, name, found[name])
    return dict(sorted(found.items()))


def content_hash(files: Mapping[str, bytes]) -> str:
    """Return the SHA-256 of files and their names, as 64 hexadecimal digits."""
    digest = hashlib.sha256()
    for name in sorted(files):
        digest.update(f"{name}\0{len(files[name])}\0".encode())
        digest.update(files[name])
    return digest.hexdigest()


def _imports(root: Path, name: str, source: bytes) -> list[str]:
    wanted: list[str] = []
    for node in _runtime_nodes(ast.parse(source, filename=name)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                _check_foreign(root / name, node.lineno, alias.name)
        elif isinstance(node, ast.ImportFrom):
            if node.level == 0:
                _check_foreign(root / name, node.lineno, node.module or "")
            else:
                wanted += _relative(root, name, node)
    return wanted


def _runtime_nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """Walk a tree without what only type checkers read."""
    for child in ast.iter_child_nodes(tree):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            continue
        yield child
        yield from _runtime_nodes(child)


def _check_foreign(path: Path, line: int, module: str) -> None:
    top = module.partition(".")[0]
    if top not in sys.stdlib_module_names and top not in ALLOWED:
        raise BuildError(
            f"{path}, line {line}: import of {module!r} is refused: what travels in the FMU imports only the standard "
            f"library, {', '.join(sorted(ALLOWED))} and, relatively, modules of its own package."
        )


def _relative(root: Path, name: str, node: ast.ImportFrom) -> list[str]:
    folder = Path(name).parent
    for _ in range(node.level - 1):
        if folder == Path("."):
            raise BuildError(f"{root / name}, line {node.lineno}: the relative import leaves the package.")
        folder = folder.parent
    for part in (node.module or "").split("."):
        folder = folder / part if part else folder
    wanted: list[str] = []
    if node.module:
        wanted.append(_module_file(root, folder) or f"{folder.as_posix()}.py")
    for alias in node.names:  # "from .package import module"
        module = _module_file(root, folder / alias.name)
        if module:
            wanted.append(module)
    return wanted


def _module_file(root: Path, module: Path) -> str | None:
    for candidate in (module.with_name(module.name + ".py"), module / "__init__.py"):
        if (root / candidate).is_file():
            return candidate.as_posix()
    return None
