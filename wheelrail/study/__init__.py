"""Parameter studies: many cases that differ in some keys, on Dask, to one labelled data set.

Read a study file with :func:`load_study` and run it with :func:`run_study`, or ``wheelrail study`` on the command line.
"""

from wheelrail.study.definition import Axis, Point, Study
from wheelrail.study.measures import PointRun, ResultSettings, ThirdOctaveSettings
from wheelrail.study.reading import load_study, study_from_dict
from wheelrail.study.run import StudySummary, run_study

__all__ = [
    "Axis",
    "Point",
    "PointRun",
    "ResultSettings",
    "Study",
    "StudySummary",
    "ThirdOctaveSettings",
    "load_study",
    "run_study",
    "study_from_dict",
]
