"""What a result file holds: its format, and the variables with units and names."""

from __future__ import annotations

__all__ = ["FORMAT", "OUTPUTS", "STATE", "TYPES"]

FORMAT = 1
"""Of the file; files of another format are not read."""

STATE = "final_state"
"""Variable that holds the state after the last step, from which a run continues."""

OUTPUTS: dict[str, tuple[str, str]] = {
    "force_x": ("N", "longitudinal contact force on the rail"),
    "force_y": ("N", "lateral contact force on the rail"),
    "force_z": ("N", "vertical contact force on the rail, positive in compression"),
    "force_x_mean": ("N", "longitudinal contact force on the rail, mean over the step"),
    "force_y_mean": ("N", "lateral contact force on the rail, mean over the step"),
    "force_z_mean": ("N", "vertical contact force on the rail, mean over the step"),
    "force_z_max": ("N", "vertical contact force on the rail, largest within the step"),
    "force_z_min": ("N", "vertical contact force on the rail, smallest within the step"),
    "moment_spin": ("N m", "spin moment on the rail"),
    "wheel_disp_x": ("m", "longitudinal displacement of the wheel at the contact"),
    "wheel_disp_y": ("m", "lateral displacement of the wheel at the contact"),
    "wheel_disp_z": ("m", "vertical displacement of the wheel at the contact, positive into the rail"),
    "rail_disp_x": ("m", "longitudinal displacement of the rail at the contact"),
    "rail_disp_y": ("m", "lateral displacement of the rail at the contact"),
    "rail_disp_z": ("m", "vertical displacement of the rail at the contact, positive downwards"),
    "contact_stiffness_z": ("N m-1", "tangent stiffness of the contact, vertical force over approach"),
    "contact_area": ("m2", "area in contact"),
    "contact_length": ("m", "length of the contact in rolling direction"),
    "contact_width": ("m", "width of the contact across the rail"),
    "pressure_max": ("Pa", "largest contact pressure"),
    "slip_fraction": ("1", "slipping share of the contact area"),
    "friction_power": ("W", "frictional power"),
    "approach": (
        "m",
        "rigid approach of wheel and rail at the nominal contact point, from first touch at the case's lateral shift",
    ),
    "in_contact": ("1", "1 while wheel and rail touch, 0 else"),
    "distance": ("m", "rolled distance since the start"),
    "solver_iterations": ("1", "evaluations of the contact law"),
    "solver_residual": ("1", "relative residual of the contact solution"),
    "friction_method": ("1", "what found the friction: 0 given, 1 Newton, 2 Broyden, 3 direct iteration"),
    "friction_solutions": ("1", "solutions of the step that were found, 0 if not looked for"),
    "friction_force_spread": ("N", "largest difference of their tangential forces"),
    "contact_y_wheel": ("m", "lateral position of the contact on the wheel from the tape circle"),
    "contact_y_rail": ("m", "lateral position of the contact on the rail from its axis"),
    "contact_angle": ("rad", "contact angle"),
    "rolling_radius": ("m", "radius of the wheel at the contact"),
    "contact_points": ("1", "places where the undeformed bodies overlap"),
    "missed_overlap": ("m", "overlap at a place outside of the potential contact area"),
}
"""Unit (as UDUNITS writes it) and long name of every output that can be recorded."""

TYPES = {
    "in_contact": "i1",
    "solver_iterations": "i4",
    "friction_method": "i1",
    "friction_solutions": "i2",
    "contact_points": "i2",
}
"""netCDF types of the outputs that are no floating-point numbers."""
