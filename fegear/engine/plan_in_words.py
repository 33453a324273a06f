"""A plan in words, for ``fegear plan``: what runs and why, with which settings, for how long, and what does not run."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence

from fegear.case.reading import Scene
from fegear.engine.own_speed import OwnSpeed
from fegear.engine.plan import Plan
from fegear.engine.stage import Forecast


def forecast_seconds(scene: Scene, plan: Plan) -> list[float | None]:
    """Predicted seconds of each step [s], a gear shape counted where it is solved first; None where it is unknown."""
    return _seconds(_forecasts(scene, plan))


def _forecasts(scene: Scene, plan: Plan) -> list[Forecast]:
    return [step.stage.forecast(scene, step.task.subject) for step in plan.steps]


def _seconds(forecasts: Sequence[Forecast]) -> list[float | None]:
    solved: set[object] = set()
    found: list[float | None] = []
    for ahead in forecasts:
        anew = sum(seconds for key, seconds in ahead.shapes.items() if key not in solved)
        solved |= set(ahead.shapes)
        found.append(None if ahead.seconds is None else ahead.seconds + anew)
    return found


def plan_lines(scene: Scene, plan: Plan, speed: OwnSpeed | None = None) -> list[str]:
    """Lines for the terminal; seconds of a machine whose speed is known, else of a reference machine."""
    speed = speed or OwnSpeed()
    forecasts = _forecasts(scene, plan)
    lines, seconds = ["Computed:"], speed.scaled(plan, _seconds(forecasts))
    for number, (step, ahead, predicted) in enumerate(zip(plan.steps, forecasts, seconds, strict=True), start=1):
        effects = f"; effects: {', '.join(step.effects)}" if step.effects else ""
        lines.append(f"  {number}. {step.task}: {'; '.join(step.reasons)}{effects}")
        if ahead.settings:
            lines.append("     settings: " + ", ".join(f"{key} = {_short(v)}" for key, v in ahead.settings.items()))
        lines.append("     CPU time unknown" if predicted is None else f"     about {predicted:.2g} s")
    if plan.skipped:
        lines.append("Not computed:")
        lines += _folded(plan.skipped)
    unknown = [str(step.task) for step, predicted in zip(plan.steps, seconds, strict=True) if predicted is None]
    without = f", excluding {', '.join(unknown)} (CPU time unknown)" if unknown else ""
    total = sum(predicted or 0.0 for predicted in seconds)
    by = f"by {speed.count} tasks of earlier runs on this machine" if speed.count else "on a reference machine"
    lines.append(
        f"Estimated CPU time: about {total:.2g} s {by}{without}, plus some seconds for tables, figures and report."
    )
    return lines + [f"Note: {remark}" for remark in plan.remarks]


def _folded(skipped: Sequence[tuple[str, str]]) -> list[str]:
    """Stages that are not computed, those of one reason together: fifty lines would push the plan out of sight."""
    groups: dict[str, list[str]] = {}
    for name, reason in skipped:
        groups.setdefault(reason.partition(" (")[0], []).append(name)
    found = []
    for reason, names in groups.items():
        found += textwrap.wrap(
            f"{reason}: {', '.join(names)}",
            118,
            initial_indent="  - ",
            subsequent_indent="    ",
            break_on_hyphens=False,
        )
    return found


def plan_content(scene: Scene, plan: Plan, speed: OwnSpeed | None = None) -> dict[str, object]:
    """The same as plain mappings and lists, for programs; ``seconds`` is None where the run time is unknown."""
    forecasts = _forecasts(scene, plan)
    seconds = (speed or OwnSpeed()).scaled(plan, _seconds(forecasts))
    return {
        "case": scene.name,
        "steps": [
            {
                "task": str(step.task),
                "reasons": list(step.reasons),
                "effects": list(step.effects),
                "settings": dict(ahead.settings),
                "seconds": predicted,
            }
            for step, ahead, predicted in zip(plan.steps, forecasts, seconds, strict=True)
        ],
        "skipped": [{"stage": name, "reason": reason} for name, reason in plan.skipped],
        "remarks": list(plan.remarks),
    }


def _short(value: object) -> str:
    """A setting as people read it: mappings and lists within brackets, without quotes."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return f"({', '.join(f'{key} {_short(one)}' for key, one in value.items())})"
    if isinstance(value, list | tuple | set | frozenset):
        return ", ".join(_short(one) for one in value) or "none"
    return str(value)
