import os

import numpy as np
import pytest

from wheelrail.numerics import array_file
from wheelrail.numerics.array_file import ArrayFileError, read_arrays, write_arrays

HEADER = {"text": "é ü", "number": 0.1, "none": None, "list": [1, 2.5, "x"]}
ARRAYS = {
    "b": np.arange(7, dtype=float) / 3,
    "a": np.arange(24, dtype=np.int32).reshape(2, 3, 4),
    "empty": np.zeros((0, 3)),
    "c": np.array([1 + 2j, -0.0, np.inf]),
    "flags": np.array([True, False]),
    "strided": np.arange(20.0).reshape(4, 5)[:, ::2],
    "big_endian": np.array([1.5, 2.5], dtype=">f8"),
}


def test_round_trip(tmp_path):
    path = tmp_path / "x"
    write_arrays(path, HEADER, ARRAYS)
    header, arrays, digest = read_arrays(path)
    assert header == HEADER
    assert sorted(arrays) == sorted(ARRAYS)
    for name, array in ARRAYS.items():
        assert arrays[name].shape == array.shape
        assert arrays[name].dtype == array.dtype.newbyteorder("<")
        np.testing.assert_array_equal(arrays[name], array)
        if array.size:
            assert not arrays[name].flags.writeable
    assert len(digest) == 64


def test_same_content_same_bytes_whatever_the_order(tmp_path):
    write_arrays(tmp_path / "1", HEADER, ARRAYS)
    write_arrays(tmp_path / "2", dict(reversed(HEADER.items())), dict(reversed(ARRAYS.items())))
    assert (tmp_path / "1").read_bytes() == (tmp_path / "2").read_bytes()


def test_arrays_are_aligned(tmp_path):
    write_arrays(tmp_path / "x", HEADER, ARRAYS)
    data = (tmp_path / "x").read_bytes()
    assert data.find(ARRAYS["b"].tobytes()) % 64 == 0
    assert len(data) % 64 == 0


def test_every_flipped_byte_is_noticed(tmp_path):
    path = tmp_path / "x"
    write_arrays(path, {"k": 1}, {"a": np.arange(3.0)})
    good = path.read_bytes()
    for i in range(len(good)):
        path.write_bytes(good[:i] + bytes([good[i] ^ 0x10]) + good[i + 1 :])
        with pytest.raises(ArrayFileError, match="x"):
            read_arrays(path)


def test_every_truncation_is_noticed(tmp_path):
    path = tmp_path / "x"
    write_arrays(path, {"k": 1}, {"a": np.arange(3.0)})
    good = path.read_bytes()
    for i in range(len(good)):
        path.write_bytes(good[:i])
        with pytest.raises(ArrayFileError):
            read_arrays(path)
    path.write_bytes(good + b"\0")
    with pytest.raises(ArrayFileError):
        read_arrays(path)


@pytest.mark.parametrize("failing", ["replace", "chmod"])
def test_interrupted_write_keeps_the_old_file_and_leaves_nothing_behind(tmp_path, monkeypatch, failing):
    path = tmp_path / "x"
    write_arrays(path, {"version": "old"}, ARRAYS)
    old = path.read_bytes()

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(array_file.os, failing, interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_arrays(path, {"version": "new"}, ARRAYS)
    assert path.read_bytes() == old
    assert os.listdir(tmp_path) == ["x"]


def test_unusable_array_leaves_nothing_behind(tmp_path):
    with pytest.raises(TypeError):
        write_arrays(tmp_path / "x", {}, {"a": np.array([{}], dtype=object)})
    assert os.listdir(tmp_path) == []
