"""The case as one immutable object."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import tomli_w
from pydantic import BeforeValidator, Field, PrivateAttr, model_validator

from wheelrail.case.consistency import cross_faults
from wheelrail.case.excitations import Excitation
from wheelrail.case.fields import Section, as_tuple
from wheelrail.case.friction_sections import Friction
from wheelrail.case.sections import Contact, Creepage, Load, Output, Simulation
from wheelrail.case.track_sections import Track
from wheelrail.case.wheel_sections import Wheel

__all__ = ["Case"]


class Case(Section):
    """A wheel/rail interaction case with presets resolved; equal cases describe the same run.

    Read one with :func:`wheelrail.case.load_case`, which reports every fault in the words of the file.
    """

    title: str = Field(default="", description="What the case is")
    simulation: Simulation
    wheel: Wheel
    track: Track
    contact: Contact
    friction: Friction | None = None
    load: Load
    creepage: Creepage | None = None
    excitation: Annotated[tuple[Excitation, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="Roughness on wheel and rail; any number, added up"
    )
    output: Output = Field(default_factory=lambda: Output(), description="What a stand-alone run writes")

    _folder: Path = PrivateAttr(default_factory=Path)

    @model_validator(mode="after")
    def _consistent(self) -> Case:
        faults = cross_faults(self.to_dict())
        if faults:
            raise ValueError("\n".join(faults))
        return self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Case):
            return NotImplemented
        return self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    @property
    def folder(self) -> Path:
        """Folder that the data files of the case are relative to."""
        return self._folder

    def data_path(self, file: str) -> Path:
        """Path of a data file that the case names.

        Parameters
        ----------
        file : str
            As written in the case, for example ``case.excitation[0].file``.

        Returns
        -------
        pathlib.Path
            The file, relative to :attr:`folder` unless it is absolute.
        """
        return self._folder / file

    def to_dict(self) -> dict[str, Any]:
        """Plain values (dict, list, str, int, float) in the layout of the case file; keys left out stay out."""
        return self.model_dump(mode="json", exclude_none=True)

    def to_toml(self) -> str:
        """Text of a case file that gives an equal case, with presets resolved and data files named as before."""
        return tomli_w.dumps(self.to_dict())
