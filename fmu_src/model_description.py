"""``modelDescription.xml`` of FMI 2.0, written from the variable table.

PythonFMU's own writer leaves out units, types, ranges, dependencies and initial unknowns, and makes a new GUID at
every build; none of it is used.
"""

from __future__ import annotations

import datetime
import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

from .variables import ENUMERATIONS, UNITS, VARIABLES, Variable

__all__ = ["MODEL_IDENTIFIER", "Description", "guid", "model_description"]

MODEL_IDENTIFIER = "WheelRail"

LOG_CATEGORIES = {
    "logStatusWarning": "Warnings: a solver that did not converge, and the like",
    "logStatusDiscard": "Steps that were not done",
    "logStatusError": "Refused values and failed calls, with what is allowed",
    "logStatusFatal": "What the Python wrapper reports about a failed call",
    "logAll": "All messages",
}

_WITHOUT_EFFECT_AT_START = frozenset({"input_extrapolation", "record"})


@dataclass(frozen=True)
class Description:
    """What the model description says beside the variable table.

    Attributes
    ----------
    start : mapping of str to object
        Start value of every input, parameter and constant, by name; enumerations by item name.
    guid : str
        Identity of interface and content, without braces.
    stop_time, step_size : float
        Default experiment (s).
    version : str
        Version of the package.
    title : str
        Title of the case.
    """

    start: Mapping[str, Any]
    guid: str
    stop_time: float
    step_size: float
    version: str
    title: str


def guid(*parts: bytes) -> str:
    """Return an identity that is the same for the same content: a hash in the form of a UUID."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(len(part).to_bytes(8, "little") + part)
    text = digest.hexdigest()
    return "-".join((text[:8], text[8:12], text[12:16], text[16:20], text[20:32]))


def model_description(description: Description) -> bytes:
    """Return the model description.

    The generation date is written only where ``SOURCE_DATE_EPOCH`` gives one, so that two builds of the same content
    have the same bytes.
    """
    root = ElementTree.Element(
        "fmiModelDescription",
        {
            "fmiVersion": "2.0",
            "modelName": MODEL_IDENTIFIER,
            "guid": description.guid,
            "description": f"High-frequency wheel/rail interaction in the time domain: {description.title}",
            "author": "The wheelrail authors",
            "version": description.version,
            "copyright": "The wheelrail authors",
            "license": "Apache-2.0; the binaries are PythonFMU's, MIT. See documentation/licenses.",
            "generationTool": f"wheelrail {description.version}",
            **_generation_date(),
            "variableNamingConvention": "structured",
            "numberOfEventIndicators": "0",
        },
    )
    ElementTree.SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": MODEL_IDENTIFIER,
            "needsExecutionTool": "false",
            "canHandleVariableCommunicationStepSize": "true",
            "canInterpolateInputs": "false",
            "canRunAsynchronuously": "false",  # sic, in the FMI 2.0 schema
            "canBeInstantiatedOnlyOncePerProcess": "false",
            "canNotUseMemoryManagementFunctions": "true",
            "canGetAndSetFMUstate": "true",
            "canSerializeFMUstate": "true",
            "providesDirectionalDerivative": "false",
        },
    )
    _add_units(root)
    _add_types(root)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", {"name": name, "description": text})
    ElementTree.SubElement(
        root,
        "DefaultExperiment",
        {"startTime": "0", "stopTime": repr(description.stop_time), "stepSize": repr(description.step_size)},
    )
    variables = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(VARIABLES):
        _add_variable(variables, reference, variable, description.start.get(variable.name))
    _add_structure(root)
    ElementTree.indent(root, "  ")
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def _generation_date() -> dict[str, str]:
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not epoch.isdigit():
        return {}
    moment = datetime.datetime.fromtimestamp(int(epoch), tz=datetime.UTC)
    return {"generationDateAndTime": moment.strftime("%Y-%m-%dT%H:%M:%SZ")}


def _add_units(root: ElementTree.Element) -> None:
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        unit = ElementTree.SubElement(definitions, "Unit", {"name": name})
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})


def _add_types(root: ElementTree.Element) -> None:
    definitions = ElementTree.SubElement(root, "TypeDefinitions")
    for enumeration in ENUMERATIONS.values():
        simple = ElementTree.SubElement(definitions, "SimpleType", {"name": enumeration.name})
        items = ElementTree.SubElement(simple, "Enumeration")
        for value, (item, text) in enumerate(enumeration.items, 1):
            ElementTree.SubElement(items, "Item", {"name": item, "value": str(value), "description": text})


def _add_variable(parent: ElementTree.Element, reference: int, variable: Variable, start: Any) -> None:
    attributes = {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.description,
        "causality": variable.causality,
        "variability": variable.variability,
    }
    if variable.initial:
        attributes["initial"] = variable.initial
    scalar = ElementTree.SubElement(parent, "ScalarVariable", attributes)
    details: dict[str, str] = {}
    if variable.enumeration:
        details["declaredType"] = variable.enumeration
    for key, text in (("quantity", variable.quantity), ("unit", variable.unit)):
        if text:
            details[key] = text
    for key, number in (("min", variable.minimum), ("max", variable.maximum), ("nominal", variable.nominal)):
        if number is not None:
            details[key] = _text(variable, number)
    if start is not None:
        details["start"] = _text(variable, start)
    ElementTree.SubElement(scalar, variable.kind, details)


def _text(variable: Variable, value: Any) -> str:
    if variable.enumeration:
        return str(ENUMERATIONS[variable.enumeration].value(value))
    if variable.kind == "Real":
        return repr(float(value))
    if variable.kind == "Integer":
        return str(int(value))
    if variable.kind == "Boolean":
        return "true" if value else "false"
    return str(value)


def _add_structure(root: ElementTree.Element) -> None:
    """Write which output depends on what.

    After initialisation an output depends on the inputs only through the steps done before: no direct dependency, so
    that no tool sees an algebraic loop. At initialisation it follows from the equilibrium for the start inputs.
    """
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs = [index for index, variable in enumerate(VARIABLES, 1) if variable.role == "output"]
    known = [
        str(index)
        for index, variable in enumerate(VARIABLES, 1)
        if variable.role in ("input", "parameter") and variable.name not in _WITHOUT_EFFECT_AT_START
    ]
    node = ElementTree.SubElement(structure, "Outputs")
    for index in outputs:
        ElementTree.SubElement(node, "Unknown", {"index": str(index), "dependencies": ""})
    node = ElementTree.SubElement(structure, "InitialUnknowns")
    speed = next(str(index) for index, variable in enumerate(VARIABLES, 1) if variable.name == "speed")
    for index, variable in enumerate(VARIABLES, 1):
        if variable.role == "output":
            ElementTree.SubElement(node, "Unknown", {"index": str(index), "dependencies": " ".join(known)})
        elif variable.role == "calculated":
            ElementTree.SubElement(node, "Unknown", {"index": str(index), "dependencies": speed})
