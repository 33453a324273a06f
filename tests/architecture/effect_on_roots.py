"""Add an effect on root stress in two files, `fegear/base/effects.py` and where loads are superposed, and run cases."""

import importlib
import importlib.util
import sys
from pathlib import Path

import numpy as np

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
ROW = """
DOUBLED = Effect(
    "doubled_roots", "Root stress twice as large.", "root stress of the teeth", "plane (2D) teeth", "roots",
    {"doubled roots": "one row of root stress"}, lambda _pair: False, _CALCULIX, wide=False, usual=False,
)


def _counts("""


def changed(name, *pairs):
    """Import a module with parts of its source replaced."""
    path = HOUSE.joinpath(*name.split(".")[1:]).with_suffix(".py")
    source = path.read_text("utf-8")
    for old, new in pairs:
        assert source.count(old) == 1, old
        source = source.replace(old, new)
    module = importlib.util.module_from_spec(importlib.util.spec_from_file_location(name, path))
    home, _, own = name.rpartition(".")
    sys.modules[name] = module
    setattr(importlib.import_module(home), own, module)
    exec(compile(source, str(path), "exec"), module.__dict__)  # noqa: S102  (fegear's own source)


DOC = '"""Which effects change root stress and nothing else."""'
FIELD = f"{DOC}\n\n    doubled_roots: bool = _counts(DOUBLED)"
PLAIN = "return None if stress is None else np.ascontiguousarray(stress.T)"
ACTS = """from fegear.base.tally import note

        if self.effects.doubled_roots:
            note("doubled roots")
        return None if stress is None else (1.0 + self.effects.doubled_roots) * stress.T"""

changed("fegear.base.effects", ("\ndef _counts(", ROW), (DOC, FIELD))
changed("fegear.contact.plane.root_stress", (PLAIN, ACTS))

from fegear.base.solution_cache import SolutionCache  # noqa: E402  (after what it stands on was changed)
from fegear.case.reading import build_scene  # noqa: E402
from fegear.contact.pair_spec import PairSpec  # noqa: E402
from fegear.engine.plan import make_plan  # noqa: E402
from fegear.engine.run import run_plan  # noqa: E402
from fegear.results.catalogue import STAGES  # noqa: E402
from fegear.studies.effects import felt_by  # noqa: E402

PAIR = {
    "gear": {
        "a": {"teeth": 24, "module": "2 mm", "profile_shift": 0.2, "face_width": "10 mm"},
        "b": {"teeth": 36, "module": "2 mm", "face_width": "10 mm"},
    },
    "pair": {"p": {"driver": "a", "driven": "b", "torque": "30 N*m"}},
    "accuracy": {"tolerance": 0.2},
}  # fmt: skip
MOVING = {
    **PAIR,
    "results": ["tooth-force", "dynamic-strain", "dynamic-root-stress"],
    "train": {
        "body": {"one": {"inertia": "2e-4 kg*m^2"}, "two": {"inertia": "9e-4 kg*m^2"}},
        "mesh": {"p": {"driver": "one", "driven": "two", "damping_ratio": 0.08}},
        "torque": {"one": "30 N*m"}, "balance": "two",
    },
    "dynamics": {"speed": "1000 rpm", "harmonics": 16},
    "gauge": {"t": {"gear": "a", "grid_length": "0.3 mm"}},
    "effects": {"neighbour_coupling": True},
}  # fmt: skip
AT_REST = {**PAIR, "results": ["load-sharing", "root-stress-history", "gauge"], "gauge": MOVING["gauge"]}
DRAWN = {
    **PAIR, "results": ["robustness"], "robustness": {"draws": 20},
    "gear": {key: {**gear, "tolerance_class": 6} for key, gear in PAIR["gear"].items()},
}  # fmt: skip
DESIGNED = {
    **PAIR, "results": ["relief"], "design": {"peak": "least-stress", "inner_slope": 0.9, "grind": [],
                                                 "allowable": {"root_tension": "100 MPa", "hertz_pressure": "2 GPa"}},
    "gear": {key: {"teeth": teeth, "module": "3 mm", "face_width": "20 mm",
                   "rack": {"addendum": 1.25, "dedendum": 1.5, "tip_radius": 0.2}}
             for key, teeth in (("a", 30), ("b", 36))},
}  # fmt: skip
CACHE = SolutionCache()


def ran(document, **effects):
    document = {**document, "effects": {**document.get("effects", {}), **effects}}
    scene = build_scene(document, "case", Path())
    outcomes = run_plan(scene, make_plan(scene, STAGES), cache=CACHE).outcomes
    return {value.name: value.si for one in outcomes.values() for value in one.values}, outcomes, scene


def of_roots(name):
    """Whether a value is a root stress or a strain, and no ratio or place of it."""
    key = name.rpartition(".")[2]
    words = ("root_tension", "root_compression", "root_stress", "peak_stress", "strain", "change_by_placement")
    return any(word in key for word in words) and not key.endswith(("ratio", "angle", "places"))


assert not PairSpec.__dataclass_fields__["doubled_roots"].default  # what the row says for Python
seen = set()
for case in (AT_REST, MOVING, DRAWN, DESIGNED):
    (plain, outcomes, scene), (double, _, _) = ran(case), ran(case, doubled_roots=True)
    assert plain.keys() == double.keys()
    for name, value in plain.items():
        factor = 2.0 if of_roots(name) else 1.0
        assert np.isclose(double[name], factor * value, rtol=1e-9, equal_nan=True), (name, value, double[name])
        seen |= {name} if of_roots(name) else set()
    notes = [note for one in outcomes.values() for note in one.remarks]
    assert any("doubled_roots is off; including it changes the maximum root stress" in note for note in notes) == (
        case is AT_REST
    ), notes
    told = felt_by([scene])["doubled_roots"]
    assert told == set(case["results"]) - {"load-sharing", "tooth-force"}, told
assert len(seen) > 20, sorted(seen)
idle = build_scene({**PAIR, "results": ["load-sharing"], "effects": {"doubled_roots": True}}, "case", Path())
assert "effects.doubled_roots has no influence on the requested results" in " ".join(make_plan(idle, STAGES).remarks)
