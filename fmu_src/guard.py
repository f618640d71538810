"""Everything that works round a defect of PythonFMU 0.7.0's binary; nothing of it is anywhere else.

The binary calls the slave's methods by name. Its defects, found in its source and by experiment, and what is done:

==== ====================================================================== ==========================================
No.  Defect of the binary                                                   Dealt with
==== ====================================================================== ==========================================
D1   A method that raises makes it give up its references to the class,     :func:`guarded`, :func:`keep_alive`
     the instance and the log queue although it goes on using them
D2   The only text a host gets of an exception is its ``repr``, and only    :func:`guarded`: full text on stderr, and
     when it logs; there is no traceback                                    :class:`_Reported`
D3   At every instantiation it gives up one reference to the entry          :func:`keep_globals`, called by the entry
     script's globals that it does not own                                  script each time it runs
D4   The entry script runs again at every instantiation, and the class      the entry script only defines the class
     must be defined there, below one called ``Fmi2Slave``
D5   ``resources`` is put at the front of ``sys.path`` at every             :func:`forget_path`
     instantiation and stays there
D6   A log message is handed to the host as a printf format, and FMI        :func:`fmi_text`
     reads ``#`` as the start of a reference
D7   A log message and its category are never freed                         :class:`Journal` has a limit on warnings
D8   The constructor is called again by ``fmi2Reset`` when the old          :class:`~.slave.Fmi2Slave` never raises in
     instance is gone; raising there leaves dangling pointers               its constructor once the folder has worked
D9   The serialising functions are called on the class: an exception there  the slave's two functions can't raise
     drops references of an instance that is not known
D10  State set and got by variable name only                                the slave overrides all four functions
D11  The resource folder's URI is not decoded, except for ``%20``: with any out of reach (nothing of this package has
     other escaped character in the path no file is found and the host      run yet); told in the documentation
     crashes
D12  After an exception it hands the log queue to the host with the         :meth:`Journal.hold`
     exception pending, which breaks a logger written in Python and loses
     the text
D13  On Linux it stays loaded until the process ends and then releases      :func:`release_at_exit` in Python hosts;
     its interpreter object twice, which now and then ends the host with    out of reach in others (told in the
     a memory error                                                         documentation)
D14  It does not free a saved state that the host overwrites                out of reach; a state is one ``bytes``
==== ====================================================================== ==========================================

The reference counts of D1 and D3 belong to one version of the binary: the build refuses any other
(:data:`WRAPPER_VERSION`).
"""

from __future__ import annotations

import atexit
import ctypes
import functools
import os
import sys
import traceback
from collections.abc import Callable
from typing import Any, TypeVar

__all__ = [
    "WRAPPER_VERSION",
    "Journal",
    "LogMessage",
    "fmi_text",
    "forget_path",
    "guarded",
    "guarded_step",
    "keep_alive",
    "keep_globals",
    "release_at_exit",
]

WRAPPER_VERSION = "0.7.0"
"""The PythonFMU version whose binary the reference counts below belong to."""

WARNING_LIMIT = 100
"""Warnings that one instance passes on to the host (D7)."""

_WARNING, _DISCARD, _ERROR = 1, 2, 3
_CATEGORY = {_WARNING: "logStatusWarning", _DISCARD: "logStatusDiscard", _ERROR: "logStatusError"}

_BINARY = ("binaries", "linux64", "WheelRail.so")
_released_at_exit: dict[str, Callable[[], None]] = {}

_Method = TypeVar("_Method", bound=Callable[..., Any])


def _add_reference(thing: object) -> None:
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))


def keep_alive(slave: Any) -> None:
    """Give back the three references that the binary drops after an exception (D1)."""
    _add_reference(type(slave))
    _add_reference(slave)
    _add_reference(slave.journal.queue)


def keep_globals(namespace: dict[str, Any]) -> None:
    """Give the globals of the entry script the reference that the binary drops at each instantiation (D3)."""
    _add_reference(namespace)


def forget_path(resources: str) -> None:
    """Take the resource folder out of ``sys.path`` again; all modules are loaded by now (D5)."""
    while resources in sys.path:
        sys.path.remove(resources)


def release_at_exit(resources: str) -> None:
    """Have the binary release its interpreter object while Python ends, before C++ does and then it again (D13).

    In a host that is not Python the binary itself ends Python, in the middle of that release, so that nothing may be
    done; such a host gave Python no command line.
    """
    if not sys.platform.startswith("linux") or not sys.orig_argv:
        return
    path = os.path.join(os.path.dirname(resources.rstrip(os.sep)), *_BINARY)
    if path in _released_at_exit:
        return
    try:
        release = ctypes.CDLL(path, mode=os.RTLD_NOLOAD | os.RTLD_NOW).finalizePythonInterpreter
    except (OSError, AttributeError):  # the host loaded a copy from elsewhere: it can end as before
        return
    release.argtypes, release.restype = [], None
    _released_at_exit[path] = release
    atexit.register(release)


def fmi_text(text: str) -> str:
    """Return a message that survives printf and FMI's variable references (D6)."""
    return text.replace("%", "%%").replace("#", "##")


class LogMessage:
    """One message as the binary reads it: attributes ``status``, ``category`` and ``msg``."""

    __slots__ = ("category", "msg", "status")

    def __init__(self, status: int, text: str) -> None:
        self.status = status
        self.category = _CATEGORY[status]
        self.msg = fmi_text(text)


class Journal:
    """Messages of one instance, to stderr and to the host's log.

    Parameters
    ----------
    instance : str
        Instance name, put in front of what goes to stderr.

    Attributes
    ----------
    queue : list of LogMessage
        Handed to the host and emptied by the binary after each call.
    """

    def __init__(self, instance: str) -> None:
        self.instance = instance
        self.queue: list[LogMessage] = []
        self._held: list[LogMessage] = []
        self._warnings = 0

    def failed(self, text: str, details: str = "") -> None:
        """Write an error and its traceback, if any, to stderr; the host gets it with the exception."""
        self._print("error", text + ("\n" + details if details else ""))

    def discarded(self, text: str, details: str = "") -> None:
        """Report a step that was not done: text to stderr and the host, traceback to stderr."""
        self.failed(text, details)
        self.queue.append(LogMessage(_DISCARD, text))

    def lasting_error(self, text: str) -> None:
        """Report an error of a call that can't fail."""
        self.failed(text)
        self.queue.append(LogMessage(_ERROR, text))

    def warning(self, text: str) -> None:
        """Report a warning; after :data:`WARNING_LIMIT` of them the rest are dropped, and this is said once."""
        self._warnings += 1
        if self._warnings > WARNING_LIMIT:
            return
        if self._warnings == WARNING_LIMIT:
            text += f" (warning {WARNING_LIMIT} of this instance: further ones are not shown)"
        self._print("warning", text)
        self.queue.append(LogMessage(_WARNING, text))

    def hold(self) -> None:
        """Keep the queue from the host until the next call (D12)."""
        self._held += self.queue
        self.queue.clear()

    def release(self) -> None:
        """Put back what was held."""
        if self._held:
            self.queue += self._held
            self._held.clear()

    def _print(self, level: str, text: str) -> None:
        # A host without a console has no stderr, or a closed one; that must not become an error of the slave.
        try:
            print(f"WheelRail {self.instance}: {level}: {text}", file=sys.stderr, flush=True)  # noqa: T201
        except (AttributeError, OSError, ValueError):
            return


class _Reported(Exception):  # noqa: N818 - the host sees no name, only the text
    """An exception whose ``repr``, which is all that the binary shows of it, is its text."""

    def __repr__(self) -> str:
        return str(self)


def guarded(method: _Method) -> _Method:
    """Report whatever a method of the slave raises, and leave the binary usable (D1, D2, D12).

    The exception goes on to the host as status Fatal: outside ``do_step`` the binary knows no other way to fail. The
    instance stays usable all the same.
    """

    @functools.wraps(method)
    def call(self: Any, *args: Any) -> Any:
        try:
            self.journal.release()
            return method(self, *args)
        except BaseException as error:
            text, details = _explain(self, method.__name__, error)
            self.journal.failed(text, details)
            self.journal.hold()
            keep_alive(self)
            raise _Reported(fmi_text(text)) from None

    return call  # type: ignore[return-value]


def guarded_step(method: _Method) -> _Method:
    """Like :func:`guarded` for ``do_step``: report and return False, which the host sees as status Discard."""

    @functools.wraps(method)
    def call(self: Any, *args: Any) -> bool:
        try:
            self.journal.release()
            return method(self, *args)
        except BaseException as error:
            self.journal.discarded(*_explain(self, method.__name__, error))
            return False

    return call  # type: ignore[return-value]


def _explain(slave: Any, name: str, error: BaseException) -> tuple[str, str]:
    """Return the message and the traceback, empty for what the user can put right."""
    if isinstance(error, slave.user_error):
        return f"{name}: {error}", ""
    return f"{name}: {type(error).__name__}: {error}", "".join(traceback.format_exception(error))
