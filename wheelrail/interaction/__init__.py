"""The coupled system: model, state and the time step."""
