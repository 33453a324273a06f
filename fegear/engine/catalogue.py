"""Stages by name: what each is called stands in the catalogue, how it computes in a module that is imported at need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, overload

from fegear.base.errors import InputError
from fegear.engine.stage import Need, Stage

if TYPE_CHECKING:
    from fegear.base.extensions import Group


class Entry(NamedTuple):
    """What a stage is called.

    Attributes
    ----------
    name : str
        Unique; also the first half of its tasks' names.
    home : str
        Module and name of the `Stage` that computes it: ``"pair.load_sharing.LOAD_SHARING"``.
    title : str
        What it does, for the plan and the progress bar.
    results : tuple of str
        Names by which ``results = [...]`` asks for it; empty for stages that only serve others.
    about : str
        What its results say, in a line; empty for stages that only serve others.
    extra : str
        What of `fegear.engine.extras` it needs besides fegear itself; empty for most.
    formerly : str
        Name by which older cases ask for it; empty for most.
    effects : tuple of str
        Effects that change what it computes.
    requires : tuple of Need
        Effects that must be on; a scene that leaves them off is refused with the remedy.
    quantities : tuple of str
        Quantities that a study of cost takes for its results; empty where it knows none.
    internal : bool
        Whether it takes internal gears and pairs; a plan refuses those of other stages.
    asymmetric : bool
        Whether it takes teeth with two different flanks; a plan refuses those of other stages.
    generated : bool
        Whether it needs fillets as a tool generates them; a plan refuses others there.
    table : str
        Table of a case that describes what it is computed for (``encoders.NAME``); empty for gears and pairs.
    """

    name: str
    home: str
    title: str
    results: tuple[str, ...] = ()
    about: str = ""
    extra: str = ""
    formerly: str = ""
    effects: tuple[str, ...] = ()
    requires: tuple[Need, ...] = ()
    quantities: tuple[str, ...] = ()
    internal: bool = False
    asymmetric: bool = False
    generated: bool = False
    table: str = ""


def _entry(stage: Stage) -> Entry:
    return Entry(stage.name, "", stage.title, stage.results, stage.about, stage.extra, effects=stage.effects,
                 requires=stage.requires, internal=stage.internal, asymmetric=stage.asymmetric,
                 generated=stage.generated)  # fmt: skip


class Catalogue(Sequence[Stage]):
    """Stages in order; each is imported when it is first asked for.

    Parameters
    ----------
    entries : iterable of Entry
    package : str
        Where their homes are.
    group : {"results"}, optional
        Entry points by which other distributions add stages; none by default.
    """

    def __init__(self, entries: Iterable[Entry], package: str, group: Group | None = None) -> None:
        self.entries = tuple(entries)
        self._package, self._group = package, group
        self._by_name = {entry.name: entry for entry in self.entries}
        #: What other distributions add and cannot be used, by the names of their results.
        self.broken: Mapping[str, InputError] = MappingProxyType({})
        self._loaded: dict[str, Stage] = {}

    @classmethod
    def of(cls, stages: Sequence[Stage]) -> Catalogue:
        """A catalogue, or one of stages that are at hand."""
        if isinstance(stages, cls):
            return stages
        made = cls(map(_entry, stages), "")
        made._loaded.update({stage.name: stage for stage in stages})
        return made

    @cached_property
    def with_added(self) -> Catalogue:
        """The same with the stages that other distributions add, the results of each called as its entry point."""
        if self._group is None:
            return self
        from fegear.base.extensions import added
        from fegear.engine.added_stage import guarded

        others = added(self._group, Stage, {**self._by_name, **self.by_result(), **self.former()})
        names, broken, stages = {*self._by_name, *others.found}, dict(others.broken), []
        for name, stage in others.found.items():
            try:
                stages.append(guarded(stage, name, others.whose[name], names))
            except InputError as error:
                broken[name] = error
        made = Catalogue((*self.entries, *map(_entry, stages)), self._package)
        made.broken = broken
        made._loaded = {**self._loaded, **{stage.name: stage for stage in stages}}
        return made

    def called(self, name: str) -> Stage:
        """A stage by its name.

        Raises
        ------
        KeyError
            If there is none.
        """
        if name not in self._loaded:
            entry = self._by_name[name]
            module, _, attribute = entry.home.rpartition(".")
            found: Stage = getattr(import_module(f"{self._package}.{module}"), attribute)
            named = replace(
                found, name=name, title=entry.title, results=entry.results, about=entry.about, extra=entry.extra,
                effects=entry.effects, requires=entry.requires, internal=entry.internal,
                asymmetric=entry.asymmetric, generated=entry.generated,
            )  # fmt: skip
            # Of two threads that get here at once, both go on with the same stage.
            self._loaded.setdefault(name, named)
        return self._loaded[name]

    def table_of(self, name: str) -> str:
        """Table of a case that describes what a stage is computed for; empty for gears and pairs.

        Its name, or in brackets what a refusal says of it, where some such tables are not enough.
        """
        return self._by_name[name].table

    def holds(self, stage: Stage) -> bool:
        """Whether it is one of these."""
        return self._loaded.get(stage.name) is stage

    def by_result(self) -> dict[str, list[str]]:
        """Names of the stages that every result asks for."""
        found: dict[str, list[str]] = {}
        for entry in self.entries:
            for result in entry.results:
                found.setdefault(result, []).append(entry.name)
        return found

    def former(self) -> dict[str, str]:
        """Names of results by the names that they had before."""
        return {entry.formerly: entry.results[0] for entry in self.entries if entry.formerly}

    def __len__(self) -> int:
        return len(self.entries)

    def __iter__(self) -> Iterator[Stage]:
        return (self.called(entry.name) for entry in self.entries)

    @overload
    def __getitem__(self, index: int) -> Stage: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Stage, ...]: ...

    def __getitem__(self, index: int | slice) -> Stage | tuple[Stage, ...]:
        if isinstance(index, slice):
            return tuple(self.called(entry.name) for entry in self.entries[index])
        return self.called(self.entries[index].name)
