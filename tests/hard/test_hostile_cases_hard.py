"""Case files that mean harm or were mistyped: a clear refusal or finite numbers, never a traceback or a NaN."""

import copy
import math
import os
import signal
import subprocess
import sys
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import FegearError, InputError
from fegear.case.reading import apply_override, build_scene, read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
PAIR = tomllib.loads(
    """
results = ["geometry", "load-sharing", "transmission-error"]
[gear.a]
teeth = 20
module = "3 mm"
profile_shift = 0.2
face_width = "20 mm"
[gear.b]
teeth = 33
module = "3 mm"
face_width = "20 mm"
tip_radius_rounding = "0.1 mm"
relief = { tip = { amount = "12 um", normalised_length = 0.9 } }
[pair.I]
driver = "a"
driven = "b"
load = "1615 N"
compliance = { source = "weber-banaschek" }
[effects]
hertz = "load-dependent"
relief = true
"""
)


def leaves(table, path=()):
    for key, value in table.items():
        if isinstance(value, dict):
            yield from leaves(value, (*path, key))
        elif key not in ("results", "title"):
            yield (*path, key), value


PLACES = list(leaves(PAIR))


@st.composite
def wrong(draw, value):
    """The value scaled by anything, of another kind, or of another dimension."""
    factor = draw(st.sampled_from([0.0, -1.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 1e3, 1e6, 1e12, 1e200]))
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return draw(st.one_of(st.integers(-3, 2000), st.sampled_from([10**9, 10**18, 10**400])))
    if isinstance(value, float):
        return draw(st.sampled_from([value * factor, math.nan, math.inf, 1e-300]))
    number, _, unit = value.partition(" ")
    if not unit:
        return draw(st.sampled_from([value, "", "nonsense"]))
    return draw(st.sampled_from([f"{float(number) * factor!r} {unit}", f"{number} parsec", number, f"nan {unit}"]))


@given(st.data())
def test_any_case_gives_finite_numbers_or_one_sentence(data):
    document = copy.deepcopy(PAIR)
    for _ in range(data.draw(st.integers(1, 3))):
        path, value = data.draw(st.sampled_from(PLACES))
        table = document
        for step in path[:-1]:
            table = table[step]
        table[path[-1]] = data.draw(wrong(value))
    document["effects"]["corner_contact"] = data.draw(st.booleans())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            scene = build_scene(document, "case", Path())
            results = run_plan(scene, make_plan(scene, STAGES))
        except FegearError as refused:
            text = str(refused)
            assert 20 < len(text) < 700
            assert "Traceback" not in text
            return
    for table in results.tables:
        for column in table.columns:
            values = np.asarray(column.values)
            if values.dtype.kind == "f":
                assert np.isfinite(values).all(), (table.name, column.name)
    for value in results.values:
        assert not isinstance(value.value, float) or math.isfinite(value.value), value.name


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["gear.a.bore_radius=1e-9 mm"], "too close to the centre"),
        (["gear.a.bore_radius=26.849 mm"], "too close to the root circle"),
        (["gear.a.material.poisson_ratio=0.49999"], "at most 0.4999"),
        (["gear.a.material.poisson_ratio=0.7"], "inside"),
        (["gear.a.module=1e200 mm"], "in SI units, outside the plausible range; check the unit"),
        (["gear.a.profile_shift=1e200"], "is outside the plausible range"),
        (["gear.a.teeth=5", "gear.a.profile_shift=-0.75"], "undercut"),
        (["gear.a.tip_radius_rounding=2 mm"], r"is too large for the tip; use at most 1\.5864 mm"),
        (["gear.a.tip_chamfer=3 mm"], r"is too large for the tip; use at most 2\.2533 mm"),
        (["gear.a.tip_diameter=90 mm"], "choose a tip diameter below 69.93"),
    ],
)
def test_refusals_name_key_and_remedy_in_the_units_of_the_case(overrides, words):
    document = copy.deepcopy(PAIR) | {"results": ["stiffness"]}
    document["stiffness"] = {"gear": "a", "positions": 3}
    for override in overrides:
        apply_override(document, override)

    def run():
        scene = build_scene(document, "case", Path())
        return run_plan(scene, make_plan(scene, STAGES))

    with pytest.raises(FegearError, match=words) as refused:
        run()
    assert str(refused.value).startswith("gear.a.")
    assert "modules" not in str(refused.value) or "neck" in str(refused.value)


SLOPES, EXCITED, FOLLOWED = (
    "sources/mark_fig08",
    "sources/blankenship_singh_forces",
    "sources/blankenship_singh_helical",
)
LINES, FRICTION, FACE = "sources/litvin_fig01", "sources/lin_huston_coy_fig5b", "spur_over_the_face"
EXCITATION, FOLLOW = "transmissibility.I.excitation", "transmissibility.I.follow"
OF_MESH, UNITY = "transmissibility.I.mesh", "transmissibility.I.unity_ratio"


@pytest.mark.parametrize(
    ("case", "override", "key", "words"),
    [
        ("sources/mark_fig12", "loading.length=1e9 mm", "loading.length", "contact ratio; use at most 100"),
        (SLOPES, "loading.contact_ratio=1e9", "loading.contact_ratio", "use at most 100"),
        (SLOPES, "loading.contact_ratio=0.5", "loading.contact_ratio", "choose at least 1"),
        (SLOPES, "loading.slopes=[nan]", r"loading.slopes[0]", "must be finite"),
        (SLOPES, "loading.peaks=[]", "loading.peaks", "must not be empty"),
        (SLOPES, "loading={}", "loading.contact_ratio", "is required without a pair"),
        ("sources/mark_series", "transmission_error.terms=201", "transmission_error.terms", "equal to 200"),
        ("sources/mark_series", "transmission_error={terms=4}", "transmission_error.terms", "mark-series"),
        ("sources/mark_fig22", "pair.I.root_stress={source=5}", "pair.I.root_stress.source", "quotes or a list"),
        ("sources/mark_fig22", "pair.I.root_stress={source=[]}", "pair.I.root_stress.source", "must not be empty"),
        ("sources/mark_fig22", "dynamics.speed=0 rpm", "dynamics.speed", "greater than zero"),
        (EXCITED, f"{EXCITATION}.speeds=[]", f"{EXCITATION}.speeds", "must not be empty"),
        (EXCITED, f"{EXCITATION}.transmission_error={{}}", f"{EXCITATION}.transmission_error.pair",
            "specify pair, file or amplitude"),
        (
            EXCITED, f"{EXCITATION}.external=[{{on='driver', order=1, frequency='5 Hz', y='1 N'}}]",
            f"{EXCITATION}.external[0].frequency", "contradicts order",
        ),
        (EXCITED, f"{OF_MESH}.base_helix_angle=90 deg", f"{OF_MESH}.base_helix_angle",
            "must be between -90 and 90 deg"),
        (EXCITED, f"{UNITY}.aspect_ratio=0", f"{UNITY}.aspect_ratio", "greater"),
        (EXCITED, f"{UNITY}.alpha_z=-1", f"{UNITY}.alpha_z", "greater than or equal to 0"),
        (FOLLOWED, f"{FOLLOW}={{}}", FOLLOW, "must have at least one parameter"),
        (
            FOLLOWED, f"{FOLLOW}.base_helix_angle={{start='5 deg', stop='5 deg'}}",
            f"{FOLLOW}.base_helix_angle.stop", "= 5 deg",
        ),
        (
            FOLLOWED, f"{FOLLOW}.base_helix_angle={{start='0 deg', stop='90 deg', count=3}}",
            f"{FOLLOW}.base_helix_angle", "= 90 deg",
        ),
        (FOLLOWED, f"{FOLLOW}.mu={{start=-3, stop=1, count=3}}", f"{FOLLOW}.mu", "at least kappa"),
        (FRICTION, "dynamics.friction={law='constant'}", "dynamics.friction.coefficient", 'is required by law = "'),
        (
            FRICTION, "dynamics.friction={law='benedict-kelley', viscosity='1 N'}",
            "dynamics.friction.viscosity", "not a viscosity",
        ),
        (
            "sources/lin_townsend_oswald_fig4", "design.chart={amounts_over_delta=[0], lengths=[1]}",
            "design.chart", "greater than 0",
        ),
        (
            "lin_design_chart", "dynamics.chart={amounts=[1], lengths=[1], mesh='Z'}",
            "dynamics.chart.mesh", "known here: I",
        ),
        (
            "lin_design_chart", f"dynamics.chart={{amounts={[1.0] * 400}, lengths={[1.0] * 400}}}",
            "dynamics.chart", "160,000",
        ),
        (LINES, "gear.pinion.helix_angle=89 deg", "gear.pinion.helix_angle", "between 0 and 60 deg"),
        (LINES, "gear.pinion.helix_angle=0 deg", "gear.pinion.hand", "contradicts the helix angle"),
        (LINES, "gear.pinion.hand=right", "pair.I.hand", "opposite hands"),
        (LINES, "gear.pinion.bore_radius=300 mm", "gear.pinion.bore_radius", "root radius"),
        (LINES, "gear.pinion.module=2 mm", "gear.pinion.module", "use normal_module"),
        (LINES, "gear.pinion.face_width=0 mm", "gear.pinion.face_width", "greater than zero"),
        (LINES, "results=['load-sharing']", "pair.I.load", "is required for the load distribution"),
        (LINES, "pair.I.misalignment={lead='1 um', lead_angle='1 arcmin'}", "pair.I.misalignment.lead", "contradicts"),
        ("litvin_lead", "pair.I.misalignment={lead='1 m'}", "pair.I.misalignment.lead", "within 20 %"),
        (
            "sources/litvin_fig10", "pair.I.modification={crown='1 m'}",
            "pair.I.modification.crown", "= 1000 mm: removes more",
        ),
        (FACE, "stiffness.face_positions=['20 mm']", r"stiffness.face_positions[0]", "valid range -4 mm to 4 mm"),
        (FACE, "stiffness.face_positions=0", "stiffness.face_positions", "equal to 1"),
        (FACE, "stiffness.positions=100000", "stiffness.face_positions", "500,000 bands"),
        (FACE, "gear.a.face_width=600 mm", "gear.a.face_width", "60 modules"),
    ],
)  # fmt: skip
def test_results_of_literature_and_width_refuse_by_the_key_that_the_case_has(case, override, key, words):
    def run():
        scene = read_scene(CASES / f"{case}.toml", [override])
        return run_plan(scene, make_plan(scene, STAGES))

    with pytest.raises(InputError) as refused:
        run()
    text = str(refused.value)
    assert text.startswith(key)
    assert words in text
    assert len(text) < 300


@pytest.mark.parametrize("formats", ["step", "msh", "dxf,solid-inp"])
def test_a_case_without_gears_has_nothing_to_export(formats, tmp_path):
    from fegear.output.export import export_gears

    with pytest.raises(InputError, match=r"gear = \(not given\): is required for export; add \[gear\.NAME\]"):
        export_gears(read_scene(CASES / f"{SLOPES}.toml", []), tmp_path, (), formats)


def test_a_new_body_s_torque_may_be_set_and_a_misspelt_table_is_named():
    case = CASES / "two_stage_gearbox.toml"
    scene = read_scene(case, ["train.torque.pinion_2=-5 N*m"])
    assert scene.case.train.torque["pinion_2"] == -5.0
    for path, words in (
        ("train.shaft.inptu.stiffness=1 N*m/rad", 'did you mean "input"'),
        ("gear.pinion.teeth=3", "is not in this case"),
        ("train.torques.motor=1 N*m", 'did you mean "torque"'),
    ):
        with pytest.raises(InputError, match=words):
            read_scene(case, [path])


def test_an_output_folder_below_a_file_is_reported_as_such(tmp_path):
    from fegear.output.folder import whole_or_nothing

    file = tmp_path / "notes.txt"
    file.write_text("mine")
    with (
        pytest.raises(InputError, match=r'lies below ".*notes\.txt", which is a file'),
        whole_or_nothing(file / "a" / "b"),
    ):
        pass
    assert file.read_text() == "mine"


def test_an_interrupt_while_the_program_is_still_loading_is_reported_in_one_line(tmp_path):
    """Held where the command line would be imported, as on a slow disk."""
    program = (
        "import signal, sys, time\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "class Slow:\n"
        "    def find_spec(self, name, *rest):\n"
        "        if name == 'fegear.cli':\n"
        "            print('loading', flush=True); time.sleep(600)\n"
        "sys.meta_path.insert(0, Slow())\n"
        "from fegear.__main__ import main\n"
        "main()\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "loading\n"
    os.kill(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors == "fegear: interrupted; results of earlier runs are unchanged.\n"


def test_meshing_leaves_signals_to_whoever_handles_them(tmp_path):
    """gmsh takes them away when it starts: a batch system's request to stop left a scratch folder behind."""
    program = (
        "import os, signal\n"
        "for name in ('SIGTERM', 'SIGHUP'):\n"
        "    signal.signal(getattr(signal, name), lambda number, _frame: print('heeded', number, flush=True))\n"
        "from fegear.fem.plane.settings import MeshSettings\n"
        "from fegear.fem.plane.tooth_meshing import mesh_sector\n"
        "from fegear.geometry.rack import BasicRack\nfrom fegear.geometry.external_tooth import Tooth\n"
        "mesh_sector(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 6.0, MeshSettings())\n"
        "for name in ('SIGTERM', 'SIGHUP'):\n"
        "    os.kill(os.getpid(), getattr(signal, name))\n"
        "reader, writer = os.pipe()\n"
        "os.close(reader)\n"
        "try:\n"
        "    os.write(writer, b'x')\n"
        "except BrokenPipeError:\n"
        "    print('closed')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"heeded {int(signal.SIGTERM)}\nheeded {int(signal.SIGHUP)}\nclosed\n"
