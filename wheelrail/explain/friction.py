"""The friction law of a case: values, memory, and the memory that keeps sliding steady."""

from __future__ import annotations

import numpy as np

from wheelrail.case import Case
from wheelrail.case.friction_sections import ConstantFriction
from wheelrail.contact.creep.contact_spring import tangential_compliance
from wheelrail.contact.friction.laws import steepest_fall
from wheelrail.contact.hertz import HertzContact
from wheelrail.interaction.friction import law_of, slip_friction_of, static_friction_of

__all__ = ["critical_memory_distance", "explain_friction"]

_SHOWN = (0.0, 0.01, 0.1, 1.0)  # slip velocities, m/s
_HIGHEST = 10.0  # m/s, beyond the slip of any squeal


def critical_memory_distance(case: Case, hertz: HertzContact) -> float:
    """Return the memory distance in m above which sliding at any slip velocity up to 10 m/s is steady.

    Of a contact by itself, under the preload; see `wheelrail.contact.friction.laws.steepest_fall`.
    """
    contact = case.contact
    compliance = max(
        tangential_compliance(
            semi_axis_x=hertz.semi_axis_x,
            semi_axis_y=hertz.semi_axis_y,
            shear_modulus=contact.youngs_modulus / (2.0 * (1.0 + contact.poisson_ratio)),
            poisson_ratio=contact.poisson_ratio,
        )
    )
    fall = static_friction_of(case) * steepest_fall(law_of(case), highest_speed=_HIGHEST)
    return compliance * hertz.load * fall


def explain_friction(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    """Return the lines on friction; add to ``warnings`` if a falling law wants a memory."""
    friction, contact = case.friction, case.contact
    if friction is None or contact.tangential in ("none", "linear"):
        return []
    law, static = law_of(case), static_friction_of(case)
    if isinstance(friction, ConstantFriction):
        return [f"law                       constant, mu = {static:g}"]
    ratios, _ = law.evaluate(np.array(_SHOWN))
    values = ", ".join(f"{static * ratio:.3g} at {speed:g}" for speed, ratio in zip(_SHOWN, ratios, strict=True))
    printed = ""
    if friction.law == "kraft":
        printed = ", divided by 0.7" if friction.normalise else " as printed (at rest 0.7 of the coefficient)"
    lines = [f"law                       {friction.law}{printed}; mu = {values} m/s"]
    sliding = 0.0
    if case.creepage is not None:
        sliding = case.simulation.speed * float(np.hypot(case.creepage.x, case.creepage.y))
        ratio, slope = law.evaluate(np.array([sliding]))
        lines.append(
            f"at the case's creepage    {sliding:.3g} m/s if all of it slides: mu = {static * ratio[0]:.3g}, slope "
            f"{static * slope[0]:.3g} s/m"
        )
    critical = critical_memory_distance(case, hertz)
    memory = "none" if friction.memory_distance == 0.0 else f"{friction.memory_distance * 1e6:g} um"
    lines.append(f"memory                    {memory}" + _recovery(case))
    if critical > 0.0:
        lines.append(
            f"memory for steady sliding {critical * 1e6:.2g} um or more keeps the contact by itself steady at all slip "
            "velocities up to 10 m/s (Rice and Ruina 1983)"
        )
    settings = slip_friction_of(case)
    if contact.tangential == "transient" and settings is not None:
        ways = {
            "newton": "Newton's method for tractions and coefficients together",
            "broyden": "contact and law in turn (Broyden's method, relaxed direct iteration)",
        }
        starts = {"previous": "the slip of the step before", "low-slip": "full stick", "high-slip": "full slip"}
        lines.append(f"solution                  {ways[settings.solver]}, from {starts[settings.branch]}")
        if settings.find_solutions:
            lines.append(
                "all solutions             looked for at every step: ports friction_solutions, ..._force_spread"
            )
    if critical > 0.0 and friction.memory_distance == 0.0:
        warnings.append(
            "friction falls with the slip velocity and has no memory: the contact may swing from step to step, and "
            "results depend on the grid (Pieringer 2011, section 5.3.2); friction.memory_distance = "
            f"{_rounded_up(critical):.2g} (m) with memory_speed = 1e-3 cures that"
        )
    elif 0.0 < friction.memory_distance < critical:
        warnings.append(
            f"friction.memory_distance is below {critical * 1e6:.2g} um: at some slip velocities the contact may swing "
            "by itself, with results that depend on the grid"
        )
    return lines


def _recovery(case: Case) -> str:
    friction = case.friction
    if friction is None or friction.memory_distance == 0.0 or friction.memory_speed is None:
        return "; the coefficient is that of the present slip velocity"
    seconds = friction.memory_distance / friction.memory_speed
    return f"; at rest the coefficient recovers with {friction.memory_speed * 1e3:g} mm/s, in {seconds * 1e3:.3g} ms"


def _rounded_up(value: float) -> float:
    """Next value with one digit."""
    step = 10.0 ** np.floor(np.log10(value))
    return float(np.ceil(value / step) * step)
