"""Reading case files: TOML, presets, validation, and all faults of a file in one report."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from wheelrail.case.checking import CaseCheck
from wheelrail.case.definition import Case
from wheelrail.errors import CaseError

__all__ = ["case_from_dict", "default_case_text", "load_case", "parse_case"]


def default_case_text() -> str:
    """Return the case file that comes with the program: a small realistic case with comments."""
    return resources.files("wheelrail.case").joinpath("default.toml").read_text(encoding="utf-8")


def load_case(path: str | Path) -> Case:
    """Read a case file.

    Parameters
    ----------
    path : str or pathlib.Path
        The TOML file. Data files that it names are relative to its folder.

    Returns
    -------
    Case
        With presets resolved and everything that a run needs.

    Raises
    ------
    CaseError
        The file can't be read or has faults, all of which are listed.
    """
    path = Path(path)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise CaseError(str(path), ["no such file"]) from None
    except IsADirectoryError:
        raise CaseError(str(path), ["is a folder, not a case file"]) from None
    except UnicodeDecodeError as error:
        raise CaseError(
            str(path), [f"not UTF-8 text: byte {error.start} is {error.object[error.start]:#04x}"]
        ) from None
    except (OSError, ValueError) as error:
        raise CaseError(str(path), [f"can't be read: {getattr(error, 'strerror', None) or error}"]) from None
    return parse_case(text, source=str(path), folder=path.parent)


def parse_case(text: str, *, source: str = "case", folder: str | Path = ".") -> Case:
    """Read the text of a case file.

    Parameters
    ----------
    text : str
        TOML.
    source : str
        Name of the file for messages; if it ends in ``.toml``, the result file is named after it.
    folder : str or pathlib.Path
        Folder that data files are relative to.

    Returns
    -------
    Case
        As from :func:`load_case`.

    Raises
    ------
    CaseError
        With all faults of the text.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = str(error)
        if message.endswith("(at end of document)"):
            line, column = text.count("\n") + 1, len(text) - text.rfind("\n")
            message = message.removesuffix("(at end of document)") + f"(at end of file, line {line}, column {column})"
        raise CaseError(source, [f"not valid TOML: {message}"]) from None
    except RecursionError:
        raise CaseError(source, ["not valid TOML: nested too deeply"]) from None
    return case_from_dict(data, source=source, folder=folder)


def case_from_dict(data: Mapping[str, Any], *, source: str = "case", folder: str | Path = ".") -> Case:
    """Make a case from plain values in the layout of the case file, such as a changed :meth:`Case.to_dict`.

    Parameters
    ----------
    data : mapping
        Sections and keys; may name presets.
    source, folder
        As in :func:`parse_case`.

    Returns
    -------
    Case
        As from :func:`load_case`.

    Raises
    ------
    CaseError
        With all faults of the values.
    """
    check = CaseCheck(data, folder=Path(folder))
    if Path(source).suffix == ".toml" and isinstance(output := check.data.setdefault("output", {}), dict):
        output.setdefault("file", Path(source).stem + ".nc")
    case = check.run()
    if case is None:
        raise CaseError(source, check.faults)
    case._folder = Path(folder)
    return case
