"""The table ``[results]`` of a study file, and whether the case of a point can give what it asks for."""

from __future__ import annotations

import math
from typing import Any

from wheelrail.case import Case
from wheelrail.case.faults import did_you_mean, in_words, shown_value
from wheelrail.results.layout import OUTPUTS
from wheelrail.study.checking import TableCheck
from wheelrail.study.measures import STATISTICS, ResultSettings, ThirdOctaveSettings, is_statistic

__all__ = ["ResultsTable", "result_faults"]

_RESULT_KEYS = ("from", "outputs", "statistics", "histories", "third_octave", "squeal")
_BAND_KEYS = ("outputs", "lowest", "highest")


class ResultsTable:
    """Reads the table.

    Parameters
    ----------
    given : object
        What the study file has there.
    case : Case
        The case that the study starts from; what it records is the default.
    check : TableCheck
        Takes the faults.
    """

    def __init__(self, given: Any, case: Case, check: TableCheck) -> None:
        self._given, self._case, self._check = given, case, check

    def settings(self) -> ResultSettings:
        """Read the table."""
        table = self._check.table("results", self._given, _RESULT_KEYS)
        settle = table.get("from", 0.0)
        if isinstance(settle, bool) or not isinstance(settle, int | float) or not 0.0 <= settle < math.inf:
            self._check.faults.append(f"results.from = {shown_value(settle)}: must be a finite number >= 0 (s)")
            settle = 0.0
        squeal = table.get("squeal", False)
        if not isinstance(squeal, bool):
            self._check.faults.append(f"results.squeal = {shown_value(squeal)}: must be true or false")
        return ResultSettings(
            settle=float(settle),
            outputs=self._names("results.outputs", table.get("outputs", list(self._case.output.record))),
            statistics=self._statistics(table.get("statistics", ["mean", "std", "min", "max"])),
            histories=self._names("results.histories", table.get("histories", [])),
            third_octave=self._bands(table["third_octave"]) if "third_octave" in table else None,
            squeal=squeal is True,
        )

    def _names(self, key: str, given: Any) -> tuple[str, ...]:
        if not isinstance(given, list):
            self._check.faults.append(f"{key} = {shown_value(given)}: must be a list of outputs")
            return ()
        for name in given:
            if not isinstance(name, str) or name not in OUTPUTS:
                hint = did_you_mean(name, OUTPUTS) if isinstance(name, str) else ""
                self._check.faults.append(f"{key}: {shown_value(name)}: {hint}must be one of: {in_words(OUTPUTS)}")
        return tuple(dict.fromkeys(name for name in given if isinstance(name, str)))

    def _statistics(self, given: Any) -> tuple[str, ...]:
        names = given if isinstance(given, list) else [given]
        for name in names:
            if not is_statistic(name):
                self._check.faults.append(
                    f"results.statistics: {shown_value(name)}: must be one of: {in_words(STATISTICS)}, or a "
                    "percentile such as p95"
                )
        if not names:
            self._check.faults.append("results.statistics: empty; give at least one, or outputs = []")
        return tuple(dict.fromkeys(name for name in names if isinstance(name, str)))

    def _bands(self, given: Any) -> ThirdOctaveSettings | None:
        key = "results.third_octave"
        table = self._check.table(key, given, _BAND_KEYS)
        missing = [name for name in _BAND_KEYS if name not in table]
        if missing:
            self._check.faults.append(f"{key}: {in_words(missing)} missing; give outputs, lowest and highest (Hz)")
            return None
        limits = table["lowest"], table["highest"]
        numbers = all(isinstance(limit, int | float) and not isinstance(limit, bool) for limit in limits)
        if not numbers or not 0.0 < limits[0] < limits[1] < math.inf:
            self._check.faults.append(f"{key}: lowest and highest must be finite numbers (Hz), 0 < lowest < highest")
            return None
        settings = ThirdOctaveSettings(self._names(f"{key}.outputs", table["outputs"]), *map(float, limits))
        if not len(settings.centres):
            self._check.faults.append(f"{key}: no whole band lies between {limits[0]:g} Hz and {limits[1]:g} Hz")
        return settings


def result_faults(case: Case, results: ResultSettings) -> list[str]:
    """Find what a case can't give."""
    faults = []
    simulation = case.simulation
    steps = (simulation.duration - results.settle) * simulation.speed / simulation.dx
    # Statistics of one sample are no statistics; spectra take 16.
    least = 16 if results.third_octave is not None or results.squeal else 2
    if steps < least:
        faults.append(
            f"results.from = {results.settle:g}: leaves less than {least} steps of the {simulation.duration:g} s of "
            "simulation.duration"
        )
    if results.squeal and case.contact.tangential == "none":
        faults.append('results.squeal = true: needs a tangential contact model, but contact.tangential = "none"')
    return faults
