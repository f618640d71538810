"""The elastic half-space on a grid of equal rectangular elements: the potential contact area.

Element I = iy * mx + ix lies at x = (ix - (mx - 1) / 2) dx, y likewise; mx and my are odd, so that an element is
centred on the nominal contact point. Influence coefficients depend on distances only and are kept once for each;
matrices are gathered for the elements in contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .influence import InfluenceCoefficients, influence_coefficients

__all__ = ["HalfSpace"]


@dataclass(frozen=True)
class HalfSpace:
    """Two bodies of one material, discretised.

    Parameters
    ----------
    mx, my : int
        Numbers of elements in rolling and in lateral direction, odd.
    dx, dy : float
        Element sides in m.
    shear_modulus : float
        G in Pa.
    poisson_ratio : float
    """

    mx: int
    my: int
    dx: float
    dy: float
    shear_modulus: float
    poisson_ratio: float

    @property
    def elements(self) -> int:
        """Number of elements n = mx my."""
        return self.mx * self.my

    @property
    def element_area(self) -> float:
        """Area of an element in m2."""
        return self.dx * self.dy

    @cached_property
    def x(self) -> NDArray:
        """Centres in rolling direction in m, shape (n,)."""
        return np.tile((np.arange(self.mx) - (self.mx - 1) // 2) * self.dx, self.my)

    @cached_property
    def y(self) -> NDArray:
        """Centres in lateral direction in m, shape (n,)."""
        return np.repeat((np.arange(self.my) - (self.my - 1) // 2) * self.dy, self.mx)

    @cached_property
    def edge(self) -> NDArray:
        """Which elements lie at the edge of the grid, shape (n,) of bool."""
        edge = np.ones((self.my, self.mx), dtype=bool)
        edge[1:-1, 1:-1] = False
        return edge.ravel()

    def _coefficients(self, shift: float) -> InfluenceCoefficients:
        """Coefficients over all distances, receiving points moved by ``shift`` in x; shape (2 my - 1, 2 mx - 1)."""
        x = np.arange(1 - self.mx, self.mx) * self.dx + shift
        y = np.arange(1 - self.my, self.my) * self.dy
        return influence_coefficients(
            x, y[:, None], dx=self.dx, dy=self.dy, shear_modulus=self.shear_modulus, poisson_ratio=self.poisson_ratio
        )

    @cached_property
    def coefficients(self) -> InfluenceCoefficients:
        """Influence coefficients over all distances, shape (2 my - 1, 2 mx - 1), zero distance in the middle."""
        return self._coefficients(0.0)

    @cached_property
    def shifted(self) -> InfluenceCoefficients:
        """Coefficients that carry tractions of one step into the next.

        A particle that is in an element now was dx further upstream (at x + dx) one step before.
        """
        return self._coefficients(self.dx)

    @cached_property
    def _flat(self) -> NDArray:
        # The flat index of a distance in a coefficient table is the difference of two of these, plus an offset.
        iy, ix = np.divmod(np.arange(self.elements), self.mx)
        return iy * (2 * self.mx - 1) + ix

    def pairs(self, to: NDArray, of: NDArray) -> NDArray:
        """Return flat indices into a coefficient table for all pairs of elements.

        Parameters
        ----------
        to, of : ndarray of int, shapes (m,) and (k,)
            Receiving and loaded elements.

        Returns
        -------
        ndarray of int, shape (m, k)
        """
        offset = (self.my - 1) * (2 * self.mx - 1) + self.mx - 1
        return (self._flat[to] + offset)[:, None] - self._flat[of]

    @cached_property
    def _transforms(self) -> dict[str, NDArray]:
        shape = self._fft_shape
        tables = {"a33": self.coefficients.a33}
        for name in ("a11", "a22", "a12"):
            tables[name] = getattr(self.coefficients, name)
            tables[f"shifted {name}"] = getattr(self.shifted, name)
        result = {}
        for name, table in tables.items():
            wrapped = np.zeros(shape)
            rows = np.arange(1 - self.my, self.my) % shape[0]
            columns = np.arange(1 - self.mx, self.mx) % shape[1]
            wrapped[np.ix_(rows, columns)] = table
            result[name] = np.fft.rfft2(wrapped)
        return result

    @cached_property
    def _fft_shape(self) -> tuple[int, int]:
        return _good_size(2 * self.my - 1), _good_size(2 * self.mx - 1)

    def _transform(self, field: NDArray) -> NDArray:
        return np.fft.rfft2(field.reshape(self.my, self.mx), self._fft_shape)

    def _back(self, transform: NDArray) -> NDArray:
        return np.fft.irfft2(transform, self._fft_shape)[: self.my, : self.mx].ravel()

    def normal_displacement(self, pressure: NDArray) -> NDArray:
        """Compute the normal displacement difference u3 = A33 p3 everywhere on the grid.

        Parameters
        ----------
        pressure : ndarray, shape (n,)
            Pa.

        Returns
        -------
        ndarray, shape (n,)
            m.
        """
        return self._back(self._transforms["a33"] * self._transform(pressure))

    def carried_displacement(self, tractions: NDArray) -> NDArray:
        """Compute the tangential displacement difference that the particles had under the last step's tractions.

        Parameters
        ----------
        tractions : ndarray, shape (2, n)
            Of the previous step, Pa.

        Returns
        -------
        ndarray, shape (2, n)
            u' in m, at each element for the particle that is there now (Kalker 1990; Pieringer 2011, eq. 3.47).
        """
        return self._tangential(tractions, "shifted ")

    def tangential_displacement(self, tractions: NDArray) -> NDArray:
        """Compute the tangential displacement difference everywhere on the grid.

        Parameters
        ----------
        tractions : ndarray, shape (2, n)
            Pa.

        Returns
        -------
        ndarray, shape (2, n)
            m.
        """
        return self._tangential(tractions, "")

    def _tangential(self, tractions: NDArray, which: str) -> NDArray:
        first, second = self._transform(tractions[0]), self._transform(tractions[1])
        a11, a22, a12 = (self._transforms[f"{which}{name}"] for name in ("a11", "a22", "a12"))
        return np.stack([self._back(a11 * first + a12 * second), self._back(a12 * first + a22 * second)])

    def upstream(self, field: NDArray) -> NDArray:
        """Return what the particles had one step before, when they were dx upstream; shape (..., n) as given."""
        moved = np.zeros_like(field).reshape(*field.shape[:-1], self.my, self.mx)
        moved[..., :-1] = field.reshape(*field.shape[:-1], self.my, self.mx)[..., 1:]
        return moved.reshape(field.shape)


def _good_size(n: int) -> int:
    """Smallest product of 2, 3 and 5 that is at least n: a fast length for the FFT."""
    while True:
        m = n
        for factor in (2, 3, 5):
            while m % factor == 0:
                m //= factor
        if m == 1:
            return n
        n += 1
