"""High-frequency wheel/rail interaction in the time domain, after Pieringer (2011).

This module imports nothing heavy: the same package, cut down to what a step reads, travels inside the FMU and
starts there with numpy alone.
"""

from .version import __version__

__all__ = ["__version__"]
