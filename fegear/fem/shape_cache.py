"""Solved tooth shapes on disk: the same shape is never solved twice, across processes and runs.

Used only inside `fegear.store.keeping_shapes`. The key holds all that the solution depends on, the source of this
package and of the geometry among it, so that a changed program never reads what an older one made.
"""

from __future__ import annotations

import contextlib
import dataclasses
from typing import TYPE_CHECKING

from fegear.fem.influence import Influence
from fegear.fem.mesh import SectorMesh
from fegear.fem.root_stress import FilletStrain
from fegear.fem.trace import LoadedFlank
from fegear.plain import code_version, content_key, pack, unpack
from fegear.store import shape_keeper

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.geometry.tooth import Tooth

_KINDS: dict[str, Callable[..., object]] = {
    kind.__name__: kind for kind in (Influence, SectorMesh, LoadedFlank, FilletStrain)
}


def kept_or_solved(tooth: Tooth, what: tuple[object, ...], solve: Callable[[], Influence]) -> Influence:
    """Read a solution from the store in use, or solve and keep it; just solve if none is in use.

    Parameters
    ----------
    tooth : Tooth
    what : tuple
        All else that the solution depends on; anything that `content_key` takes.
    solve : callable
    """
    keeper = shape_keeper()
    if keeper is None:
        return solve()
    key = content_key(code_version("fem", "geometry"), tooth, what)
    with keeper.store.claim(key):
        known = _restored(keeper.store.read(key), tooth)
        if known is not None:
            keeper.count(0, 1, sum(known.seconds.values()))
            return known
        found = solve()
        with contextlib.suppress(OSError):  # a full disk or a read-only folder costs the next run time, nothing else
            keeper.store.write(key, pack(_plain(found)))
    keeper.count(1, 0, 0.0)
    return found


def _plain(item: object) -> object:
    """Dataclasses as dictionaries with their name; the tooth is left out, for the reader knows it."""
    if dataclasses.is_dataclass(item) and type(item).__name__ in _KINDS:
        fields = {f.name: _plain(getattr(item, f.name)) for f in dataclasses.fields(item) if f.name != "tooth"}
        return {"kind": type(item).__name__, "fields": fields}
    if isinstance(item, dict):
        return {key: _plain(value) for key, value in item.items()}
    return item


def _restored(data: bytes | None, tooth: Tooth) -> Influence | None:
    """Rebuild a solution; None if there is none or it does not fit."""
    if data is None:
        return None

    def build(item: object) -> object:
        if not isinstance(item, dict):
            return item
        if set(item) == {"kind", "fields"}:
            kind = _KINDS[item["kind"]]
            given = {"tooth": tooth} if kind is Influence else {}
            return kind(**given, **{key: build(value) for key, value in item["fields"].items()})
        return {key: build(value) for key, value in item.items()}

    try:
        known = build(unpack(data))
    except (ValueError, KeyError, TypeError):
        return None
    return known if isinstance(known, Influence) else None
