"""The reference result that an FMU carries: the default experiment, run without an FMU.

Layout after the layered standard for references (fmi-ls-ref, version 1.0.0-alpha.1) as modelica/Reference-FMUs uses it.
"""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

from .variables import VARIABLES

__all__ = ["FOLDER", "RESULT_FILE", "reference_files"]

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
RESULT_FILE = "WheelRail_out.csv"

_MANIFEST = "http://fmi-standard.org/fmi-ls-manifest"


def reference_files(simulation: Any, *, stop_time: float, step_size: float, duration: float) -> dict[str, bytes]:
    """Run the default experiment from its start and return the files of the reference result.

    Parameters
    ----------
    simulation : CoSimulation
        As made, with the start values of the model description.
    stop_time, step_size : float
        Default experiment (s).
    duration : float
        How much of it to run at most (s).

    Returns
    -------
    dict of str to bytes
        Name in the FMU and content; the CSV has the time and every output, one row per communication point.
    """
    names = [variable.name for variable in VARIABLES if variable.role == "output"]
    steps = round(min(stop_time, duration) / step_size)
    rows = [",".join(["time", *names])]
    simulation.initialise()
    for step in range(steps + 1):
        if step:
            simulation.advance(step_size)
        values = [simulation.output(name) for name in names]
        rows.append(",".join([repr(step * step_size), *(_text(value) for value in values)]))
    end = steps * step_size
    whole = "" if end > stop_time - step_size else f", first {end:g} s"
    root = ElementTree.Element(
        "fmiReferences",
        {
            f"{{{_MANIFEST}}}fmi-ls-name": "org.fmi-standard.fmi-ls-ref",
            f"{{{_MANIFEST}}}fmi-ls-version": "1.0.0-alpha.1",
            f"{{{_MANIFEST}}}fmi-ls-description": "Layered Standard providing information on related files included in "
            "an FMU.",
        },
    )
    ElementTree.register_namespace("fmi-ls", _MANIFEST)
    ElementTree.SubElement(
        root,
        "Related",
        {
            "type": "text/csv",
            "source": RESULT_FILE,
            "role": "result",
            "description": f"Output of the default experiment{whole}",
        },
    )
    ElementTree.indent(root, "  ")
    return {
        f"{FOLDER}/fmi-ls-manifest.xml": ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n",
        f"{FOLDER}/{RESULT_FILE}": ("\n".join(rows) + "\n").encode(),
    }


def _text(value: float | int | bool) -> str:
    if isinstance(value, float):
        return repr(float(value))
    return str(int(value))
