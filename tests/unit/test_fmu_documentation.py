"""Sentences of the FMU's page on ports without effect."""

from fmu_src.documentation import _without_effect

ALL = {"wheel": "flexible", "track": "waveguide", "friction": "kraft", "lateral": True}


def test_nothing_to_say_is_no_sentence():
    assert _without_effect("transient", geometry="straight tread on a round rail", **ALL) == ""


def test_profiles_decide_on_the_lateral_position():
    text = _without_effect("transient", geometry="wheel s1002 on rail 60e1", **ALL)
    assert text == "Its model has no use for <code>lateral_position</code>: no effect on any force."


def test_a_vertical_model():
    text = _without_effect(
        "none", wheel="rigid", track="rigid", friction="none", lateral=False, geometry="straight tread on a round rail"
    )
    assert text.startswith("Its model has no use for <code>wheel_y</code>, <code>lateral_shift</code>")
    assert text.endswith("<code>rail_disp_y</code> read 0.")
