"""What the page makes of the gears in mesh that it is sent: drawn by its own script in a real browser."""

from __future__ import annotations

import importlib.util
import json
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.window.on_gears import gears_in_mesh, on_the_gears, wanted_on_gears

pytestmark = pytest.mark.long

_spec = importlib.util.spec_from_file_location("gears_chromium", Path(__file__).with_name("chromium.py"))
chromium = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(chromium)

CASE = {
    "results": ["load-sharing"],
    "gear": {
        "pinion": {"teeth": 19, "module": "3 mm", "face_width": "10 mm", "profile_shift": 0.3},
        "wheel": {"teeth": 46, "module": "3 mm", "face_width": "10 mm"},
    },
    "pair": {"I": {"driver": "pinion", "driven": "wheel", "load": "3 kN"}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
    "accuracy": {"tolerance": 0.03},
}
PAGE = """<!doctype html><style>main { --driver: #00f; --driven: #f60; --tool: #80f; --ink: #000; }</style>
<main><canvas style="width: 800px; height: 420px"></canvas></main>
<script>const fegearFigure = { theme: () => "light", dark: { addEventListener() {} } };</script>
<script>%s</script><script>const sent = %s;
const deformed = fegearLayers.deformedOf(sent.deformed), stress = fegearLayers.stressOf(sent.stress);
const canvas = document.querySelector("canvas"), view = { wide: 18, tall: 9.5, data: sent.mesh };
const draw = (place, on) => fegearLayers.gears(canvas, view, { place, factor: 20, ...on });
function apart(pair, place, x) { // both flanks at a contact, along the line of action [mm]
  const a = sent.mesh.pressure_angle, at = [x * Math.cos(a), x * Math.sin(a)], layers = { deformed, factor: 1, place };
  const moved = (member) => fegearLayers.contactMoved(sent.mesh, layers, pair, ...at, member);
  const one = moved("driver"), other = moved("driven");
  return (other[0] - one[0]) * Math.cos(a) + (other[1] - one[1]) * Math.sin(a);
}
document.documentElement.dataset.ready = "yes";
function painted() {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 3; i < data.length; i += 4) count += data[i] > 0;
  return count;
}
</script>"""


def test_drawn_flanks_touch_and_every_layer_is_painted(program, tmp_path):
    scene = build_scene(CASE, "case", None)
    shows = [("I", kind) for kind in ("stress", "deformed", "tool")]
    tasks, (tool,) = wanted_on_gears(scene, shows)
    ran = run_plan(scene, make_plan(scene, STAGES, tasks))
    found = {task.stage.partition("-")[0]: on_the_gears(task, ran.outcomes[task].data) for task in tasks}
    script = (resources.files("fegear.window") / "layers.js").read_text("utf-8")
    page = tmp_path / "page.html"
    page.write_text(PAGE % (script, json.dumps({**found, "tool": tool, "mesh": gears_in_mesh(scene, "I")})))
    e = ran.outcomes[Task("loaded-pair", "I")].data.engagement
    with chromium.Browser(program("chromium"), 900, 600) as browser:
        browser.open(page)
        # True to scale the flanks of loaded pairs touch; what is missing is the dents between points of the outline.
        looked = 0
        for place in np.linspace(0.03, 0.97, 12):
            state = e.solve(e.grid([e.pair.x_start + place * e.pair.base_pitch]), [3000.0])
            for row, j in enumerate(state.grid.contacts.number.tolist()):
                x = float(state.grid.contacts.x[row, 0])
                if state.loads[row, 0, 0] > 0.0 and min(x - e.pair.x_start, e.pair.x_end - x) > 0.9e-3:
                    gap = browser.run(f"apart({j}, {place}, {x * 1e3})") * 1e-3
                    assert abs(gap) < 0.03 * state.transmission_error[0, 0]
                    looked += 1
        assert looked > 10
        # Each layer is painted, the colours reach both ends of the scale where the largest stress is.
        assert browser.run("draw(0.4, {}), painted()") == 0
        for layer in ("{ stress }", "{ deformed }", "{ tool: sent.tool }"):
            assert browser.run(f"draw(0.4, {layer}), painted()") > 2000
        assert browser.run("draw(sent.stress.largest.at, { stress, deformed, tool: sent.tool }), painted()") > 10000
        assert [one for one in browser.complaints if "getImageData" not in one] == []


def test_sections_of_a_pair_with_a_width_are_painted(program, tmp_path):
    case = json.loads(json.dumps(CASE))
    case["pair"]["I"]["width"] = "slices"
    scene = build_scene(case | {"load_distribution": {"positions": 6, "panels": 4}}, "case", None)
    (task,), _ = wanted_on_gears(scene, [("I", "stress")])
    stress = on_the_gears(task, run_plan(scene, make_plan(scene, STAGES, [task])).outcomes[task].data)
    light = stress | {"limit": 1e6 * stress["limit"]}  # the same on a scale on which it is nothing
    script = (resources.files("fegear.window") / "layers.js").read_text("utf-8")
    page = tmp_path / "page.html"
    told = {"stress": stress, "light": light, "mesh": gears_in_mesh(scene, "I"), "deformed": {"gears": {}}}
    page.write_text(PAGE % (script, json.dumps(told)))
    with chromium.Browser(program("chromium"), 900, 600) as browser:
        browser.open(page)
        sections = (stress["z"][0], stress["largest"]["z"])
        drawn = {
            (name, z): browser.run(f"draw({stress['largest']['at']}, {{ stress: {of}, z: {z} }}), canvas.toDataURL()")
            for z in sections
            for name, of in (("own", "stress"), ("light", "fegearLayers.stressOf(sent.light)"))
        }
        assert len(set(drawn.values())) == 4  # stress differs along the face, the ring stands in one section
        assert browser.run(f"draw(0.4, {{ stress, z: {sections[1]} }}), painted()") > 2000
        assert [one for one in browser.complaints if "getImageData" not in one] == []


def test_a_tooth_in_space_has_the_involute_that_is_drawn_and_its_contact_lines_run(program, tmp_path):
    document = json.loads(json.dumps(CASE))
    for gear, hand in (("pinion", "right"), ("wheel", "left")):
        document["gear"][gear] |= {"helix_angle": "15 deg", "hand": hand, "normal_module": "3 mm"}
        del document["gear"][gear]["module"]
    document["load_distribution"] = {"positions": 6, "panels": 4}
    document |= {"results": ["load-distribution"]}
    scene = build_scene(document, "case", None)
    task = Task("loaded-flanks", "I")
    data = run_plan(scene, make_plan(scene, STAGES, [task])).outcomes[task].data
    sent = {"mesh": gears_in_mesh(scene, "I"), "pressure": on_the_gears(task, data), "deformed": {"gears": {}},
            "stress": {"fillets": []}}  # fmt: skip
    script = "".join(
        (resources.files("fegear.window") / name).read_text("utf-8") for name in ("layers.js", "flanks.js")
    )
    page = tmp_path / "page.html"
    page.write_text(PAGE % (script, json.dumps(sent)))
    with chromium.Browser(program("chromium"), 900, 600) as browser:
        browser.open(page)
        for member in ("driver", "driven"):
            outline = np.array(browser.run(f"fegearFlanks.solid(sent.mesh, '{member}')"))
            form, tip, _ = sent["pressure"]["ends"][member]
            base, pitch = (1e3 * sent["mesh"][f"{member}_{name}"] for name in ("base", "radius"))
            flank = outline[(outline[:, 0] > form + 0.1) & (outline[:, 0] < tip - 0.1)]

            def angle(radius, base=base):
                return np.sqrt((radius / base) ** 2 - 1.0) - np.arccos(base / radius)

            off = np.abs(flank[:, 1] - (angle(pitch) - angle(flank[:, 0]))) * pitch
            assert np.sum(off < 0.01) >= 4  # the loaded flank [mm]; the other is a tooth thickness away
            assert np.sum(off > 1.0) >= 4

        def drawn(place: float, yaw: float) -> str:
            return browser.run(
                f"fegearFlanks.draw(canvas, sent.mesh, sent.pressure, {place}, {{ yaw: {yaw}, pitch: 0.5 }}),"
                "canvas.toDataURL()"
            )

        assert len({drawn(0.1, 0.5), drawn(0.25, 0.5), drawn(0.1, 0.7)}) == 3
        assert browser.run("painted()") > 20000
        largest = browser.run("fegearFlanks.draw(canvas, sent.mesh, sent.pressure, sent.pressure.roll[2], "
                              "{ yaw: 0.5, pitch: 0.5 })")  # fmt: skip
        assert largest == pytest.approx(max(max(line[4]) for line in sent["pressure"]["positions"][2]))
        assert [one for one in browser.complaints if "getImageData" not in one] == []
