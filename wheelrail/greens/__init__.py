"""Green's functions of wheel and track, discretised in time."""
