import logging
import os

import numpy as np
import pytest

from wheelrail.greens import cache, moving
from wheelrail.greens.cache import cache_folder, cached_moving_greens, clear_cache, list_cache
from wheelrail.numerics import array_file

SETTINGS = {"speed": 30.0, "dx": 5e-3, "memory": 0.02}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def track(thesis_track):
    return thesis_track(bays=20, elements_per_bay=4)


@pytest.fixture
def computed(monkeypatch):
    """Count how often the functions are computed, by the real function."""
    calls = []
    real = cache.compute_moving_greens

    def counting(*args, **settings):
        calls.append(settings)
        return real(*args, **settings)

    monkeypatch.setattr(cache, "compute_moving_greens", counting)
    return calls


def same(one, other):
    np.testing.assert_array_equal(one.values, other.values)
    np.testing.assert_array_equal(one.neglected_energy, other.neglected_energy)
    np.testing.assert_array_equal(one.neglected_compliance, other.neglected_compliance)
    assert (one.dx, one.dt, one.horizon) == (other.dx, other.dt, other.horizon)


def test_second_call_reads_the_same_numbers(track, computed, folder):
    first, second = (cached_moving_greens(track, **SETTINGS) for _ in range(2))
    assert len(computed) == 1
    same(first, second)
    same(first, moving.compute_moving_greens(track, **SETTINGS))
    assert len(list(folder.iterdir())) == 1


def test_every_parameter_is_part_of_the_key(track, thesis_track, folder):
    keys = {cache._key(track, SETTINGS)[0]}
    changes = {name: getattr(track, name) * 1.0000000001 for name in vars(track) if not name.startswith("_")}
    changes |= {"bays": 22, "elements_per_bay": 5}
    assert len(changes) == 12
    for name, value in changes.items():
        keys.add(cache._key(thesis_track(**{"bays": 20, "elements_per_bay": 4, name: value}), SETTINGS)[0])
    for name, value in {"speed": 30.000000001, "dx": 5.0000001e-3, "memory": None}.items():
        keys.add(cache._key(track, {**SETTINGS, name: value})[0])
    assert len(keys) == 1 + 12 + 3
    assert not folder.exists()


@pytest.mark.parametrize("name", ["ALGORITHM", "ENERGY_TOLERANCE", "LONGEST_HORIZON", "MARGIN_BAYS"])
def test_every_setting_is_part_of_the_key(track, monkeypatch, name):
    before = cache._key(track, SETTINGS)[0]
    monkeypatch.setattr(cache, name, getattr(cache, name) * 2)
    assert cache._key(track, SETTINGS)[0] != before


DAMAGE = {
    "flipped byte in the numbers": lambda data: data[:-5000] + bytes([data[-5000] ^ 1]) + data[-4999:],
    "flipped byte in the header": lambda data: data[:60] + bytes([data[60] ^ 1]) + data[61:],
    "flipped length of the header": lambda data: data[:8] + bytes([data[8] ^ 64]) + data[9:],
    "cut short": lambda data: data[: len(data) // 2],
    "empty": lambda _: b"",
    "something else": lambda _: b"# not ours\n" * 100,
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_files_are_computed_anew(track, computed, folder, caplog, damage):
    first = cached_moving_greens(track, **SETTINGS)
    (path,) = folder.iterdir()
    good = path.read_bytes()
    path.write_bytes(DAMAGE[damage](good))
    assert "unusable" in list_cache()[0].description
    with caplog.at_level(logging.WARNING):
        again = cached_moving_greens(track, **SETTINGS)
    assert len(computed) == 2
    assert "computed anew" in caplog.text
    same(first, again)
    assert path.read_bytes() == good
    caplog.clear()
    cached_moving_greens(track, **SETTINGS)
    assert len(computed) == 2
    assert not caplog.records


def test_interrupted_write_leaves_nothing_that_is_used(track, computed, folder, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(array_file.os, "replace", interrupt)
        with pytest.raises(KeyboardInterrupt):
            cached_moving_greens(track, **SETTINGS)
    assert list_cache() == []
    assert list(folder.iterdir()) == []
    cached_moving_greens(track, **SETTINGS)
    assert len(computed) == 2
    assert len(list_cache()) == 1


def test_what_a_killed_write_leaves_is_not_used_and_cleared(track, computed, folder):
    cached_moving_greens(track, **SETTINGS)
    (path,) = folder.iterdir()
    (folder / f".{path.name}.abc123.part").write_bytes(path.read_bytes()[:1000])
    path.unlink()
    cached_moving_greens(track, **SETTINGS)
    assert len(computed) == 2
    (folder / "notes.txt").write_text("not ours")
    assert clear_cache() == 2
    assert [entry.name for entry in folder.iterdir()] == ["notes.txt"]
    assert clear_cache() == 0


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="needs POSIX permissions")
def test_a_folder_that_cannot_be_written_is_only_a_warning(track, folder, caplog):
    folder.parent.joinpath("cache").write_text("a file in the folder's place")
    with caplog.at_level(logging.WARNING):
        greens = cached_moving_greens(track, **SETTINGS)
    assert "could not be cached" in caplog.text
    same(greens, moving.compute_moving_greens(track, **SETTINGS))


def test_list_describes_the_content(track):
    cached_moving_greens(track, **SETTINGS)
    (entry,) = list_cache()
    assert "108 km/h" in entry.description
    assert "dx 5 mm" in entry.description
    assert "130 functions of 120 samples" in entry.description
    assert entry.size == entry.path.stat().st_size


def test_folder_without_the_variable(monkeypatch):
    monkeypatch.delenv("WHEELRAIL_CACHE")
    assert "wheelrail" in str(cache_folder())
