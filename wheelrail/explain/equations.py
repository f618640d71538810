"""The equations of a case, and the publications they come from."""

from __future__ import annotations

from wheelrail.case import Case
from wheelrail.interaction.tracks import TrackModel
from wheelrail.interaction.wheels import WheelModel

__all__ = ["explain_equations", "explain_sources"]


def explain_equations(case: Case, wheel: WheelModel | None, track: TrackModel | None) -> list[str]:
    """Return the equations of a case and where they are printed."""
    coupled = case.load.coupling == "load"
    lines = [
        "In each step a, with F the contact force on the rail (compression > 0), P the load on the wheel, d the "
        "approach, r the combined roughness (asperities on wheel or rail > 0):"
    ]
    if coupled and wheel is None:
        lines += [_equation("F(a) = P", "the wheel has no dynamics")]
    elif coupled:
        lines += [_equation("d(a) = d0 + xi_W(a) - xi_R(a)", "d0 from equilibrium at the start")]
    else:
        own = " + xi_W(a)" if wheel is not None else ""
        lines += [_equation(f"d(a) = wheel_z(a){own} - xi_R(a)", "the vehicle moves the wheel")]
    if wheel is not None:
        pushed = "[F - P]" if coupled else "F"
        lines += [_equation(f"xi_W(a) = - sum_n g_W(n) {pushed}(a - n + 1)", "Pieringer 2011, eqs. 3.5 to 3.8")]
    if track is not None:
        lines += [_equation("xi_R(a) = sum_n g_R^{v,(a-n)dx}(n) F(a - n + 1)", "Pieringer 2011, eqs. 3.11 to 3.17")]
    else:
        lines += [_equation("xi_R(a) = 0", "rigid track")]
    if case.contact.normal == "winkler":
        lines += [_equation("F = k' integral max(0, d + r(x) - x^2 / (2 R')) dx", "Pieringer 2011, eqs. 3.23 to 3.30")]
    elif case.contact.normal == "half-space":
        lines += [
            _equation("h - d + A33 p >= 0, p >= 0, their product 0", "Pieringer 2011, eqs. 3.33 to 3.42 (NORM)"),
            "    with h = x^2 / (2 R_w) + y^2 / (2 R_y) - r(x), F the sum of p over the elements",
        ]
    else:
        filters = {
            "none": "r at the nominal contact point",
            "average": "r averaged over the nominal contact length",
            "winkler": "r as a Winkler bedding under the preload feels it",
        }
        lines += [
            _equation("F = C_H max(0, d + r)^1.5", "Pieringer 2011, eq. 2.19"),
            f"    with {filters[case.contact.prefilter]}",
        ]
    lines += _tangential_equations(case)
    if case.contact.tangential != "none" and _moves_sideways(case):
        lines += _structural_equations(case)
    if case.contact.normal == "half-space":
        return [*lines, "d(a) and p are solved together in Kalker's active set iteration."]
    return [*lines, "The equation for d(a) is solved by Newton's method with a safeguard."]


def _tangential_equations(case: Case) -> list[str]:
    match case.contact.tangential:
        case "none":
            return ["Vertical direction only."]
        case "linear":
            return [_equation("F1 = -G a b C11 xi, F2, M3 alike", "Kalker's linear theory, no friction limit")]
        case "fastsim":
            return [_equation("u = L p along strips, |p| <= mu p3", "FASTSIM, Kalker 1982")]
        case "friction-curve":
            return [
                _equation("F_t = -mu(s) F f(r) w / |w|, w = (c_x e_x, c_y e_y + c_s phi)", "point contact"),
                "    with f of Vermeulen and Johnson 1964, r = |w| / (mu F), s = v |e|, Kalker's slopes c",
                _equation("e = xi + [D + C (F_t - F_t(a - 1))] / dx", "contact spring C (Mindlin 1949)"),
                *_friction_equations(case),
            ]
    return [
        _equation("S = A p + W - u'(a - 1), W = (xi - y phi, eta + x phi) dx", "Pieringer 2011, eqs. 3.43 to 3.54"),
        "    with S = 0 where |p| < mu p3, else p against S; u' carries the tractions of the step before",
        "    creepages xi, eta, phi: rail relative to wheel over v, so positive ones give negative forces on the rail",
        *_friction_equations(case),
    ]


def _friction_equations(case: Case) -> list[str]:
    friction = case.friction
    if friction is None or friction.law == "constant":
        return []
    source = "Pieringer 2011, eqs. 3.56 to 3.58" if friction.law == "kraft" else "Pieringer 2011, section 3.6.2"
    lines = [_equation("mu = mu_law(s), s = |S| / dt, for each element", source)]
    if case.contact.tangential == "friction-curve":
        lines = [_equation("mu = mu_law(s)", f"friction.law = {friction.law}")]
    if friction.memory_distance > 0.0:
        whose = "the particle" if case.contact.tangential == "transient" else "the contact"
        lines.append(_equation("d mu / dt = -max(s, s0) / d_c (mu - mu_law(s))", f"of {whose}; Vollebregt 2014"))
    return lines


def _moves_sideways(case: Case) -> bool:
    return case.wheel.model == "flexible" or case.track.model == "waveguide"


def _structural_equations(case: Case) -> list[str]:
    lines = [
        "xi_W, xi_R and F have three directions with all cross terms; a rigid wheel or a beam stands still sideways."
    ]
    if case.contact.tangential == "transient":
        lines.append(
            _equation("W += [xi_R - xi_W](a) - [xi_R - xi_W](a - 1)", "Pieringer 2011, eqs. 3.50 and 3.51; x, y")
        )
    else:
        lines.append("    the creep-force law takes the vehicle's creepages alone: vibration does not act back on it")
    if case.simulation.first_sample == "zero":
        lines.append("First samples are 0: all displacements are known before the contact is solved (eqs. 3.8, 3.17).")
    else:
        lines.append("First samples that couple the vertical with x, y are 0; the others are solved with the contact.")
    if case.load.coupling == "load":
        lines.append(
            "P in x, y: wheel_force_x, wheel_force_y; with balance what the contact's steady force at the start adds."
        )
    else:
        lines.append("The rigid wheel's lateral motion is in the vehicle's creepage, not in xi_W.")
    return lines


def _equation(text: str, remark: str) -> str:
    return f"    {text:<56}  {remark}"


def explain_sources(case: Case, track: TrackModel | None) -> list[str]:
    """Return the publications behind a case."""
    lines = [
        "Pieringer 2011, Time-domain modelling of high-frequency wheel/rail interaction, PhD thesis, Chalmers "
        "(equation numbers above)",
        "Johnson 1985, Contact mechanics, section 4.2 (Hertz contact)",
    ]
    if case.contact.normal == "half-space" or case.contact.tangential != "none":
        lines.append(
            "Kalker 1990, Three-dimensional elastic bodies in rolling contact (NORM, TANG, creepage coefficients)"
        )
    slips = case.contact.tangential in ("transient", "friction-curve")
    if case.friction is not None and case.friction.law != "constant" and slips:
        lines.append(
            "Vollebregt and Schuttelaars 2012, J. Sound Vib. 331 (several solutions with slip-velocity dependent "
            "friction)"
        )
        if case.friction.memory_distance > 0.0:
            lines.append(
                "Vollebregt 2014, Wear 314 (friction memory); Rice and Ruina 1983, J. Appl. Mech. 50 (stability)"
            )
    if track is not None:
        lines.append(
            "Nordborg 2002, Wheel/rail noise generation due to nonlinear effects and parametric excitation, "
            "J. Acoust. Soc. Am. 111 (moving Green's functions)"
        )
    if case.contact.prefilter == "winkler":
        lines.append(
            "Ford and Thompson 2006, Simplified contact filters in wheel/rail noise prediction, J. Sound Vib. 293 "
            "(equivalent roughness)"
        )
    return lines
