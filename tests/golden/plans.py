"""What plans predict, kept in ``plans.json``: seconds, settings and inputs of every task of every case.

    python tests/golden/plans.py [--accept]

The cases of ``cases/`` with their own results. A forecast is a handful of measured numbers: a wrong one changes nothing
but what is promised.
"""

import argparse
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
sys.path.insert(0, str(Path(__file__).parent))


def of_plan(scene, plan):
    """Seconds, settings and inputs by task; both as a sum in which every number has a weight of its own."""
    import numpy as np
    from changed_cases import of_asked

    from fegear.engine.plan_in_words import forecast_seconds

    kept = {}
    for step, seconds in zip(plan.steps, forecast_seconds(scene, plan), strict=True):
        settings = step.stage.forecast(scene, step.task.subject).settings
        numbers = np.array([float(one) for one in settings.values() if isinstance(one, (int, float))])
        weights = np.cos(1.0 + 2.399963 * np.arange(numbers.size))
        size = float(weights @ numbers) if numbers.size else 0.0
        kept[str(step.task)] = [None if seconds is None else float(f"{seconds:.6g}"), float(f"{size:.6g}") + 0.0,
                                *of_asked(step.inputs(scene))]  # fmt: skip
    return kept


def planned():
    """Everything that is kept, as it is now."""
    from fegear.case.reading import read_scene
    from fegear.engine.plan import make_plan
    from fegear.results.catalogue import STAGES

    kept = {}
    for path in sorted((ROOT / "cases").glob("*.toml")):
        scene = read_scene(path)
        kept[path.stem] = of_plan(scene, make_plan(scene, STAGES))
    return kept


def differences(old, new):
    """Tasks whose forecast differs, is lost or is new."""
    said = []
    for case in {**old, **new}:
        before, after = old.get(case, {}), new.get(case, {})
        said += [
            f"{case}: {task} {before.get(task)} -> {after.get(task)}"
            for task in {**before, **after}
            if not _same(before.get(task), after.get(task))
        ]
    return said


def _same(one, other):
    if one is None or other is None:
        return False
    return all(
        a == b or (a is not None and b is not None and abs(a - b) <= 1e-4 * max(abs(a), abs(b)))
        for a, b in zip(one, other, strict=True)
    )


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    new = planned()
    if wishes.parse_args().accept:
        cases = []
        for name in sorted(new):
            lines = [f"  {json.dumps(task)}: {json.dumps(one)}" for task, one in new[name].items()]
            cases.append(f" {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n }")
        KEPT.write_text("{\n" + ",\n".join(cases) + "\n}\n", encoding="utf-8")
    else:
        print(*differences(json.loads(KEPT.read_text("utf-8")), new), sep="\n")


if __name__ == "__main__":
    main()
