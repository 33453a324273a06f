"""A REXS model as it stands in the file: components with attributes, relations between them, load cases.

Source: the public attribute and relation lists of REXS 1.0 to 1.7 (FVA, repositories rexs-api-java and REXSapi).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

#: Most components of a model, far more than a gearbox has.
MOST_COMPONENTS = 5_000

Plain = str | float | bool


@dataclass(frozen=True, slots=True)
class Attribute:
    """What a component says of one property.

    Parameters
    ----------
    name : str
    unit : str
        As written; empty or ``none`` for numbers without one.
    value : str, float, bool or tuple of them
        Numbers of XML files are texts still.
    """

    name: str
    unit: str
    value: Plain | tuple[Plain, ...]


@dataclass(frozen=True)
class Component:
    """One part: a shaft, a gear, a stage.

    Parameters
    ----------
    id : int
    type : str
        ``cylindrical_gear`` and so on.
    name : str
    attributes : mapping
        By their names.
    """

    id: int
    type: str
    name: str
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    @property
    def said(self) -> str:
        """How messages name it."""
        return f"{self.type} {self.id}"


@dataclass(frozen=True)
class Relation:
    """How components belong together: ``(role, id)`` of each."""

    id: int
    type: str
    order: int
    refs: tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class LoadCase:
    """Attributes that components have under one load, by the components' numbers."""

    id: int
    attributes: Mapping[int, Mapping[str, Attribute]]


@dataclass(frozen=True)
class Model:
    """A whole file."""

    version: str
    program: str
    components: Mapping[int, Component]
    relations: tuple[Relation, ...]
    load_cases: tuple[LoadCase, ...] = ()

    def of(self, *types: str) -> list[Component]:
        """Components of these types, in the order of their numbers."""
        return sorted((one for one in self.components.values() if one.type in types), key=lambda one: one.id)

    @cached_property
    def _by_role(self) -> dict[tuple[str, int], list[Relation]]:
        found: dict[tuple[str, int], list[Relation]] = {}
        for relation in self.relations:
            for role, number in relation.refs:
                found.setdefault((role, number), []).append(relation)
        return found

    def linked(self, component: Component, role: str, kind: str, other: str) -> Iterator[Component]:
        """Components that relations of a kind link to one, by role; ordered relations in their order.

        Parameters
        ----------
        component : Component
        role : str
            That it has itself.
        kind : str
            Type of the relations, or what it ends with (``reference`` is ``ordered_reference``, too).
        other : str
            Role of those that are wanted.
        """
        relations = [one for one in self._by_role.get((role, component.id), ()) if one.type.endswith(kind)]
        for relation in sorted(relations, key=lambda one: one.order):
            for there, number in relation.refs:
                if there == other and number != component.id:
                    yield self.components[number]
