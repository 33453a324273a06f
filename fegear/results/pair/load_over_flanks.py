"""What is shown of a load distributed over flanks: stations, load over the face and over the plane of action."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.engine.figure.family import few

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.contact.wide.lines import ContactLines
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.contact.wide.loaded_pair import LoadedWidePair

#: Points of the maps along the line of action and along the face.
_ACROSS, _ALONG = 121, 81
#: Roll positions that are drawn, and where the scale of colours ends: this share of the places bears less.
_DRAWN, _TOP = 4, 99.7


@dataclass(frozen=True)
class Stations:
    """Every station of every contact line under one load, arrays of shape (N,)."""

    found: LoadedFlanks
    case: int

    def at(self, values: NDArray[Any]) -> NDArray[Any]:
        """What is known at the roll positions (P, 1) or at all stations (P, M), where there is one."""
        on = self.found.lines.present
        return np.asarray(np.broadcast_to(values, on.shape)[on])

    def of_lines(self, key: str) -> Array:
        """What the contact lines know of them."""
        values = getattr(self.found.lines, key)
        return self.at(values[:, None] if values.ndim == 1 else values)

    @property
    @shows("", "number of the mesh position")
    def position(self) -> Array:
        """From 1."""
        return self.at(np.arange(1, self.found.lines.roll.size + 1)[:, None])

    @property
    def line_load(self) -> Array:
        """[N/m]."""
        return self.at(self.found.line_load[:, :, self.case])

    @property
    def pressure(self) -> Array:
        """[Pa]."""
        return self.at(self.found.pressure[:, :, self.case])

    @property
    @shows("um", "contact half-width")
    def half_width(self) -> Array:
        """[m]."""
        return self.at(self.found.known.half_width(self.found.line_load)[:, :, self.case])

    @property
    @shows("", "1: flanks in contact")
    def active(self) -> Array:
        """As a number."""
        return (self.line_load > 0.0).astype(float)


@dataclass(frozen=True)
class FaceAtRoll:
    """Load over the face at one roll position."""

    roll: float = shown("mm", "mesh position")
    z: Array = shown("mm", "along the face, from its middle")
    load: Array = shown("N/mm", "load per face width")


@dataclass(frozen=True)
class LoadOverFace:
    """Load of all contact lines together over the cells of the face, under one load and all of them."""

    found: LoadedFlanks
    case: int

    @property
    @shows("mm", "middle of the cell, along the face")
    def z(self) -> Array:
        """Middles of the cells [m]."""
        return np.asarray(0.5 * (self.found.cells[1:] + self.found.cells[:-1]))

    @property
    def least(self) -> Array:
        """Of all roll positions [N/m]."""
        return np.asarray(self.found.over_face[:, :, self.case].min(axis=0))

    @property
    def largest(self) -> Array:
        """Of all roll positions [N/m]."""
        return np.asarray(self.found.over_face[:, :, self.case].max(axis=0))

    @property
    @shows("N/mm", "load over face width")
    def even(self) -> float:
        """[N/m]."""
        return float(self.found.load[self.case] / (self.found.cells[-1] - self.found.cells[0]))

    @property
    @shows("", "mean_line_load / load per face width")
    def factor(self) -> Array:
        """Of every cell."""
        return np.asarray(self.found.mean_over_face[:, self.case] / self.even)

    @property
    @shows("", "line load / mean")
    def relative(self) -> Array:
        """Under every load, shape (cells, L)."""
        return np.asarray(
            self.found.mean_over_face / (self.found.load / (self.found.lines.high - self.found.lines.low))
        )

    @property
    @shows("", "even load")
    def one(self) -> float:
        """What `relative` would be of load spread evenly."""
        return 1.0

    @property
    def face_load_factor(self) -> float:
        """K_Hbeta."""
        return float(self.found.face_load_factor[self.case])

    @cached_property
    def at_rolls(self) -> list[FaceAtRoll]:
        """At the roll positions that are drawn."""
        whole, roll = self.found.over_face[:, :, self.case], self.found.lines.roll
        return [FaceAtRoll(float(roll[p]), self.z, whole[p]) for p in few(len(whole), (), _DRAWN)]


@dataclass(frozen=True)
class PairShare:
    """Share of one tooth pair at every roll position."""

    number: int
    error: Array
    share: Array = shown("", "share of the load on pair")


@dataclass(frozen=True)
class OverRoll:
    """Shares and transmission error at every roll position, at the nominal load."""

    pair: LoadedWidePair

    @property
    def te_error(self) -> Array:
        """Estimated [m]."""
        return np.asarray(self.pair.error.transmission_error[:, self.pair.at])

    @property
    @shows("um", "transmission error of rigid flanks (limit for zero load)", name="te_unloaded")
    def unloaded(self) -> Array:
        """[m]."""
        return self.pair.unloaded

    @property
    @shows("N/um", "tangent stiffness of the contact points")
    def mesh_stiffness(self) -> Array:
        """[N/m]."""
        return np.asarray(self.pair.found.contact.stiffness[:, self.pair.at])

    @property
    def shares(self) -> list[PairShare]:
        """Of all pairs that are ever in reach."""
        found, error, i = self.pair.found, self.pair.error.share, self.pair.at
        return [
            PairShare(int(j), off[:, i], share[:, i])
            for j, share, off in zip(found.pair_numbers.tolist(), found.share, error, strict=True)
        ]


@dataclass(frozen=True)
class DrawnLine:
    """One contact line in the plane of action."""

    x: Array = shown("mm", "along the line of action")
    z: Array = shown("mm", "along the face")


@dataclass(frozen=True)
class PlaneOfAction:
    """Line load over the plane of action, and some contact lines in it."""

    lines: ContactLines
    rolls: tuple[int, ...]
    x: Array = shown("mm", "along the line of action")
    z: Array = shown("mm", "along the face")
    load: Array = shown("N/mm", "line load")

    @property
    @shows("N/mm", "where the scale of colours ends")
    def top(self) -> float:
        """[N/m]."""
        return float(np.nanpercentile(self.load, _TOP))

    @property
    def count(self) -> int:
        """Of the roll positions that are drawn."""
        return len(self.rolls)

    @property
    def drawn(self) -> list[DrawnLine]:
        """Contact lines at the roll positions that are drawn."""
        at = [(p, s) for p in self.rolls for s in self.lines.at(p)]
        return [DrawnLine(self.lines.x[p, s], self.lines.z[p, s]) for p, s in at]


@dataclass(frozen=True)
class LoadOverFlanks:
    """A pair with a width under its loads, as it is shown at the nominal one."""

    pair: LoadedWidePair

    @property
    def stations(self) -> Stations:
        """Of the roll positions that the case asks for."""
        return Stations(self.pair.found, self.pair.at)

    @cached_property
    def over_face(self) -> LoadOverFace:
        """Over the face, of as many roll positions as the whole base pitch needs."""
        return LoadOverFace(self.pair.over.found, self.pair.at)

    @property
    def over_roll(self) -> OverRoll:
        """At the roll positions that the case asks for."""
        return OverRoll(self.pair)

    @property
    def cells(self) -> int:
        """Into how many the face is divided."""
        return int(self.pair.found.cells.size - 1)

    @property
    def equilibrium(self) -> float:
        """Largest sum of forces less load, over load."""
        return float(self.pair.found.equilibrium.max())

    @cached_property
    def plane(self) -> PlaneOfAction:
        """Line load as the contact line moves through the plane of action."""
        found = self.pair.over.found
        pair, lines = found.pair, found.lines
        x = np.linspace(pair.x_start, pair.x_end, _ACROSS)
        z = np.linspace(lines.low, lines.high, _ALONG)
        start, pitch = float(lines.roll[0]), pair.base_pitch
        drawn = {int(np.abs(lines.roll - start - (k + 0.5) * pitch / _DRAWN).argmin()) for k in range(_DRAWN)}
        return PlaneOfAction(lines, tuple(sorted(drawn)), x, z, found.over_plane(x, z, self.pair.at))
