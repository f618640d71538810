"""Progress bars on the terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tqdm import tqdm

__all__ = ["progress_bar"]

_SHARE = "{desc}: {percentage:3.0f}% |{bar}| {elapsed} < {remaining}"
_COUNT = "{desc}: {percentage:3.0f}% |{bar}| {n_fmt}/{total_fmt} {unit} [{elapsed} < {remaining}, {rate_fmt}]"


@contextmanager
def progress_bar(
    description: str, *, total: float = 1.0, unit: str | None = None, quiet: bool = False, force: bool = False
) -> Iterator[Callable[[float], None]]:
    """Show a bar on stderr.

    Parameters
    ----------
    description : str
        What is going on.
    total : float
        Value that means done.
    unit : str, optional
        What is counted; left out: a share of the whole.
    quiet : bool
        Never show anything.
    force : bool
        Show it also where stderr is not a terminal.

    Yields
    ------
    callable
        Takes the value reached so far. The bar appears with the first call, so work that is never begun has none.
    """
    bar: tqdm | None = None
    shown = not quiet and (force or sys.stderr.isatty())

    def reached(value: float) -> None:
        nonlocal bar
        if not shown:
            return
        if bar is None:
            bar = tqdm(
                total=total,
                desc=description,
                unit=unit or "",
                file=sys.stderr,
                dynamic_ncols=True,
                bar_format=_SHARE if unit is None else _COUNT,
                unit_scale=unit is not None,
            )
        bar.update(value - bar.n)
        if value >= total:
            bar.close()  # leaves the line to the next bar

    try:
        yield reached
    finally:
        if bar is not None:
            bar.close()
