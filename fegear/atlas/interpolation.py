"""An atlas: tables of a family's gears as polynomials over its regions, and what it answers about any gear in them."""

from __future__ import annotations

import json
import os
import zipfile
import zlib
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fegear.atlas.atlas_gear import AtlasGear
from fegear.atlas.common_rows import KEPT, CommonRows
from fegear.atlas.domain import KEYS, Domain
from fegear.atlas.family import REMEDY, Family, place_of
from fegear.atlas.finer import Finer, kept
from fegear.atlas.polynomials import products
from fegear.atlas.tables import VERSION, Layout
from fegear.base.arrays import ReadOnlyArrays
from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.fem.plane.settings import MeshSettings

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.atlas.family import Place
    from fegear.base.arrays import Array, Index
    from fegear.contact.plane.fe_compliance import FiniteElementCompliance
    from fegear.geometry.gear import Gear

#: Solved gears about a place of which the largest error counts there.
_NEAREST = 16


@dataclass(frozen=True, eq=False)
class Piece(ReadOnlyArrays):
    """One region of an atlas.

    Parameters
    ----------
    domain : Domain
    degrees : ndarray of int, shape (M, 4)
        Of the products of Chebyshev polynomials.
    coefficients : ndarray, shape (M, R)
        Of the parts of the common rows.
    solved : ndarray, shape (4, N)
        Coordinates of the gears that were solved.
    errors : ndarray, shape (N, quantities)
        By how much the fit without each of them misses it, and the estimated error of its solution.
    finer : Finer, optional
        Compliances by more products than the parts have.
    """

    domain: Domain
    degrees: Index
    coefficients: Array
    solved: Array
    errors: Array
    finer: Finer | None = None

    def parts(self, at: Array) -> Array:
        """Of the common rows, at coordinates of shape (4, G), shape (G, R)."""
        return products(self.degrees, at) @ self.coefficients

    def error(self, at: Array) -> Array:
        """Largest errors among the solved gears around places, shape (G, quantities)."""
        apart = ((at[:, :, None] - self.solved[:, None, :]) ** 2).sum(axis=0)
        most = min(_NEAREST, apart.shape[1]) - 1
        nearest = np.argpartition(apart, most, axis=1)[:, : most + 1]
        return np.asarray(self.errors[nearest].max(axis=1))


class Tables(NamedTuple):
    """What an atlas knows of many gears.

    Attributes
    ----------
    rows : ndarray, shape (G, numbers)
        Their dimensionless tables, all or the first numbers of them; NaN of gears that it does not hold.
    errors : ndarray, shape (G, quantities)
        Estimated, as `Layout.quantities`; infinite of those.
    """

    rows: Array
    errors: Array


@dataclass(frozen=True, eq=False)
class Atlas:
    """Compliance and root stress of a family of gears.

    Parameters
    ----------
    family : Family
    pieces : tuple of Piece
    common : CommonRows
    reach : int
        K: neighbours -K..K are known.
    settings : MeshSettings
        With which its gears were solved.
    tolerance : float
        Relative error that its polynomials were made for.
    version : str
        Of fegear that made it.
    """

    family: Family
    pieces: tuple[Piece, ...]
    common: CommonRows
    reach: int
    settings: MeshSettings
    tolerance: float
    version: str

    @cached_property
    def layout(self) -> Layout:
        """Of its rows."""
        return Layout(self.reach)

    @property
    def domains(self) -> tuple[Domain, ...]:
        """Its regions."""
        return tuple(piece.domain for piece in self.pieces)

    @property
    def gears(self) -> int:
        """How many were solved."""
        return sum(piece.solved.shape[1] for piece in self.pieces)

    def gear(self, gear: Gear) -> AtlasGear:
        """What the atlas answers about a gear, with its error.

        Raises
        ------
        RangeError
            If the gear is of another family, or outside every region: between the undercut line and a region that
            begins beyond it, for example.
        """
        self.family.check(gear)
        place = place_of(gear)
        self._refuse_outside(place)
        found = self.tables(np.array(place, dtype=float)[:, None])
        errors = dict(zip(self.layout.quantities, found.errors[0].tolist(), strict=True))
        return AtlasGear(gear, self.layout, found.rows[0], errors)

    def holds(self, gear: Gear) -> bool:
        """Whether it answers about a gear."""
        try:
            self.family.check(gear)
            self._refuse_outside(place_of(gear))
        except RangeError:
            return False
        return True

    def compliance(self, gear: Gear) -> FiniteElementCompliance:
        """The same as a source of compliance and root stress, which contact takes as it takes one of a solved gear."""
        return finite_element_compliance(self.gear(gear))

    def tables(self, places: Array, *, stress: bool = True) -> Tables:
        """Tables of many gears of the family.

        Parameters
        ----------
        places : ndarray, shape (4, G)
            As `Place`.
        stress : bool
            Whether stresses are wanted, the most of each row.
        """
        count = places.shape[1]
        piece_of, layout = self.pieces_of(places), self.layout
        common = self.common.rows if stress else self.common.rows[:, : layout.compliances]
        rows = np.full((count, common.shape[1]), np.nan)
        errors = np.full((count, len(layout.quantities)), np.inf)
        for number, piece in enumerate(self.pieces):
            here = np.flatnonzero(piece_of == number)
            if not here.size:
                continue
            at = piece.domain.coordinates(self.family, places[:, here])
            row = piece.parts(at) @ common
            if piece.finer is not None:
                row[:, : layout.compliances] = piece.finer.compliances(at)
            layout.turned(row, self.family.turning(places[:, here]))
            rows[here], errors[here] = row, piece.error(at) + KEPT
        return Tables(rows, errors)

    def ends(self, places: Array) -> Array:
        """Roll length where the flank begins and length of a fillet [modules], shape (G, 2)."""
        found, piece_of = np.full((places.shape[1], 2), np.nan), self.pieces_of(places)
        for number, piece in enumerate(self.pieces):
            here = np.flatnonzero(piece_of == number)
            if here.size:
                at = piece.domain.coordinates(self.family, places[:, here])
                found[here] = piece.parts(at) @ self.layout.ends(self.common.rows)
        return found

    def pieces_of(self, places: Array) -> NDArray[np.int64]:
        """Number of the region that holds each gear, -1 where none does, shape (G,)."""
        found = np.full(places.shape[1], -1)
        below = self.family.undercut(places)
        for number, piece in reversed(list(enumerate(self.pieces))):
            side = below == (piece.domain.side == "undercut")
            found[side & piece.domain.holds(self.family, places)] = number
        return found

    def _refuse_outside(self, place: Place) -> None:
        """Refuse a gear that no region holds on its side of the undercut line, by the nearest region."""
        at = np.array(place, dtype=float)[:, None]
        if self.pieces_of(at)[0] >= 0:
            return
        side = "undercut" if self.family.undercut(at)[0] else "whole"
        outside = [piece.domain.outside(self.family, place) for piece in self.pieces if piece.domain.side == side]
        nearest = max((one for one in outside if one is not None), key=lambda one: one[0], default=None)
        if nearest is None:
            what = "has undercut" if side == "undercut" else "has no undercut"
            raise RangeError("profile_shift", f"{place.shift:.6g}", f"{what}, unlike the gears of this atlas", REMEDY)
        number, (low, high) = nearest
        if number == 0:  # beyond all regions of its side
            ends = [piece.domain.teeth for piece in self.pieces if piece.domain.side == side]
            low, high = min(ends)[0], max(one[1] for one in ends)
        raise RangeError(
            KEYS[number],
            _WRITTEN.get(KEYS[number], "{:.6g}").format(place[number]),
            f"is outside the range of the atlas, {low:.6g} to {high:.6g}",
            REMEDY,
        )

    def save(self, path: Path) -> None:
        """Write it as one file (.npz), whole or not at all."""
        head = {
            "kind": _KIND, "rows": VERSION, "version": self.version, "reach": self.reach, "tolerance": self.tolerance,
            "family": asdict(self.family), "settings": asdict(self.settings),
            "pieces": [asdict(one.domain) for one in self.pieces],
        }  # fmt: skip
        finer = [one.finer for one in self.pieces if one.finer is not None]
        arrays = {"head": np.array(json.dumps(head)), **self.common.kept(self.layout), **kept(finer)}
        for number, one in enumerate(self.pieces):
            arrays[f"degrees_{number}"] = one.degrees.astype(np.uint8)
            for name, values in (("coefficients", one.coefficients), ("solved", one.solved), ("errors", one.errors)):
                arrays[f"{name}_{number}"] = values.astype(np.float32)
        beside = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            with beside.open("wb") as file:
                np.savez_compressed(file, **arrays)  # type: ignore[arg-type]  # names of arrays
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


_KIND = "fegear atlas"
#: How a gear's place is written where it is not the number of its key.
_WRITTEN = {
    "tip_diameter": "tip circle {:.6g} modules above its shifted pitch circle",
    "bore_radius": "{:.6g} root radii",
}


def load_atlas(path: Path) -> Atlas:
    """Read an atlas.

    Raises
    ------
    InputError
        If the file is not an atlas, or one whose rows mean something else than those of this fegear.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            head = json.loads(str(file["head"]))
            if head["kind"] != _KIND or head["rows"] != VERSION:
                raise InputError(
                    "atlas", path.name, f'has rows of kind {head["rows"]} (fegear {head["version"]}), not {VERSION}',
                    "build it again",
                )  # fmt: skip
            pieces = tuple(_piece_of(file, number, one) for number, one in enumerate(head["pieces"]))
            common = CommonRows.of(file, Layout(head["reach"]))
    except (ValueError, KeyError, TypeError, EOFError, OSError, zipfile.BadZipFile, zlib.error) as problem:
        if isinstance(problem, FileNotFoundError):
            raise
        raise InputError("atlas", path.name, "is not an atlas of fegear", "build it again") from problem
    family, settings = Family(**head["family"]), MeshSettings(**head["settings"])
    return Atlas(family, pieces, common, head["reach"], settings, head["tolerance"], head["version"])


def _piece_of(file: np.lib.npyio.NpzFile, number: int, head: dict[str, Any]) -> Piece:
    ends: dict[str, Any] = {key: tuple(one) if isinstance(one, list) else one for key, one in head.items()}
    coefficients, solved, errors = (
        file[f"{name}_{number}"].astype(float) for name in ("coefficients", "solved", "errors")
    )
    finer = None
    if f"finer_parts_{number}" in file:
        parts, common = file[f"finer_parts_{number}"].astype(float), file["finer"].astype(float)
        finer = Finer(file[f"finer_degrees_{number}"].astype(int), parts @ common)
    return Piece(Domain(**ends), file[f"degrees_{number}"].astype(int), coefficients, solved, errors, finer)
