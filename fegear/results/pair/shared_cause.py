"""One cause of several traces: gauges and encoders of a case that the same relief, pitch, torque or filter explains."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.trace_causes import Cause
    from fegear.results.pair.likeliest_flank import LikeliestFlank

#: Standard errors, and parts of a value, within which causes of several traces have one value.
_ALIKE, _CLOSE = 3.0, 0.05
#: Logarithm of a limiting frequency within which filters are one.
_FILTERS = 0.15
#: Kinds of causes that are those of one trace only.
_OF_ONE = ("place", "bridge")


@dataclass(frozen=True)
class NamedCause:
    """What explains the trace of one subject.

    Parameters
    ----------
    kind, name : str
        "gauge" or "encoders", and its name.
    pair : str
    ranked : LikeliestFlank
    tooth : int
        Of a gauge, in meshing order.
    """

    kind: str
    name: str
    pair: str
    ranked: LikeliestFlank
    tooth: int = 0

    @property
    def causes(self) -> dict[tuple[Any, ...], Cause]:
        """Those that are as likely, by what they are of."""
        found: dict[tuple[Any, ...], Cause] = {}
        for one in self.ranked.as_likely:
            of = one.of
            if of.kind == "filter":
                found[("filter", of.called, of.order)] = one
            elif of.kind not in _OF_ONE:
                tooth = self.tooth + of.tooth if of.kind == "pitch" else 0
                found[(of.kind, self.pair, of.of, tooth)] = one
        return found

    def value(self, one: Cause) -> float:
        """To be compared: of filters the logarithm of a time."""
        return one.value - math.log(self.ranked.speed or 1.0) if one.of.kind == "filter" else one.value


@dataclass(frozen=True)
class SharedCause:
    """A cause, and whose traces it explains."""

    cause: Cause
    of: tuple[NamedCause, ...]

    @property
    def said(self) -> str:
        """In a sentence."""
        names: dict[str, list[str]] = {}
        for one in self.of:
            names.setdefault(one.kind, []).append(one.name)
        gauges, encoders = names.get("gauge", []), names.get("encoders", [])
        whose = [f"gauge{'s' if len(gauges) > 1 else ''} {_listed(gauges)}"] if gauges else []
        whose += [f"encoders {_listed(encoders)}"] if encoders else []
        return f"One cause explains {' and '.join(whose)}: {self.of[0].ranked.named(self.cause)}."


def shared_cause(named: Sequence[NamedCause]) -> SharedCause | None:
    """The cause that explains most of the traces, two at least; None for none.

    Parameters
    ----------
    named : sequence of NamedCause
    """
    best: SharedCause | None = None
    for key in dict.fromkeys(key for one in named for key in one.causes):
        having = [one for one in named if key in one.causes]
        found = _together([(one, one.causes[key]) for one in having])
        if found is not None and (best is None or len(found.of) > len(best.of)):
            best = found
    return best


def of_shared_cause(facts: Sequence[Any]) -> str:
    """A sentence on the cause that gauges and encoders have in common; empty for none.

    Parameters
    ----------
    facts : sequence
        What results add to it: a `NamedCause`, or what has one as `cause`.
    """
    causes = [one if isinstance(one, NamedCause) else getattr(one, "cause", None) for one in facts]
    found = shared_cause([one for one in causes if isinstance(one, NamedCause)])
    return "" if found is None else found.said


def _together(having: Sequence[tuple[NamedCause, Cause]]) -> SharedCause | None:
    """Those whose values are about that of the most certain one, with their mean."""
    if not having:
        return None
    first, certain = min(having, key=lambda one: one[1].error)
    about = first.value(certain)

    def close(whose: NamedCause, one: Cause) -> bool:
        error = math.hypot(one.error, certain.error)
        most = _FILTERS if one.of.kind == "filter" else _CLOSE * abs(about)
        return abs(whose.value(one) - about) <= max(_ALIKE * error, most)

    alike = [(whose, one) for whose, one in having if close(whose, one)]
    if len(alike) < 2:
        return None
    weights = [1.0 / max(one.error, 1e-3 * abs(one.value), 1e-12) ** 2 for _, one in alike]
    mean = float(np.average([whose.value(one) for whose, one in alike], weights=weights))
    error = min(one.error for _, one in alike)
    whose, one = alike[0]  # in whose words it is said
    return SharedCause(
        replace(one, value=one.value + mean - whose.value(one), error=error), tuple(whose for whose, _ in alike)
    )  # fmt: skip


def _listed(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else "".join(names)
