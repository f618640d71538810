"""Dask workers for a study: processes on this machine, or those of an existing cluster."""

from __future__ import annotations

import logging
import signal
import threading
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from multiprocessing import resource_tracker
from typing import Any

import dask.config
from distributed import Client, LocalCluster, WorkerPlugin

from wheelrail.errors import ParameterError
from wheelrail.version import __version__

__all__ = ["existing_cluster", "local_workers"]

_SETTINGS = {
    "distributed.scheduler.allowed-failures": 0,  # what may have killed a worker is tried again alone
    "distributed.comm.timeouts.connect": "30s",
}
_QUIET = logging.CRITICAL + 1  # what goes wrong is in the outcomes; Dask's own words would only confuse
_ANSWER = 10  # s


class _IgnoreInterrupt(WorkerPlugin):
    """Leaves Ctrl-C, which a terminal sends to the workers as well, to the process that started them.

    Where signals can be blocked, workers are started without it.
    """

    def setup(self, worker: Any) -> None:  # noqa: ARG002
        signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def local_workers(count: int) -> Iterator[Client]:
    """Start worker processes on this machine, reachable from it alone.

    Parameters
    ----------
    count : int
        Number of processes, each with one thread.

    Yields
    ------
    distributed.Client
    """
    with _quiet(), dask.config.set(_SETTINGS), ExitStack() as stack:
        with _interrupt_later():
            cluster = LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address=None,  # pyright: ignore[reportArgumentType]
                silence_logs=_QUIET,
            )
            stack.callback(_close, cluster)
            client = Client(cluster, set_as_default=False)
            stack.callback(_close, client)
            client.register_plugin(_IgnoreInterrupt())
        yield client


def _close(service: Client | LocalCluster) -> None:
    with suppress(Exception):  # it goes anyway, and there may be an error on its way that matters
        service.close(timeout=_ANSWER)


@contextmanager
def _interrupt_later() -> Iterator[None]:
    """Hold back Ctrl-C while processes start, which are left half made otherwise."""
    if threading.current_thread() is not threading.main_thread():
        yield  # the main thread gets it
        return
    received: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda number, _: received.append(number))
    try:
        with _inherited_mask():
            yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if received:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def _inherited_mask() -> Iterator[None]:
    """Start processes that never get Ctrl-C, where signals can be blocked."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # started later, it would unblock the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def existing_cluster(address: str) -> Iterator[Client]:
    """Connect to a Dask scheduler; its workers need this version of the package, and the data files of the cases.

    Parameters
    ----------
    address : str
        Such as ``tcp://host:8786``.

    Yields
    ------
    distributed.Client

    Raises
    ------
    ParameterError
        If no scheduler answers, or its workers can't do the work.
    """
    with _quiet():
        try:
            client = Client(address, timeout=_ANSWER, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ParameterError("scheduler", address, f"no Dask scheduler answers there ({error})") from None
        try:
            _check_workers(client, address)
            yield client
        finally:
            _close(client)


def _check_workers(client: Client, address: str) -> None:
    try:
        found: Any = client.run(_version)
    except Exception as error:
        raise ParameterError(
            "scheduler", address, f"its workers need wheelrail {__version__} ({type(error).__name__}: {error})"
        ) from None
    if not found:
        raise ParameterError("scheduler", address, "it has no workers; start some first")
    others = sorted({version for version in found.values() if version != __version__})
    if others:
        raise ParameterError(
            "scheduler", address, f"its workers have wheelrail {', '.join(others)}, and this is {__version__}"
        )


def _version() -> str:
    return __version__


@contextmanager
def _quiet() -> Iterator[None]:
    logger = logging.getLogger("distributed")
    before = logger.level
    logger.setLevel(_QUIET)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", module="distributed")
            yield
    finally:
        logger.setLevel(before)
