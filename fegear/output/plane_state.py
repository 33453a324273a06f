"""Which plane state the 2D teeth of a run are in, for its headlines: it changes stiffness by several per cent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.built.members import gear_name
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.run import Results

#: Stages of 2D gears, and of pairs of them.
_GEARS, _PAIRS = ("gear-solution", "atlas-gear"), ("loaded-pair", "odd-pair")


def plane_state(results: Results) -> str:
    """The plane states of the gears that were taken as plane ones, ``plane strain``; empty where none was."""
    states = {name: results.scene.gears[name].plane_assumption for name in dict.fromkeys(_plane_gears(results))}
    if len(set(states.values())) <= 1:
        return "".join(f"plane {state}" for state in set(states.values()))
    return ", ".join(
        f"plane {state} ({', '.join(name for name, its in states.items() if its == state)})"
        for state in dict.fromkeys(states.values())
    )


def _plane_gears(results: Results) -> Iterator[str]:
    for task in results.outcomes:
        if task.stage in _GEARS:
            yield task.subject
        elif task.stage in _PAIRS:
            yield from (gear_name(results.scene, task.subject, member) for member in MEMBERS)
