"""Modal damping of a flexible wheel, by the names of its modes."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Mapping

__all__ = ["OTHERS", "THESIS", "damping_ratios", "thesis_damping_ratio"]

THESIS = "thesis"
OTHERS = "others"


def thesis_damping_ratio(name: str) -> float:
    """Damping ratio of a wheel without damping treatment (Pieringer 2011, eq. 3.9, after Thompson 1993).

    1e-3 for n = 0, 1e-2 for n = 1, 1e-4 above, and 1 for the mode (1,r), which the wheel without its axle shows too
    strongly.
    """
    name = name.removesuffix("*")
    if name == "1,r":
        return 1.0
    return {"0": 1e-3, "1": 1e-2}.get(name.split(",")[0], 1e-4)


def damping_ratios(names: Iterable[str], damping: float | str | Mapping[str, float | str]) -> dict[str, float]:
    """Damping ratio of each mode.

    Parameters
    ----------
    names : iterable of str
        Names of the modes, partners marked by an asterisk included.
    damping : float, "thesis" or mapping
        One ratio for all; the values of `thesis_damping_ratio`; or a table of ratios by name. In a table "7,0,a" stands
        for both partners, unless "7,0,a*" is there too, and "others" (a ratio or "thesis") for every mode that isn't.

    Returns
    -------
    dict of str to float

    Raises
    ------
    ValueError
        For a name that no mode has, modes without a value, and ratios that are negative or not finite.
    """
    names = tuple(names)
    if not isinstance(damping, Mapping):
        damping = {OTHERS: damping}
    table = {key.replace(" ", "").strip("()"): value for key, value in damping.items()}
    known = {*names, *(name.removesuffix("*") for name in names), OTHERS}
    for key in table:
        if key not in known:
            nearest = ", ".join(difflib.get_close_matches(key, sorted(known), n=3, cutoff=0.0))
            raise ValueError(f'damping: the wheel has no mode "{key}"; nearest names: {nearest}')
    ratios, missing = {}, []
    for name in names:
        value = table.get(name, table.get(name.removesuffix("*"), table.get(OTHERS)))
        if value is None:
            missing.append(name)
            continue
        ratios[name] = thesis_damping_ratio(name) if value == THESIS else _ratio(name, value)
    if missing:
        raise ValueError(
            f'damping: no value for {", ".join(missing)}; "{OTHERS}" gives one for all that aren\'t listed'
        )
    return ratios


def _ratio(name: str, value: float | str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < 0.0:
        raise ValueError(f'damping of mode {name} = {value!r} is refused: a number of at least 0, or "{THESIS}"')
    return float(value)
