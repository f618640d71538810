"""The version, alone so that building and the FMU can read it without importing anything else."""

__version__ = "0.1.0"
