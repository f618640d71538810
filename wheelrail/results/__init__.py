"""Result files: netCDF-4, written block by block, replaced atomically, and able to continue an interrupted run."""

from wheelrail.results.checkpoint import Checkpoint, case_differences, read_checkpoint
from wheelrail.results.layout import FORMAT, OUTPUTS, STATE
from wheelrail.results.reading import ResultFileError, case_of_result, is_interrupted, open_result
from wheelrail.results.writing import ResultWriter, check_target, part_path

__all__ = [
    "FORMAT",
    "OUTPUTS",
    "STATE",
    "Checkpoint",
    "ResultFileError",
    "ResultWriter",
    "case_differences",
    "case_of_result",
    "check_target",
    "is_interrupted",
    "open_result",
    "part_path",
    "read_checkpoint",
]
