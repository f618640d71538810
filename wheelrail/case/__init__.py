"""The case file: one TOML file that describes a run or an FMU.

Read one with :func:`load_case`; every fault of a file comes in one
:class:`~wheelrail.errors.CaseError`. The keys, their units and ranges are in :mod:`wheelrail.case.sections`,
:mod:`wheelrail.case.wheel_sections`, :mod:`wheelrail.case.track_sections` and :mod:`wheelrail.case.excitations`, and in
:func:`json_schema`.
"""

from wheelrail.case.definition import Case
from wheelrail.case.reading import case_from_dict, default_case_text, load_case, parse_case
from wheelrail.case.schema import json_schema

__all__ = ["Case", "case_from_dict", "default_case_text", "json_schema", "load_case", "parse_case"]
