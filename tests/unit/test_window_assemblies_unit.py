"""Planetary sets and gearboxes as the page draws them: what is sent, and that it is where the mechanics has it."""

from __future__ import annotations

import base64
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.results.shafts.drawn_gearbox import drawn_gearbox, motions
from fegear.window.assemblies import assemblies_of, on_the_assembly
from fegear.window.glance import glance_tasks

TEXT = """title = "a set and a stage"
results = ["planet-load-sharing", "shaft-deflection"]
[gear.sun]
teeth = 25
module = "2 mm"
face_width = "25 mm"
[gear.planet]
teeth = 29
module = "2 mm"
face_width = "25 mm"
[planetary.P]
sun = "sun"
planet = "planet"
ring_teeth = 83
planets = 4
torque = "320 N*m"
stiffness = { sun_mesh = "400 N/um", ring_mesh = "480 N/um", pin = "250 N/um" }
pin_errors = { tangential = ["20 um", "0 um", "-10 um", "0 um"] }
[pair.I]
driver = "sun"
driven = "planet"
load = "2 kN"
centre_distance = "54 mm"
[shaft.in]
sections = [{ length = "80 mm", outer = "30 mm" }, { length = "40 mm", outer = "24 mm", inner = "10 mm" }]
gears = [{ gear = "sun", at = "40 mm" }]
bearings = [{ bearing = "one", at = "10 mm" }, { bearing = "one", at = "110 mm" }]
coupling = "0 mm"
[shaft.out]
axis = ["0 mm", "54 mm"]
start = "-5 mm"
sections = [{ length = "120 mm", outer = "30 mm" }]
gears = [{ gear = "planet", at = "45 mm" }]
bearings = [{ bearing = "one", at = "10 mm" }, { bearing = "one", at = "110 mm" }]
coupling = "120 mm"
[bearing.one]
radial = "300 N/um"
fixed = true
"""


@pytest.fixture(scope="module")
def found():
    scene = build_scene(tomllib.loads(TEXT), "both", Path())
    tasks = {task.stage: task for task in glance_tasks(scene, ())}
    wanted = [tasks[name] for name in ("planet-load-sharing", "shaft-deflection")]
    results = run_plan(scene, make_plan(scene, STAGES, wanted))
    return scene, {task.stage: (task, results.outcomes[task].data) for task in wanted}


def unpacked(sent) -> np.ndarray:
    return sent["step"] * np.frombuffer(base64.b64decode(sent["data"]), dtype="<i2").reshape(sent["shape"])


def test_what_is_sent_is_plain_and_small(found):
    scene, _ = found
    sent = assemblies_of(scene)
    assert len(json.dumps(sent)) < 40_000
    assert list(sent["sets"]) == ["P"]
    assert sent["sets"]["P"]["gears"]["ring"]["tooth"] == [[], []]  # the ring is no gear of the case
    assert sent["gearbox"]["drivers"] == ["sun"]


def test_loads_of_the_planets_are_those_of_the_result(found):
    scene, known = found
    task, data = known["planet-load-sharing"]
    sent = on_the_assembly(task, data, scene)
    assert (sent["pair"], sent["kind"]) == ("set P", "loads")
    order = np.argsort(data.s)
    force = unpacked(sent["force"])
    assert np.allclose(force, data.mesh_force[:, :, order], atol=1e-4 * sent["largest"])
    assert np.ptp(data.shares) > 0.1  # pins stand unevenly
    assert sent["shares"] == pytest.approx(data.shares, abs=1e-6)


def test_bodies_stand_where_the_shafts_are_and_move_as_they_bend(found):
    scene, known = found
    task, data = known["shaft-deflection"]
    box = drawn_gearbox(scene)
    assert box.places == {"in": (0.0, 0.0, 0.0), "out": (0.0, 0.054, -0.005)}
    assert box.meshes["I"] == pytest.approx((0.0, 0.025, 0.04))
    kinds = [body.kind for body in box.bodies]
    assert kinds == ["shaft", "bearing", "bearing", "gear"] * 2
    first, gear = box.bodies[0], box.bodies[3]
    assert (first.z[-1], first.outer[-1], first.inner[-1]) == pytest.approx((0.12, 0.012, 0.005))
    assert gear.outer[0] == scene.gears["sun"].tip_radius
    moved = motions(data, box)
    line = data.nominal.bent[0].line
    assert moved[0][:, 0] == pytest.approx(np.interp(first.z, line.z, line.x), abs=1e-8)
    assert np.all(moved[3][0] == moved[3][1])  # a gear is drawn rigid
    sent = on_the_assembly(task, data, scene)
    assert sent["largest"] == pytest.approx(1e6 * max(np.linalg.norm(one[:, :3], axis=1).max() for one in moved))
    assert 0.02 < sent["factor"] * sent["largest"] * 1e-6 / box.size < 0.0601
    assert unpacked(sent["moved"][0]) == pytest.approx(1e3 * moved[0], abs=2e-4 * np.abs(1e3 * moved[0]).max())


def test_what_cannot_be_assembled_is_not_drawn():
    document = tomllib.loads(TEXT)
    document["planetary"]["P"] |= {"planets": 5, "pin_errors": {}}
    document["shaft"]["out"]["axis"] = ["0 mm", "60 mm"]
    scene = build_scene(document, "apart", Path())
    assert assemblies_of(scene) == {"sets": {}, "gearbox": None, "racks": {}}
    assert on_the_assembly(Task("geometry"), None, scene) is None
