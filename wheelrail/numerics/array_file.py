"""One file for a set of named arrays with a JSON header: deterministic, checked, read with numpy alone.

Layout: magic (8 bytes), BLAKE2b digest of all that follows (32 bytes), length of the JSON header (8 bytes, little
endian), the header, then the arrays, each starting at a multiple of 64 bytes.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["ArrayFileError", "read_arrays", "write_arrays"]

_MAGIC = b"WRARRAY1"
_ALIGN = 64
_DIGEST = 32


class ArrayFileError(Exception):
    """The file is not of this format, cut short or damaged."""


def write_arrays(path: str | os.PathLike[str], header: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> None:
    """Write atomically: an interrupted call leaves the old file, or none.

    Parameters
    ----------
    path : path-like
    header : mapping
        JSON-able.
    arrays : mapping of str to ndarray
        Written in the order of their names, as little-endian.
    """
    table, payload, offset = {}, [], 0
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        array = array.astype(array.dtype.newbyteorder("<"), copy=False)
        table[name] = {"dtype": array.dtype.str, "shape": list(array.shape), "offset": offset}
        payload.append(array)
        offset += -(-array.nbytes // _ALIGN) * _ALIGN
    text = json.dumps({"header": dict(header), "arrays": table}, sort_keys=True, ensure_ascii=True).encode()
    text += b" " * (-(len(_MAGIC) + 8 + _DIGEST + len(text)) % _ALIGN)
    pieces: list[Any] = [len(text).to_bytes(8, "little"), text]
    for array in payload:
        pieces += [memoryview(array.reshape(-1).view(np.uint8)), b"\0" * (-array.nbytes % _ALIGN)]
    digest = hashlib.blake2b(digest_size=_DIGEST)
    for piece in pieces:
        digest.update(piece)
    target = Path(path)
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".part")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(_MAGIC + digest.digest())
            for piece in pieces:
                file.write(piece)
        os.chmod(temporary, 0o644)
        os.replace(temporary, target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def read_arrays(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, NDArray], str]:
    """Read a whole file and check it.

    Returns
    -------
    header : dict
    arrays : dict of str to ndarray
        Read-only.
    digest : str
        Hexadecimal digest of the content.

    Raises
    ------
    ArrayFileError
        If the file is not of this format or damaged.
    OSError
        If it can't be read.
    """
    data = Path(path).read_bytes()
    start = len(_MAGIC) + _DIGEST + 8
    if len(data) < start or data[: len(_MAGIC)] != _MAGIC:
        raise ArrayFileError(f"{path}: not a wheelrail array file")
    digest = hashlib.blake2b(memoryview(data)[start - 8 :], digest_size=_DIGEST).digest()
    if digest != data[len(_MAGIC) : start - 8]:
        raise ArrayFileError(f"{path}: damaged (checksum differs)")
    length = int.from_bytes(data[start - 8 : start], "little")
    content = json.loads(data[start : start + length])
    arrays = {}
    for name, entry in content["arrays"].items():
        dtype, shape = np.dtype(entry["dtype"]), tuple(entry["shape"])
        count = int(np.prod(shape, dtype=np.int64))
        arrays[name] = np.frombuffer(data, dtype, count, start + length + entry["offset"]).reshape(shape)
    return content["header"], arrays, digest.hex()
