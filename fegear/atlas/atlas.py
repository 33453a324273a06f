"""An atlas: rows of solved gears over the regions of a family, and what it answers about any gear among them."""

from __future__ import annotations

import json
import os
import zipfile
import zlib
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.atlas.atlas_gear import AtlasGear
from fegear.atlas.domain import KEYS, ROUND_OFF, Domain, Nodes
from fegear.atlas.family import Family, place_of
from fegear.atlas.interpolation import contracted, left_out, truncation, weights
from fegear.atlas.tables import VERSION, Layout
from fegear.base.arrays import ReadOnlyArrays
from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.fem.plane.settings import MeshSettings

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.atlas.family import Place
    from fegear.base.arrays import Array
    from fegear.contact.plane.fe_compliance import FiniteElementCompliance
    from fegear.geometry.gear import Gear

#: What rows that an atlas keeps leave out, in proportion to their largest numbers.
KEPT = 1e-6


@dataclass(frozen=True, eq=False)
class Piece(ReadOnlyArrays):
    """One region of an atlas.

    Parameters
    ----------
    domain : Domain
    nodes : Nodes
    parts : ndarray, shape (*nodes, R)
        Parts of the atlas's basis in each solved gear's row.
    errors : ndarray, shape (*nodes, quantities)
        Estimated errors of the solved gears (`tables.errors_of`).
    """

    domain: Domain
    nodes: Nodes
    parts: Array
    errors: Array

    def error_of_nodes(self, at: tuple[float, ...]) -> Array:
        """Largest errors among the solved gears around a place, (quantities,)."""
        around = []
        for nodes, place in zip(self.nodes.coordinates(self.domain), at, strict=True):
            i = int(np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, max(nodes.size - 2, 0)))
            around.append(np.arange(i, min(i + 2, nodes.size)))
        return np.asarray(self.errors[np.ix_(*around)].reshape(-1, self.errors.shape[-1]).max(axis=0))


@dataclass(frozen=True, eq=False)
class Atlas(ReadOnlyArrays):
    """Compliance and root stress of a family of gears.

    Parameters
    ----------
    family : Family
    pieces : tuple of Piece
    basis : ndarray, shape (R, numbers of a row)
    reach : int
        K: neighbours -K..K are known.
    settings : MeshSettings
        With which its gears were solved.
    version : str
        Of fegear that made it.
    """

    family: Family
    pieces: tuple[Piece, ...]
    basis: Array
    reach: int
    settings: MeshSettings
    version: str

    @cached_property
    def layout(self) -> Layout:
        """Of its rows."""
        return Layout(self.reach)

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
        piece = self._piece(place)
        at = tuple(piece.domain.coordinates(self.family, place).tolist())
        nodes = piece.nodes.coordinates(piece.domain)
        factors = [weights(one, where) for one, where in zip(nodes, at, strict=True)]
        row = contracted(piece.parts, factors) @ self.basis
        errors = piece.error_of_nodes(at) + self._left_out(piece, nodes, at, row) + KEPT
        return AtlasGear(gear, self.layout, row, dict(zip(self.layout.quantities, errors.tolist(), strict=True)))

    def compliance(self, gear: Gear) -> FiniteElementCompliance:
        """The same as a source of compliance and root stress, which contact takes as it takes one of a solved gear."""
        return finite_element_compliance(self.gear(gear))

    def _left_out(self, piece: Piece, nodes: tuple[Array, ...], at: tuple[float, ...], row: Array) -> Array:
        """Estimated error of the interpolation, none at solved gears, (quantities,)."""
        total = np.zeros(len(self.layout.quantities))
        if all(np.any(one == where) for one, where in zip(nodes, at, strict=True)):
            return total
        for last in left_out(piece.parts, nodes, at):
            total += truncation([self.layout.differences(row, one @ self.basis) for one in last])
        return total

    def _piece(self, place: Place) -> Piece:
        """The region that holds a gear, on its side of the undercut line."""
        below = place.shift < self.family.least_shift(place.teeth) - ROUND_OFF
        side = "undercut" if below else "whole"
        nearest: tuple[int, tuple[float, float]] | None = None
        for piece in self.pieces:
            if piece.domain.side != side:
                continue
            outside = piece.domain.outside(self.family, place)
            if outside is None:
                return piece
            if nearest is None or outside[0] > nearest[0]:
                nearest = outside
        if nearest is None:
            what = "has undercut" if side == "undercut" else "has no undercut"
            raise RangeError("profile_shift", f"{place.shift:.6g}", f"{what}, unlike the gears of this atlas", _REMEDY)
        number, (low, high) = nearest
        raise RangeError(
            KEYS[number], f"{place[number]:.6g}", f"is outside the atlas, {low:.6g} to {high:.6g}", _REMEDY
        )

    def save(self, path: Path) -> None:
        """Write it as one file (.npz), whole or not at all."""
        head = {
            "kind": _KIND, "rows": VERSION, "version": self.version, "reach": self.reach,
            "family": asdict(self.family), "settings": asdict(self.settings),
            "pieces": [{"domain": asdict(one.domain), "teeth": one.nodes.teeth} for one in self.pieces],
        }  # fmt: skip
        arrays = {"head": np.array(json.dumps(head)), "basis": self.basis.astype(np.float32)}
        for number, one in enumerate(self.pieces):
            arrays[f"parts_{number}"], arrays[f"errors_{number}"] = one.parts, one.errors.astype(np.float32)
            for axis, places in enumerate(one.nodes.others):
                arrays[f"nodes_{number}_{axis}"] = places
        beside = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            with beside.open("wb") as file:
                np.savez_compressed(file, **arrays)  # type: ignore[arg-type]
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


_KIND = "fegear atlas"
_REMEDY = "solve the gear"


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
            basis = file["basis"].astype(float)
    except (ValueError, KeyError, TypeError, EOFError, OSError, zipfile.BadZipFile, zlib.error) as problem:
        if isinstance(problem, FileNotFoundError):
            raise
        raise InputError("atlas", path.name, "is not an atlas of fegear", "build it again") from problem
    family, settings = Family(**head["family"]), MeshSettings(**head["settings"])
    return Atlas(family, pieces, basis, head["reach"], settings, head["version"])


def _piece_of(file: np.lib.npyio.NpzFile, number: int, head: dict[str, Any]) -> Piece:
    ends: dict[str, Any] = {key: tuple(one) if isinstance(one, list) else one for key, one in head["domain"].items()}
    first, second, third = (file[f"nodes_{number}_{axis}"] for axis in range(3))
    nodes = Nodes(tuple(head["teeth"]), (first, second, third))
    return Piece(Domain(**ends), nodes, file[f"parts_{number}"], file[f"errors_{number}"].astype(float))


def compressed(rows: Array, layout: Layout) -> tuple[Array, Array]:
    """Rows as few common ones: parts, shape (N, R), and the basis, shape (R, numbers of a row).

    Compliances count in proportion to the largest of their kind, and so do stresses; the basis is of single precision.
    """
    scale = np.empty(rows.shape[1])
    kinds = [layout.own(scale)] + [layout.neighbour(scale, k) for k in range(1, layout.reach + 1)]
    sizes = [np.abs(layout.own(rows)).max()] * len(kinds)
    for kernel in layout.kernels:
        kinds.append(layout.stress(scale, kernel))
        sizes.append(np.abs(layout.stress(rows, (0, kernel[1]))).max())
    for kind, size in zip(kinds, sizes, strict=True):
        kind[...] = size
    parts, values, basis = np.linalg.svd(rows / scale, full_matrices=False)
    # What is left out of a row in all is no more than the root of the squares that are dropped.
    dropped = np.sqrt(np.cumsum(values[::-1] ** 2)[::-1])
    count = max(1, int(np.sum(dropped > 0.3 * KEPT)))
    kept = (basis[:count] * scale).astype(np.float32).astype(float)
    # Rounded, it is no longer orthogonal: the parts are those that fit the rows best.
    exact = np.linalg.lstsq((kept / scale).T, (rows / scale).T, rcond=None)[0].T
    del parts
    return np.ascontiguousarray(exact), kept
