"""Faults of the default case with some keys changed."""

import tomllib

import pytest

from wheelrail.case import case_from_dict, default_case_text
from wheelrail.errors import CaseError


def base():
    return tomllib.loads(default_case_text())


def faults_of(data, **keywords):
    with pytest.raises(CaseError) as caught:
        case_from_dict(data, **keywords)
    return list(caught.value.faults)


def changed(changes):
    """Return the default case with ``section.key`` set, or removed for None; ``section`` alone sets a table."""
    data = base()
    for place, value in changes.items():
        *sections, key = place.split(".")
        table = data
        for section in sections:
            table = table[int(section)] if isinstance(table, list) else table.setdefault(section, {})
        if value is None:
            del table[key]
        else:
            table[key] = value
    return data
