"""Flexible wheels and waveguide rails from a case: what reaches the model, the cache, and what is refused."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest

from wheelrail.analysis.sliding_case import case_stability
from wheelrail.case import case_from_dict
from wheelrail.errors import CaseError, WheelrailError
from wheelrail.explain import explain
from wheelrail.greens.combined import CombinedResponse
from wheelrail.greens.sampled import SampledGreens
from wheelrail.interaction import tracks, wheel_sources
from wheelrail.interaction.build import build_model, track_of, wheel_of
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model
from wheelrail.interaction.simulate import simulate
from wheelrail.interaction.wheels import MeasuredWheel
from wheelrail.numerics.disk_cache import list_cache
from wheelrail.wheel.modes import FlexibleWheel, Mode

MODES = """name, frequency [Hz], damping_ratio, modal_mass [kg], shape_x, shape_y, shape_z
"2,0,a", 410.0, 1e-2, 60.0, 0.0, 0.9, 0.3
"2,0,a*", 410.0, 1e-2, 60.0, 0.4, 0.0, 0.0
"3,0,a", 1150.0, 1e-2, 40.0, 0.0, 0.7, -0.4
"2,r", 2600.0, 3e-2, 50.0, 0.0, 0.4, 0.9
"""
RIGID = {"mass": 340.0, "suspension_stiffness": 1.1e6, "suspension_damping": 13e3}
LATERAL = {"lateral_mass": 300.0, "lateral_stiffness": 5e6, "lateral_damping": 2e4}
# A section without its finest waves, so that it is quick.
RAIL = {"preset": "thesis-waveguide-60e1", "max_frequency": 1500.0, "memory": 0.02, "contact_position": 8e-3}
MEASURED = {
    "model": "flexible",
    "radius": 0.39,
    "receptances": "r.csv",
    "low_frequency": "static",
    **RIGID,
    **LATERAL,
}
NOTE = (
    "the receptances end at 7999.5 Hz, half the sampling frequency is 10000 Hz: in between there is only the "
    "compliance of what lies above"
)
DATA = {
    "simulation": {"speed": 20.0, "dx": 1e-3, "duration": 0.01, "start_position": 0.0},
    "wheel": {"model": "flexible", "radius": 0.39, "modes": "modes.csv", **RIGID, **LATERAL},
    "track": {"model": "rigid"},
    "contact": {
        "normal": "half-space",
        "rail_radius": 0.3,
        "youngs_modulus": 207e9,
        "poisson_ratio": 0.3,
        "dy": 1e-3,
        "length": 19e-3,
        "width": 19e-3,
        "tangential": "transient",
    },
    "friction": {"law": "constant", "coefficient": 0.3},
    "creepage": {"x": 0.0, "y": -1e-3, "spin": 0.0},
    "load": {"preload": 65e3, "coupling": "load"},
}


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    """One cache for all of these tests."""
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path_factory.getbasetemp() / "flexible"))


@pytest.fixture
def case(tmp_path):
    (tmp_path / "modes.csv").write_text(MODES)

    def make(**changes):
        data = deepcopy(DATA)
        for section, values in changes.items():
            data[section] = values if section in ("track", "wheel") else {**data[section], **values}
        return case_from_dict(data, folder=tmp_path)

    return make


def of(case, **changes):
    return case(wheel={**DATA["wheel"], **changes})


def write_receptances(path, wheel, frequency):
    values = wheel.held().receptance(frequency)
    pairs = [("yy", 1, 1), ("zz", 2, 2), ("yz", 1, 2), ("xx", 0, 0)]
    header = ",".join(["frequency [Hz]"] + [f"{part}_{name} [m/N]" for name, _, _ in pairs for part in ("re", "im")])
    columns = [frequency] + [part(values[:, i, j]) for _, i, j in pairs for part in (np.real, np.imag)]
    np.savetxt(path, np.transpose(columns), delimiter=",", header=header, comments="")


def unwrapped(text):
    return " ".join(text.split())


def test_modes_of_a_file_in_all_directions_or_the_vertical_alone(case):
    combined = build_model(case())
    assert combined.wheel.directions == 3
    assert combined.wheel.size == 2 * 6
    assert combined.held_wheel.size == 2 * 4
    vertical = build_model(case(contact={"tangential": "none"}))
    assert vertical.wheel.directions == 1
    assert vertical.wheel.size == 2 * 4  # neither the lateral body nor the partner moves vertically
    three, one = combined.wheel.values(300)[:, 2, 2], vertical.wheel.values(300)[:, 0, 0]
    np.testing.assert_allclose(one, three, rtol=0, atol=1e-12 * np.abs(one).max())
    wheel = wheel_of(case())
    assert isinstance(wheel, FlexibleWheel)
    np.testing.assert_allclose(
        combined.held_wheel.static_compliance()[1, 1], wheel.held().static_compliance()[1, 1], rtol=0.2
    )  # less the first samples that couple directions
    report = combined.report["wheel"]
    assert [name for name, *_ in report["modes"]] == ["2,0,a", "2,0,a*", "3,0,a", "2,r"]
    assert report["rigid_modes"] == ["vertical", "lateral"]


def test_first_samples(case):
    kept, zero = (build_model(case(simulation={"first_sample": name})) for name in ("kept", "zero"))
    first = kept.wheel.first
    assert not np.any(zero.wheel.first)
    assert not np.any(first[2, :2])
    assert not np.any(first[:2, 2])
    assert first[2, 2] > 0.0
    assert first[1, 1] > 0.0
    assert kept.wheel_first == first[2, 2]
    assert zero.tangential_compliances is None


def test_modes_are_removed_by_name_and_unknown_ones_refused(case):
    model = build_model(of(case, remove_modes=["2,0,a"]))
    assert model.held_wheel.size == 2 * 2
    with pytest.raises(CaseError, match=r'no mode "2,0,b"; nearest names: 2,0,a'):
        build_model(of(case, remove_modes=["2,0,b"]))


def test_a_memory_turns_recursions_into_samples(case):
    """Long enough, they are the same wheel."""
    recursive, sampled = build_model(case()), build_model(of(case, memory=0.3))
    assert isinstance(sampled.held_wheel, SampledGreens)
    assert isinstance(sampled.wheel, CombinedResponse)
    assert sampled.report["wheel"]["samples"] == 6000
    forces = []
    for model in (recursive, sampled):
        model = replace(model, track=None)
        run = CoSimulation(model)
        run.initialise()
        run.set_inputs(creepage_y=-2e-3, wheel_force_z=60e3)
        run.advance(150 * model.dt)
        forces.append([run.output(name) for name in ("force_y", "force_z", "wheel_disp_y")])
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-5)  # achieved: 2e-8


def test_receptances_give_the_wheel_of_the_modes_that_made_them(case, tmp_path):
    wheel = wheel_of(case())
    assert isinstance(wheel, FlexibleWheel)
    # 0.5 Hz lines: the modes have half-power bandwidths of 8 Hz and more.
    write_receptances(tmp_path / "r.csv", wheel, np.arange(0.5, 8000.0, 0.5))
    given = {**MEASURED, "receptances_as": "functions"}
    measured = case(wheel=given)
    assert isinstance(wheel_of(measured), MeasuredWheel)
    modal, model = build_model(case()), build_model(measured)
    assert isinstance(model.held_wheel, SampledGreens)
    runs = []
    for m in (modal, model):
        result = simulate(replace(m, track=None).configured(balance=False), duration=150 * m.dt, record=("force_y",))
        result.inputs = replace(result.inputs, creepage_y=-2e-3, wheel_force_z=60e3)
        runs.append(result.collect()["force_y"])
    change = np.ptp(runs[0])
    assert change > 1e3
    # Achieved: 1e-3, of the band that ends at 8 kHz.
    assert np.abs(runs[1] - runs[0]).max() < 5e-3 * change
    text = explain(measured)
    assert "15999 lines" in text
    assert model.report["wheel"]["notes"] == ["r.csv: yx, zx taken as zero, as the wheel's symmetry has it", NOTE]
    assert f"! wheel.receptances: {NOTE}" in unwrapped(text)
    with pytest.raises(CaseError, match='remove_modes: not used with receptances_as = "functions"'):
        case(wheel={**given, "remove_modes": ["2,0,a"]})
    with pytest.raises(CaseError, match=r'wheel\.mass: missing; low_frequency = "free" needs it'):
        case(wheel={key: value for key, value in given.items() if key not in RIGID} | {"low_frequency": "free"})


def test_modes_are_fitted_to_receptances_once(case, tmp_path, monkeypatch):
    wheel = wheel_of(case())
    assert isinstance(wheel, FlexibleWheel)
    write_receptances(tmp_path / "r.csv", wheel, np.arange(20.0, 4000.0, 5.0))
    measured = case(wheel=MEASURED)
    fitted = wheel_of(measured)
    assert isinstance(fitted, FlexibleWheel)
    assert fitted.rigid == wheel.rigid
    assert [mode.name for mode in fitted.modes[:4]] == ["fit-1", "fit-2", "fit-3", "fit-4"]
    frequency = np.array([410.0, 1000.0, 1150.0, 2600.0, 8000.0])
    np.testing.assert_allclose(
        fitted.receptance(frequency), wheel.receptance(frequency), rtol=0, atol=1e-17
    )  # achieved: 4e-21
    model = build_model(measured)
    assert model.report["wheel"]["notes"] == list(fitted.notes)
    assert fitted.notes[1].startswith("4 modes fitted from 410 Hz to 2600 Hz; they deviate from the receptances by ")
    forces = []
    for m in (build_model(case()), model):
        result = simulate(replace(m, track=None).configured(balance=False), duration=150 * m.dt, record=("force_y",))
        result.inputs = replace(result.inputs, creepage_y=-2e-3, wheel_force_z=60e3)
        forces.append(result.collect()["force_y"])
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-9)  # achieved: 4e-14
    text = unwrapped(explain(measured))
    assert "flexible: 4 modes fitted to r.csv" in text
    assert fitted.notes[1] in text
    assert "(fit-1) 410, (fit-2) 410, (fit-3) 1150, (fit-4) 2600 static" in text
    assert len(wheel_of(case(wheel={**MEASURED, "remove_modes": ["fit-3"]})).modes) == len(fitted.modes) - 1
    stability = case_stability(measured)
    assert [mode.name for mode in stability.modes] == ["fit-1", "fit-3", "fit-4"]
    assert stability.growing == case_stability(case()).growing
    with monkeypatch.context() as patch:
        patch.setattr("wheelrail.wheel.modal_fit.fit_modes", None)
        assert build_model(measured).fingerprint == model.fingerprint
        assert wheel_of(measured).notes == fitted.notes
        assert any("wheel r.csv: " in entry.description for entry in list_cache())
        with pytest.raises(TypeError):  # it would be fitted anew
            wheel_of(case(wheel={**MEASURED, "low_frequency": "free"}))
        write_receptances(tmp_path / "r.csv", wheel, np.arange(20.0, 4000.0, 10.0))
        with pytest.raises(TypeError):
            wheel_of(measured)


def test_receptances_that_are_no_modes(case, tmp_path):
    lines = "\n".join(f"{f}, 1e-9, -1e-12" for f in range(100, 3000, 10))
    (tmp_path / "r.csv").write_text(f"frequency [Hz], re_zz [m/N], im_zz [m/N]\n{lines}\n")
    message = 'r.csv: the receptances have no resonance; nothing .* them; receptances_as = "functions" takes them'
    with pytest.raises(CaseError, match=message):
        build_model(case(wheel=MEASURED))


def test_what_first_samples_of_zero_leave_out_is_said(case, tmp_path):
    """Of a wheel from receptances it is above all the compliance of the modes that lie above these."""
    wheel = wheel_of(case())
    assert isinstance(wheel, FlexibleWheel)
    high = Mode.with_frequency(name="2,r", mass=50.0, frequency=9e3, damping_ratio=3e-2, shape=(0.0, 0.4, 6.0))
    wheel = FlexibleWheel((*wheel.modes[:3], high))
    write_receptances(tmp_path / "r.csv", wheel, np.arange(0.5, 2000.0, 0.5))
    given = {**MEASURED, "receptances_as": "functions"}
    zero = case(wheel=given, simulation={"first_sample": "zero"})
    x, y, z = build_model(zero).report["wheel"]["lost_compliance"]
    above = high.shape[2] ** 2 / high.stiffness / wheel.static_compliance()[2, 2]
    assert above > 0.3
    assert z == pytest.approx(above, rel=0.03)  # achieved: 0.019
    assert max(x, y) < z
    lost = f"{100 * z:.2g} % vertical of the static compliance"
    assert lost in unwrapped(explain(zero))
    assert "static compliance of the wheel" not in unwrapped(explain(case(wheel=given)))


def test_notes_of_a_file_with_modes_reach_report_and_explanation(case):
    note = "modes.csv: 1 modes above 2000 Hz left out"
    given = of(case, max_frequency=2000.0)
    assert build_model(given).report["wheel"]["notes"] == [note]
    assert note in unwrapped(explain(given))
    assert build_model(case()).report["wheel"]["notes"] == []


def test_a_section_is_computed_once(case, monkeypatch):
    coarse = {"preset": "synthetic-c20", "max_frequency": 1300.0, "element_size": 0.02}
    first = build_model(case(wheel=coarse))
    assert {name for name, *_ in first.report["wheel"]["modes"]} >= {"2,0,a", "2,0,a*", "3,0,a"}
    monkeypatch.setattr("wheelrail.wheel.flexible.flexible_wheel", None)
    again = build_model(case(wheel=coarse))
    assert again.fingerprint == first.fingerprint
    assert any("wheel synthetic-c20" in entry.description for entry in list_cache())
    for changed in ({"damping": 1e-3}, {"contact_position": 0.01}, {"density": 7800.0}, {"element_size": 0.021}):
        with pytest.raises(TypeError):  # it would be computed anew
            build_model(case(wheel={**coarse, **changed}))
    with monkeypatch.context() as patch:
        patch.setattr(wheel_sources, "ALGORITHM", wheel_sources.ALGORITHM + 1)
        with pytest.raises(TypeError):
            build_model(case(wheel=coarse))


def test_what_a_section_does_not_allow_is_refused(case):
    coarse = {"preset": "synthetic-c20", "max_frequency": 500.0, "element_size": 0.02}
    with pytest.raises(CaseError, match=r"contact_position = 0\.09 m is refused"):
        build_model(case(wheel={**coarse, "contact_position": 0.09}))
    with pytest.raises(CaseError, match='the wheel has no mode "9,0,a"'):
        build_model(case(wheel={**coarse, "damping": {"9,0,a": 1e-3, "others": 1e-4}}))
    with pytest.raises(CaseError, match="head"):
        build_model(case(track={**RAIL, "contact_position": 0.06}))


def test_waveguide_in_all_directions_and_the_vertical_alone(case, monkeypatch, tmp_path):
    model = build_model(case(track=RAIL))
    assert model.track.values.shape == (1, 3, 3, 400)
    vertical = build_model(case(track=RAIL, contact={"tangential": "none"}))
    assert vertical.track.values.shape == (1, 1, 1, 400)
    np.testing.assert_array_equal(vertical.track.values[0, 0, 0], model.track.values[0, 2, 2])
    assert not np.any(model.track.values[0, 2, :2, 0])
    monkeypatch.setattr(tracks, "compute_waveguide_greens", None)
    assert build_model(case(track=RAIL)).fingerprint == model.fingerprint  # from the cache
    with pytest.raises(TypeError):
        build_model(case(track={**RAIL, "loss_factor": 0.02}))
    for setting in ("RING_LENGTH", "SPACING", "MARGIN", "ELEMENT_SIZE"):
        with monkeypatch.context() as patch:
            patch.setattr(tracks, setting, 1.01 * getattr(tracks, setting))
            with pytest.raises(TypeError):  # it would be computed anew
                build_model(case(track=RAIL))
    run = CoSimulation(model)
    assert run.output("rail_disp_y") * run.output("force_y") > 0.0
    steady = [run.output(name) for name in ("force_x", "force_y", "force_z", "rail_disp_y")]
    run.advance(50 * model.dt)
    now = [run.output(name) for name in ("force_x", "force_y", "force_z", "rail_disp_y")]
    np.testing.assert_allclose(now[:3], steady[:3], rtol=1e-8, atol=1e-4)
    np.testing.assert_allclose(now[3], steady[3], rtol=1e-8)
    save_model(model, tmp_path / "model")
    assert load_model(tmp_path / "model").fingerprint == model.fingerprint
    text = " ".join(explain(case(track=RAIL)).split())
    assert "9 of 400 samples" in text
    assert "(2,0,a) 410" in text
    assert "eqs. 3.50 and 3.51" in text


@pytest.mark.slow
def test_waveguide_on_sleepers(case):
    given = {"preset": "waveguide-60e1-sleepers", "max_frequency": 1500.0, "memory": 0.02}
    data = case(track=given, simulation={"dx": 5e-3}, contact={"length": 35e-3, "tangential": "none"})
    model = build_model(data)
    assert model.track.values.shape == (130, 1, 1, 80)
    track = track_of(data)
    assert track.sleeper_spacing == 0.65
    with pytest.raises(WheelrailError, match="multiple of"):
        case(track={**given, "sleeper_spacing": 0.6003})
