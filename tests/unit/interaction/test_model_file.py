import numpy as np
import pytest

from wheelrail.errors import ModelFileError
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model
from wheelrail.numerics.array_file import read_arrays, write_arrays

SPECTRUM = '[[excitation]]\ntype = "spectrum"\nname = "iso3095-2013-limit"\non = "rail"\nseed = 7'
CHOICES = {
    "2dof winkler": {},
    "1dof hertz": {"wheel": "1dof", "contact": "hertz"},
    "rigid": {"wheel": "rigid", "track": "rigid"},
    "random": {"excitation": SPECTRUM},
    "displacement": {"coupling": "displacement"},
}


def run(model) -> bytes:
    sim = CoSimulation(model)
    sim.set_inputs(wheel_z=6e-4)
    for length in (0.03, 0.0011, 0.02):
        sim.advance(length)
    return sim.save()


@pytest.mark.parametrize("choice", CHOICES)
def test_a_loaded_model_runs_the_same_to_the_bit(small_model, tmp_path, choice):
    model = small_model(**CHOICES[choice])
    save_model(model, tmp_path / "model")
    loaded = load_model(tmp_path / "model")
    assert run(loaded) == run(model)
    assert (loaded.title, loaded.case, loaded.report) == (model.title, model.case, model.report)
    assert loaded.parameters == model.parameters


@pytest.mark.parametrize("contact", ["average", "prefilter"])
def test_prefilters_too(small_model, tmp_path, contact):
    model = small_model(contact=contact)
    save_model(model, tmp_path / "model")
    assert run(load_model(tmp_path / "model")) == run(model)


def test_same_model_same_bytes(small_model, tmp_path):
    save_model(small_model(), tmp_path / "1")
    save_model(small_model(), tmp_path / "2")
    save_model(load_model(tmp_path / "1"), tmp_path / "3")
    first = (tmp_path / "1").read_bytes()
    assert (tmp_path / "2").read_bytes() == first
    assert (tmp_path / "3").read_bytes() == first


def test_changed_parameters_are_saved(small_model, tmp_path):
    model = small_model().configured(roughness_scale=2.5, start_position=0.13, random_seed=4)
    save_model(model, tmp_path / "model")
    loaded = load_model(tmp_path / "model")
    assert loaded.parameters == model.parameters
    assert run(loaded) == run(model)


def test_damage_is_detected(small_model, tmp_path):
    path = tmp_path / "model"
    save_model(small_model(), path)
    good = path.read_bytes()
    rng = np.random.default_rng(1)
    places = [*range(0, 60), *rng.integers(0, len(good), 60), len(good) - 1]
    for at in places:
        path.write_bytes(good[:at] + bytes([good[at] ^ 0x10]) + good[at + 1 :])
        with pytest.raises(ModelFileError, match="model"):
            load_model(path)
    for length in (0, 7, 47, 48, 1000, len(good) - 1):
        path.write_bytes(good[:length])
        with pytest.raises(ModelFileError):
            load_model(path)


def test_missing_and_foreign_files(small_model, tmp_path):
    with pytest.raises(ModelFileError, match="nowhere"):
        load_model(tmp_path / "nowhere")
    with pytest.raises(ModelFileError):
        load_model(tmp_path)
    path = tmp_path / "model"
    save_model(small_model(), path)
    header, arrays, _ = read_arrays(path)
    write_arrays(path, {**header, "format": 4}, arrays)
    with pytest.raises(ModelFileError, match="format 4, this version reads format 3"):
        load_model(path)
    write_arrays(path, {"key": "a cache file"}, arrays)
    with pytest.raises(ModelFileError, match="format None"):
        load_model(path)
