"""One loaded model per content and process, shared by all instances."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from typing import Any

__all__ = ["shared_model"]

_models: weakref.WeakValueDictionary[tuple[str, str], Any] = weakref.WeakValueDictionary()
_lock = threading.Lock()
# fmi2Reset frees an instance before it makes the next one: without this reference the model of a lone instance would
# be read from disk again. It keeps one model in memory after the last instance is gone.
_latest: list[Any] = []


def shared_model(digest: str, path: str, load: Callable[[str], Any]) -> Any:
    """Return the model with the given content, loading it when no instance holds it.

    Parameters
    ----------
    digest : str
        Hash of the model's file, written when the FMU was built.
    path : str
        Where this FMU's copy of the file is.
    load : callable
        Reads the file.

    Returns
    -------
    object
        The model, never changed by those who share it.
    """
    with _lock:
        key = (load.__module__, digest)  # the module's name holds the version of the code
        model = _models.get(key)
        if model is None:
            model = load(path)
            _models[key] = model
        _latest[:] = [model]
        return model
