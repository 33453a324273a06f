"""Results by name: tables, values and figures of a run, in their order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, SupportsIndex, TypeVar, overload

from fegear.base.errors import UnknownNameError, UnknownPlaceError, shown
from fegear.case.nearest import nearest

if TYPE_CHECKING:
    from collections.abc import Iterator


class HasName(Protocol):
    """What can be asked for by its name."""

    @property
    def name(self) -> str:
        """Unique in its run."""


T = TypeVar("T", bound=HasName)
D = TypeVar("D")


class Named(tuple[T, ...]):
    """Things of a run in their order, each also by its name: ``tables[0]``, ``tables["stiffness_a"]``."""

    __slots__ = ()

    @overload
    def __getitem__(self, key: SupportsIndex) -> T: ...
    @overload
    def __getitem__(self, key: str) -> T: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[T, ...]: ...
    def __getitem__(self, key: SupportsIndex | slice | str) -> T | tuple[T, ...]:
        """Return one by its name or place; an unknown name is refused with the nearest."""
        if not isinstance(key, str):
            try:
                return super().__getitem__(key)
            except (IndexError, TypeError):
                rule, remedy = f"is not a position among these {len(self)} results", nearest("", self.keys())
                raise UnknownPlaceError("name", shown(key), rule, remedy) from None
        for one in self:
            if one.name == key:
                return one
        raise UnknownNameError("name", f'"{key}"', "is not among these results", nearest(key, self.keys()))

    def __contains__(self, key: object) -> bool:
        """Whether a name or a thing is among them."""
        return any(one.name == key for one in self) if isinstance(key, str) else super().__contains__(key)

    @overload
    def get(self, name: str) -> T | None: ...
    @overload
    def get(self, name: str, default: D) -> T | D: ...
    def get(self, name: str, default: object = None) -> object:
        """Return one by its name, or the default where there is none."""
        return next((one for one in self if one.name == name), default)

    def keys(self) -> tuple[str, ...]:
        """Names, in order."""
        return tuple(one.name for one in self)

    def items(self) -> Iterator[tuple[str, T]]:
        """Pairs of name and thing, in order."""
        return ((one.name, one) for one in self)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.keys())

    def __repr__(self) -> str:
        """One line for each."""
        return "\n".join(repr(one) for one in self) or "(none)"
