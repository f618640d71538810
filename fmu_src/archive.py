"""A zip file with the same bytes for the same content."""

from __future__ import annotations

import contextlib
import os
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

from .errors import BuildError

__all__ = ["write_archive"]

_EARLIEST = (1980, 1, 1, 0, 0, 0)  # the first date a zip can hold
_UNIX = 3


def write_archive(path: Path, files: Mapping[str, bytes]) -> None:
    """Write files to a zip at once: deflated, sorted, with fixed times and permissions.

    Parameters
    ----------
    path : Path
        The archive; an old one is replaced when the new one is complete.
    files : mapping of str to bytes
        Content by name; names use ``/``. ``modelDescription.xml`` comes first, so that tools find it fast.

    Raises
    ------
    BuildError
        If the file can't be written.
    """
    temporary: str | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        with os.fdopen(handle, "wb") as stream, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for name in sorted(files, key=lambda name: (name != "modelDescription.xml", name)):
                info = zipfile.ZipInfo(name, _EARLIEST)
                info.create_system = _UNIX
                info.compress_type = zipfile.ZIP_DEFLATED
                executable = name.startswith("binaries/")
                info.external_attr = (0o100755 if executable else 0o100644) << 16
                archive.writestr(info, files[name], compresslevel=9)
        os.chmod(temporary, 0o644)  # mkstemp gives 0600
        os.replace(temporary, path)
        temporary = None
    except OSError as error:
        raise BuildError(f"{path}: the FMU can't be written: {error.strerror or error}.") from error
    finally:
        if temporary:
            with contextlib.suppress(OSError):
                os.unlink(temporary)
