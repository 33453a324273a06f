"""Half bridges over both fillets of a tooth: the trace is the difference of two computed strains."""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

FIT = ["offset", "scale", "shift"]
_CACHE = SolutionCache()


def case(measured=None, second=None, **more):
    gear = {"module": "2 mm", "face_width": "10 mm"}
    gauge = {"gear": "a", "grid_length": "0.3 mm"}
    return {
        "results": ["gauge"],
        "gear": {"a": {"teeth": 20, "profile_shift": 0.1, **gear}, "b": {"teeth": 31, **gear}},
        "pair": {"p": {"driver": "a", "driven": "b", "torques": ["8 N*m", "16 N*m"]}},
        "gauge": {
            "t": gauge if measured is None else gauge | {"measured": measured},
            "c": {**gauge, "fillet": "compression", "diameter": "36.2 mm", **(second or {})},
        },
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
        "accuracy": {"tolerance": 1e-2},
        **more,
    }  # fmt: skip


def ran(document, folder=Path(), stage="gauge"):
    scene = build_scene(document, "case", folder)
    results = run_plan(scene, make_plan(scene, STAGES), cache=_CACHE)
    return results, {str(task).split()[-1]: one.data for task, one in results.outcomes.items() if task.stage == stage}


def written(folder, angle, strain, head="strain [um/m]", *, noise=3.0, offset=25.0, start=40.0):
    """Two turns of which the zero of the angle is elsewhere."""
    turns = np.arange(0.0, 720.0, 0.5)
    place = np.mod(np.radians(turns - start) + math.pi, 2.0 * math.pi) - math.pi
    strain = 1e6 * np.interp(place, angle, strain, left=0.0, right=0.0) + offset
    strain += np.random.default_rng(5).normal(0.0, noise, turns.size)
    scale = {"strain [um/m]": 1.0, "strain [mV/V]": 2.05 / 4.0 * 1e-3}[head]
    rows = "".join(f"{a:.2f},{s:.8g}\n" for a, s in zip(turns, strain * scale, strict=True))
    (folder / "t.csv").write_text(f"angle [deg],{head}\n{rows}")


@pytest.fixture(scope="module")
def strains():
    """Of both gauges at the nominal load over the rotation of the first, with the second placed elsewhere."""
    _, found = ran(case())
    first, second = found["t"].history, found["c"].history
    return first.angle, first.strain[:, 1] - np.interp(first.angle, second.angle, second.strain[:, 1])


@pytest.mark.parametrize(
    ("head", "shown", "more"),
    [
        ("strain [um/m]", 1.0, {}),
        ("strain [um/m]", 0.5, {"active_arms": 2}),  # as amplifiers show a half bridge
        ("strain [mV/V]", 1.0, {"gauge_factor": 2.05}),
        ("strain [mV/V]", 2.0, {"gauge_factor": 2.05, "active_arms": 4}),
    ],
)
def test_a_measured_difference_is_recovered(head, shown, more, strains, tmp_path):
    written(tmp_path, strains[0], 0.99 * shown * strains[1], head, noise=3.0 * shown, offset=25.0 * shown)
    results, found = ran(case({"file": "t.csv", "fit": FIT, "bridge": "c", **more}), tmp_path)
    data = found["t"]
    assert data.compared.scale == pytest.approx(0.99, abs=1e-3)
    assert data.compared.offset == pytest.approx(25e-6, abs=1e-6)
    assert math.degrees(data.compared.shift) == pytest.approx(40.0, abs=0.05)
    assert data.compared.likeness > 0.9995
    assert data.judged.startswith("measured strain agrees with the computed one: ")
    assert data.bridge_peak == pytest.approx(np.abs(strains[1]).max(), rel=1e-6)
    assert any(one.startswith("Gauge t less c: measured strain agrees") for one in results.answer.sentences)


def test_its_limits_are_those_of_two_grids_and_its_error_that_of_two_strains(strains, tmp_path):
    written(tmp_path, *strains)
    found = ran(case({"file": "t.csv", "fit": FIT, "bridge": "c"}), tmp_path)[1]
    first, second = (found[one].history for one in "tc")
    limits = found["t"]._computed(found["t"].compared).limits(0.0)
    peaks = [float(np.abs(one.strain[:, 1]).max()) for one in (first, second)]
    each = [np.ptp(np.abs(one.peak_of_places(1))) / sum(peaks) for one in (first, second)]
    assert limits.lower + limits.upper == pytest.approx(math.hypot(*each), rel=0.2)
    error = limits.model * found["t"].bridge_peak
    assert error == pytest.approx(sum(float(one.strain_error[one.peak_position(1), 1]) for one in (first, second)),
                                  rel=0.05)  # fmt: skip


def test_a_bridge_that_is_not_one_is_told(strains, tmp_path):
    measured = {"file": "t.csv", "fit": FIT, "bridge": "c"}
    written(tmp_path, strains[0], 0.5 * strains[1])
    halved = ran(case(measured), tmp_path)[1]["t"].judged
    assert "computed at 8 N m, or as of a strain that the amplifier divided by two active arms" in halved
    written(tmp_path, strains[0], -strains[1])
    turned = ran(case(measured), tmp_path)[1]["t"].judged
    assert "fits with its sign reversed" in turned
    assert "check which of both gauges is subtracted (c, by bridge)" in turned


@pytest.mark.parametrize(
    ("measured", "second", "rule"),
    [
        ({"bridge": "d"}, {}, 'gauge.t.measured.bridge = "d": is not a gauge of this case'),
        ({"bridge": "t"}, {}, "is the gauge itself; name the gauge in the other fillet"),
        ({"bridge": "c"}, {"gear": "b", "diameter": "60 mm"}, "is on another gear; name a gauge on the same tooth"),
        ({"bridge": "c"}, {"tooth": 3}, "is on another tooth"),
        ({"bridge": "c"}, {"measured": {"file": "t.csv", "bridge": "t"}}, "has a bridge itself"),
        ({"bridge": "c", "gauge_factor": 2.0, "active_arms": 1.3, "strain": "mV/V"}, {}, "is fewer than the gauges of"),
    ],
)  # fmt: skip
def test_refusals(measured, second, rule, tmp_path):
    head = "strain" if "strain" in measured else "strain [um/m]"
    (tmp_path / "t.csv").write_text(f"angle [deg],{head}\n" + "".join(f"{a},{a % 7}\n" for a in range(60)))

    def planned():
        scene = build_scene(case({"file": "t.csv", **measured}, second), "case", tmp_path)
        make_plan(scene, STAGES)

    with pytest.raises(InputError) as refused:
        planned()
    assert rule in str(refused.value)


@pytest.mark.dear
def test_a_half_bridge_in_motion(strains, tmp_path):
    train = {
        "body": {"one": {"inertia": "2e-4 kg*m^2"}, "two": {"inertia": "9e-4 kg*m^2"}},
        "mesh": {"p": {"driver": "one", "driven": "two", "damping_ratio": 0.08}},
        "torque": {"one": "16 N*m"}, "balance": "two",
    }  # fmt: skip
    more = {"results": ["dynamic-strain"], "train": train, "dynamics": {"speed": "0.01 rpm", "harmonics": 256}}
    more["effects"] = {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True}
    plain = ran(case(**more), stage="dynamic-strain")[1]
    first, second = plain["t"].found, plain["c"].found
    written(tmp_path, first.angle, 1.01 * (first.total - np.interp(first.x, second.x, second.total)))
    results, found = ran(case({"file": "t.csv", "fit": FIT, "bridge": "c"}, **more), tmp_path, "dynamic-strain")
    data = found["t"]
    assert data.compared.scale == pytest.approx(1.01, abs=2e-3)
    assert data.bridge_peak == pytest.approx(np.abs(strains[1]).max(), rel=0.04)  # without contact of the tip edges
    assert any(one.startswith("Gauge t less c, in motion: measured strain agrees") for one in results.answer.sentences)
    assert data._computed(data.compared).limits(0.0).upper > 0.0
    table = results.outcomes[next(one for one in results.outcomes if str(one) == "dynamic-strain of t")]
    (row,) = table.answer.overviews
    assert row.name == "dynamic_gauges"
    assert row.column("torque").values.tolist() == pytest.approx([16.0])
    assert row.column("scale").values.tolist() == pytest.approx([1.01], abs=2e-3)
    assert table.answer.fact.agrees
