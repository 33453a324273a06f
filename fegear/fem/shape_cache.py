"""Solved tooth shapes by their content, in memory and on disk: where a cache is handed down, none is solved twice.

The key holds all that the solution depends on, the source of this
package and of the geometry among it, so that a changed program never reads what an older one made.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, TypeVar

from fegear.fem.influence import Influence
from fegear.fem.mesh import SectorMesh
from fegear.fem.root_stress import FilletStrain
from fegear.fem.trace import LoadedFlank
from fegear.plain import code_version, content_key, pack, unpack
from fegear.solution_cache import Codec

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.geometry.tooth import Tooth
    from fegear.solution_cache import SolutionCache

Shape = TypeVar("Shape")

#: What a solved plane shape consists of.
_PLANE: tuple[type, ...] = (Influence, SectorMesh, LoadedFlank, FilletStrain)


def known_or_solved(
    cache: SolutionCache,
    tooth: Tooth,
    what: tuple[object, ...],
    solve: Callable[[], Shape],
    kinds: tuple[type, ...] = _PLANE,
) -> Shape:
    """Recall the solution of a shape, or solve and keep it.

    Parameters
    ----------
    cache : SolutionCache
    tooth : Tooth
    what : tuple
        All else that the solution depends on; anything that `content_key` takes.
    solve : callable
    kinds : tuple of type
        Dataclasses that the solution consists of, its own first; it has the tooth as a field.
    """
    key = content_key(code_version("fem", "geometry"), tooth, what)
    codec: Codec[Shape] = Codec(lambda found: pack(_plain(found, kinds)), lambda data: _restored(data, tooth, kinds))
    return cache.solve(key, solve, codec).value


def _plain(item: object, kinds: tuple[type, ...]) -> object:
    """Dataclasses as dictionaries with their name; without the tooth, which the reader knows."""
    if dataclasses.is_dataclass(item) and isinstance(item, kinds):
        fields = {f.name: _plain(getattr(item, f.name), kinds) for f in dataclasses.fields(item) if f.name != "tooth"}
        return {"kind": type(item).__name__, "fields": fields}
    if isinstance(item, dict):
        return {key: _plain(value, kinds) for key, value in item.items()}
    return item


def _restored(data: bytes | memoryview, tooth: Tooth, kinds: tuple[type, ...]) -> Any:
    """Rebuild a solution; None if the bytes do not fit."""
    names = {kind.__name__: kind for kind in kinds}

    def build(item: object) -> object:
        if not isinstance(item, dict):
            return item
        if set(item) == {"kind", "fields"}:
            kind = names[item["kind"]]
            given = {"tooth": tooth} if kind is kinds[0] else {}
            return kind(**given, **{key: build(value) for key, value in item["fields"].items()})
        return {key: build(value) for key, value in item.items()}

    try:
        known = build(unpack(data))
    except (ValueError, KeyError, TypeError):
        return None
    return known if isinstance(known, kinds[0]) else None
