"""Plans predict what they predicted: seconds and settings of every task of every case."""

import copy
import importlib.util
import json
from pathlib import Path

_SPEC = importlib.util.spec_from_file_location("plans", Path(__file__).with_name("plans.py"))
plans = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(plans)


def test_plans_predict_what_they_did():
    kept = json.loads(plans.KEPT.read_text("utf-8"))
    assert plans.differences(kept, plans.planned()) == []
    changed = copy.deepcopy(kept)
    case = next(iter(changed))
    task = next(task for task, (seconds, *_) in changed[case].items() if seconds)
    changed[case][task][0] *= 1.001
    assert len(plans.differences(kept, changed)) == 1
    del changed[case][task]
    assert plans.differences(kept, changed) == [f"{case}: {task} {kept[case][task]} -> None"]
