"""Reading study files: TOML, the cases of all points, and all faults in one report before anything is computed."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from wheelrail.case import Case, case_from_dict, load_case
from wheelrail.case.faults import in_words, shown_value
from wheelrail.errors import CaseError
from wheelrail.study.checking import TableCheck
from wheelrail.study.definition import Axis, Point, Study, label_of
from wheelrail.study.measures import ResultSettings
from wheelrail.study.results_table import ResultsTable, result_faults
from wheelrail.study.variation import (
    MOST_POINTS,
    combined,
    flattened,
    key_fault,
    per_point_seeds,
    shown_full,
    spread,
    with_values,
)

__all__ = ["load_study", "study_from_dict"]

_KEYS = ("title", "case", "combine", "seed", "set", "vary", "point", "results", "workers")
_LARGEST_SEED = 2**31 - 1
_MOST_LINES = 20


def load_study(path: str | Path) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : str or pathlib.Path
        The TOML file. The case file that it names is relative to its folder.

    Returns
    -------
    Study
        With the valid cases of all points.

    Raises
    ------
    CaseError
        The study file, its case file or the case of a point has faults, all of which are listed.
    """
    path = Path(path)
    text = _text_of(path)
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise CaseError(str(path), [f"not valid TOML: {error}"]) from None
    return study_from_dict(data, source=str(path), folder=path.parent, text=text)


def _text_of(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        reason = "no such file"
    except IsADirectoryError:
        reason = "is a folder, not a study file"
    except UnicodeDecodeError as error:
        reason = f"not UTF-8 text: byte {error.start} is {error.object[error.start]:#04x}"
    except OSError as error:
        reason = f"can't be read: {error.strerror or error}"
    raise CaseError(str(path), [reason])


def study_from_dict(
    data: Mapping[str, Any], *, source: str = "study", folder: str | Path = ".", text: str = ""
) -> Study:
    """Make a study from plain values in the layout of the study file.

    Parameters
    ----------
    data : mapping
    source : str
        Name of the file for messages.
    folder : str or pathlib.Path
        Folder that the case file is relative to.
    text : str
        The study file as text, kept in the data set.

    Returns
    -------
    Study
        As from `load_study`.

    Raises
    ------
    CaseError
        As from `load_study`.
    """
    return _StudyCheck(data, source, Path(folder)).run(text)


class _StudyCheck:
    """Collects the faults of one study."""

    def __init__(self, data: Mapping[str, Any], source: str, folder: Path) -> None:
        self.data, self.source, self.folder = data, source, folder
        self._check = TableCheck()
        self._set: frozenset[str] = frozenset()

    def run(self, text: str) -> Study:
        self._check.known(self.data, _KEYS, "")
        title = self.data.get("title", "")
        if not isinstance(title, str):
            self._check.faults.append(f"title = {shown_value(title)}: must be text")
        path, base, case_text, base_case = self._base_case()
        seed = self._check.whole("seed", self.data.get("seed"), 0, _LARGEST_SEED)
        workers = self._workers()
        results = ResultsTable(self.data.get("results", {}), base_case, self._check).settings()
        base = self._with_set(base)
        columns, grid = self._columns(base)
        for key in columns if seed is not None else ():
            if key.startswith("excitation.") and key.endswith(".seed"):
                self._check.faults.append(
                    f"{key}: varied, but seed = {seed} gives every point seeds of its own; leave one of them out"
                )
        self._stop_if_faulty()
        keys = tuple(columns)
        points = self._points(base, path, keys, combined(list(columns.values()), grid=grid), seed, results)
        self._stop_if_faulty()
        return Study(
            title=title or base_case.title,
            source=self.source,
            text=text,
            case_text=case_text,
            base=base,
            axes=tuple(Axis(key, values) for key, values in columns.items()),
            grid=grid,
            points=tuple(points),
            results=results,
            seed=seed,
            workers=workers,
        )

    def _stop_if_faulty(self) -> None:
        if self._check.faults:
            more = len(self._check.faults) - _MOST_LINES
            raise CaseError(
                self.source,
                self._check.faults if more <= 1 else [*self._check.faults[:_MOST_LINES], f"and {more} more"],
            )

    def _own_keys(self, name: str) -> tuple[str, ...]:
        """Keys of a table in which keys of the case file stand, which are judged elsewhere."""
        table = self.data.get(name)
        return tuple(table) if isinstance(table, Mapping) else ()

    def _workers(self) -> int | None:
        table = self._check.table("workers", self.data.get("workers", {}), ("count",))
        return self._check.whole("workers.count", table.get("count"), 0, 1000)

    def _base_case(self) -> tuple[Path, dict[str, Any], str, Case]:
        """Read the case file; without it nothing else can be judged."""
        name = self.data.get("case")
        if not isinstance(name, str) or not name:
            given = "missing" if name is None else f"= {shown_value(name)}"
            self._check.faults.append(f"case: {given}; give the case file, relative to the folder of the study file")
            self._stop_if_faulty()
        path = self.folder / str(name)
        try:
            case = load_case(path)
        except CaseError as error:
            self._check.faults += [f'case = "{name}": {path}: {fault}' for fault in error.faults]
            self._stop_if_faulty()
            raise
        text = _text_of(path)
        return path, tomllib.loads(text), text, case

    def _with_set(self, base: dict[str, Any]) -> dict[str, Any]:
        """Put what all points have in place of the case's values into the base."""
        leaves = flattened(self._check.table("set", self.data.get("set", {}), self._own_keys("set")))
        self._set = frozenset(leaves)
        for key in tuple(leaves):
            fault = key_fault(base, key)
            if fault is not None:
                self._check.faults.append(f"set.{key}: {fault}")
                del leaves[key]
        return with_values(base, tuple(leaves), tuple(leaves.values()))

    def _columns(self, base: Mapping[str, Any]) -> tuple[dict[str, tuple[Any, ...]], bool]:
        """Values by key, and whether they make a grid."""
        combine = self.data.get("combine", "grid")
        if combine not in ("grid", "list"):
            self._check.faults.append(f"combine = {shown_value(combine)}: must be one of: grid, list")
        vary, tables = self.data.get("vary"), self.data.get("point")
        if (vary is None) == (tables is None):
            both = "both given; give one of them" if vary is not None else "missing; give one of them"
            self._check.faults.append(f"[vary] or [[point]]: {both}")
            return {}, True
        if tables is not None:
            if "combine" in self.data:
                self._check.faults.append("combine: not used with [[point]]; leave it out")
            return self._columns_of_points(tables, base), False
        columns = {}
        leaves = flattened(self._check.table("vary", vary, self._own_keys("vary")))
        if not leaves:
            self._check.faults.append("vary: empty; give at least one key of the case file with its values")
        for key, given in leaves.items():
            values = spread(given)
            fault = key_fault(base, key) or (values if isinstance(values, str) else None)
            fault = "in [set] as well; give it once" if key in self._set else fault
            if fault is not None:
                self._check.faults.append(f"vary.{key}: {fault}")
            elif not isinstance(values, str):
                columns[key] = values
        self._count(columns, combine == "grid")
        return columns, combine == "grid"

    def _count(self, columns: Mapping[str, tuple[Any, ...]], grid: bool) -> None:
        lengths = {key: len(values) for key, values in columns.items()}
        if grid and math.prod(lengths.values()) > MOST_POINTS:
            product = " x ".join(map(str, lengths.values()))
            self._check.faults.append(f"vary: {product} points; must be at most {MOST_POINTS}")
        elif not grid and len(set(lengths.values())) > 1:
            counts = in_words(f"{key} has {count}" for key, count in lengths.items())
            self._check.faults.append(f"vary: with combine = list all keys need the same number of values: {counts}")

    def _columns_of_points(self, tables: Any, base: Mapping[str, Any]) -> dict[str, tuple[Any, ...]]:
        if not isinstance(tables, list) or not tables or not all(isinstance(table, Mapping) for table in tables):
            self._check.faults.append("point: must be an array of tables; write [[point]]")
            return {}
        rows = [flattened(table) for table in tables]
        keys = tuple(dict.fromkeys(key for row in rows for key in row))
        if not keys:
            self._check.faults.append("point: empty; give at least one key of the case file")
        for key in keys:
            fault = "in [set] as well; give it once" if key in self._set else key_fault(base, key)
            if fault is not None:
                self._check.faults.append(f"point.{key}: {fault}")
            for number, row in enumerate(rows, 1):
                if key not in row:
                    self._check.faults.append(f"point #{number}.{key}: missing; all points give the same keys")
                elif isinstance(row[key], Mapping):
                    self._check.faults.append(f"point #{number}.{key}: must be one value, not a range or table")
        seen: dict[str, int] = {}
        for number, row in enumerate(rows, 1):
            text = shown_full([[key, row.get(key)] for key in keys])
            if seen.setdefault(text, number) != number:
                self._check.faults.append(f"point #{number}: is the same as point #{seen[text]}")
        return {key: tuple(row.get(key) for row in rows) for key in keys}

    def _points(
        self,
        base: dict[str, Any],
        path: Path,
        keys: tuple[str, ...],
        rows: list[tuple[Any, ...]],
        seed: int | None,
        results: ResultSettings,
    ) -> list[Point]:
        points: list[Point] = []
        found: dict[str, list[str]] = {}  # places by fault: many points share theirs
        for index, values in enumerate(rows):
            data = with_values(base, keys, values)
            if seed is not None:
                per_point_seeds(data, seed=seed, index=index)
            label = label_of(keys, values)
            try:
                # Absolute: workers may run in another folder.
                case = case_from_dict(data, source=str(path), folder=path.parent.absolute())
            except CaseError as error:
                for fault in error.faults:
                    found.setdefault(fault, []).append(label)
                continue
            for fault in result_faults(case, results):
                found.setdefault(fault, []).append(label)
            points.append(Point(index, label, case))
        for fault, places in found.items():
            others = len(places) - 1
            also = "" if not others else f" (and at {others} other point{'s' if others > 1 else ''})"
            self._check.faults.append(f"at {places[0]}{also}: {fault}")
        return points
