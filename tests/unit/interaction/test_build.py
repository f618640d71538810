import numpy as np
import pytest

from wheelrail.case import parse_case
from wheelrail.errors import CaseError
from wheelrail.greens.ordinary import discretise
from wheelrail.interaction.build import build_model, hertz_of, track_of, wheel_of

TEXT = """
[simulation]
speed = 30.0
dx = 1e-3
duration = 0.1
start_position = 0.002
[wheel]
preset = "thesis-2dof"
[track]
model = "rigid"
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 210e9
poisson_ratio = 0.3
[load]
preload = 65e3
coupling = "load"
"""


def test_the_case_reaches_the_model():
    case = parse_case(TEXT)
    model = build_model(case)
    assert model.contact.constant == pytest.approx(9.41e10, abs=0, rel=5e-4)  # Pieringer 2011, section 2.2
    assert model.start_inputs.wheel_force_z == 65e3
    assert model.dt == pytest.approx(1e-3 / 30)
    assert model.start_index == 2
    wheel = wheel_of(case)
    np.testing.assert_array_equal(model.wheel.values(50), discretise(*wheel.state_space(), dt=model.dt).values(50))
    np.testing.assert_array_equal(
        model.held_wheel.values(50), discretise(*wheel.held().state_space(), dt=model.dt).values(50)
    )
    assert parse_case(model.case).to_dict() == case.to_dict()


def test_track_of_the_preset(thesis_track):
    case = parse_case(TEXT.replace('model = "rigid"', 'preset = "thesis-discrete"'))
    assert track_of(case) == thesis_track()
    assert track_of(parse_case(TEXT)) is None


def test_transverse_radius_of_the_wheel_counts():
    straight = hertz_of(parse_case(TEXT))
    convex = hertz_of(
        parse_case(TEXT.replace("rail_radius = 0.30", "rail_radius = 0.60\nwheel_transverse_radius = 0.60"))
    )
    assert convex.approach == pytest.approx(straight.approach, abs=0, rel=1e-14)


def test_wheels_have_their_states():
    one = build_model(parse_case(TEXT.replace("thesis-2dof", "thesis-1dof")))
    assert len(one.wheel.beta) == 2
    assert one.held_wheel is None
    assert one.active_wheel is one.wheel
    two = build_model(parse_case(TEXT)).configured(coupling="displacement")
    assert two.active_wheel is two.held_wheel
    assert len(two.active_wheel.beta) == 2


def test_functions_longer_than_the_track_are_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path))
    text = TEXT.replace('model = "rigid"', 'preset = "thesis-discrete"\nbays = 20\nmemory = 0.4')
    with pytest.raises(CaseError, match="bays"):
        build_model(parse_case(text))
