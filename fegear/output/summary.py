"""``summary.json``: single values with their errors, settings, seconds, version."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import fegear
from fegear.engine.run import Results
from fegear.engine.value import Value
from fegear.output.tables import _PREFIX


def _finite(number: float | None) -> float | None:
    """JSON knows no infinity; a value that is not finite is written as null."""
    return number if number is not None and math.isfinite(number) else None


def _numbers(values: Iterable[Value]) -> dict[str, dict[str, object]]:
    """Values by their names; where no other number has it now, by the name of before, too, with ``now`` beside it."""
    found: dict[str, dict[str, object]] = {
        value.name: {"value": _finite(value.value), "unit": value.unit, "error": _finite(value.error)}
        for value in values
    }
    before = {_PREFIX.sub(r"\1", name): name for name in found if _PREFIX.match(name)}
    return found | {old: {**found[now], "now": now} for old, now in before.items() if old not in found}


def summary(results: Results, remarks: list[str], files: list[str]) -> dict[str, object]:
    """Collect what the summary holds.

    Parameters
    ----------
    results : Results
    remarks : list of str
    files : list of str
        Names of all files of the run.
    """
    case = results.scene.case
    return {
        "title": case.title,
        "case": results.scene.name,
        "results": _numbers(results.values),
        "inputs": inputs(results.scene.document),
        "settings": {
            "tolerance": case.accuracy.tolerance,
            "effects": list(case.effects.on()),
            "stages": {str(task): dict(outcome.settings) for task, outcome in results.outcomes.items()},
        },
        "timings": {str(task): round(seconds, 6) for task, seconds in results.seconds.items()}
        | {"total": round(sum(results.seconds.values()), 6)},
        "origin": {str(task): timing.origin for task, timing in results.timings.items()},
        "recalled": {
            str(task): {
                "shapes": timing.shapes,
                "seconds_when_computed": round(timing.when_computed + timing.spared, 6),
            }
            for task, timing in results.timings.items()
            if timing.recalled or timing.shapes
        },
        "remarks": remarks,
        "files": files,
        "version": fegear.__version__,
    }


def inputs(document: Mapping[str, object]) -> dict[str, object]:
    """The case as JSON has it; what is no plain value (a quantity of a library) as its text."""
    plain: dict[str, object] = json.loads(json.dumps(document, default=str))
    return plain


def write_summary(path: Path, results: Results, remarks: list[str], files: list[str]) -> None:
    """Write the summary as JSON."""
    write_json(path, summary(results, remarks, files))


def write_json(path: Path, content: Mapping[str, object]) -> None:
    """Write a JSON file that people can read."""
    path.write_text(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n", "utf-8")
