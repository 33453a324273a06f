"""What gauges at rest and in motion say alike: whose trace it is, how the place counts, what a trace has besides."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.engine.sheet.sheet import Remark

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen

#: What a trace has besides its curve, in the order in which it is said.
_BESIDES = ("drifts", "runout", "unsteady", "hum", "steps", "without")


def subject(seen: Seen) -> str:
    """Whose trace it is."""
    second = seen.asked.gauge.second
    return f"Gauge {seen.name} less {second}" if second else f"Gauge {seen.name}"


def by_placement(seen: Seen, peak: str) -> list[str]:
    """How the peak, by its name, changes with the place of the grid."""
    said = seen.data.planned(seen.name).by_placement
    return [f"Gauge {seen.name}: displaced within its tolerance the {peak} changes by {said}."] if said else []


def title_of_all(seen: Seen, strain: str) -> str:
    """What the table of all gauges has: before there are traces no measured strain."""
    which = strain.capitalize() if seen.data.compared is None else f"Measured and {strain}"
    return f"{which} strain of all gauges"


def trace_remarks(start: str) -> tuple[Remark, ...]:
    """What a trace has besides its curve, and what is left out of it, each where there is any."""
    return tuple(Remark(f"{start}: {{d.{one}}}.", when=one) for one in _BESIDES)
