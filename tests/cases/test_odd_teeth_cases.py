"""A case with cracked teeth: what a revolution shows, which tooth is which, what is refused, and the same in Python."""

import functools
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from solved_once import CACHE

import fegear
from fegear.base.errors import InputError
from fegear.case.built.odd_teeth import odd_teeth_of
from fegear.case.reading import read_scene
from fegear.contact.odd_flank import OddFlank
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.output.fmu import mesh_models
from fegear.results.catalogue import STAGES
from fegear.results.pair.odd_pair import ODD_PAIR, _remarks

CASE = Path(__file__).parents[2] / "cases" / "cracked_tooth.toml"
COARSE = ("accuracy.tolerance=2e-2", "neglected=false")
RELIEVED = ("gear.wheel.relief={ crowning = { amount = '1 um' } }", "effects.relief=true")
REVOLUTION = 'results=["mesh-stiffness-revolution"]'


@functools.cache
def run(*overrides):
    scene = read_scene(CASE, (*COARSE, *overrides))
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def number(found, name):
    return next(value.si for value in found.values if value.name == name)


def column(found, table, name):
    whole = next(one for one in found.tables if one.name == table)
    return next(one.si for one in whole.columns if one.name == name)


def pitches(found, name="te"):
    """A curve by base pitch, shape (C, P)."""
    cycle = column(found, "mesh_stiffness_revolution_I", "base_pitch")
    return column(found, "mesh_stiffness_revolution_I", name).reshape(int(cycle[-1]) + 1, -1)


@pytest.mark.dear
def test_half_a_tooth_cracked():
    """Numbers of a prototype that was held to whole gears of another mesh, code and contact."""
    found = run()
    assert number(found, "I.mesh_stiffness_loss") == pytest.approx(0.314, abs=3e-3)
    assert number(found, "I.te_residual_max") == pytest.approx(4.378e-6, rel=1e-2)
    assert number(found, "pinion.stiffness_loss_tooth_0") == pytest.approx(0.542, abs=5e-3)
    assert number(found, "I.K_I_max_pinion_0") == pytest.approx(8.07e6, rel=5e-3)
    assert pitches(found).shape[0] == 25
    k, load = (column(found, "stress_intensity_I_pinion_0", name) for name in ("K_I", "load"))
    assert (k[load > 200.0] > 0.0).all()  # the crack is open while its tooth carries
    assert load.max() == pytest.approx(2554.2, rel=1e-3)
    share = column(found, "tooth_loads_revolution_I", "share")
    angle = column(found, "tooth_loads_revolution_I", "driver_angle")
    for at in np.unique(angle)[::400]:
        assert share[angle == at].sum() == pytest.approx(1.0)
    stress = column(found, "root_stress_teeth_I_pinion", "root_tension")
    assert np.argmin(stress) == 0
    assert stress[10] == pytest.approx(np.median(stress))
    # of the wheel's 30 identical teeth those of one revolution, each on its whole way: only the crack's mates differ
    wheel, change = (column(found, "root_stress_teeth_I_wheel", name) for name in ("tooth", "root_tension_change"))
    assert wheel.tolist() == list(range(25))
    assert set(np.flatnonzero(np.abs(change) > 1e-9)) <= {0, 1, 24}
    assert np.abs(change).max() < 0.05
    listed = "root stress of gear wheel is listed for 25 of its 30 identical teeth"
    assert any(listed in said for said in found.remarks)
    said = " ".join(sentence for sentence in found.answer.sentences)
    assert "32 % below that of ordinary teeth" in said
    assert "N/µm), contact outside the path of contact included." in said
    assert "K_I up to 8.1" in said
    assert "54 % (load at radius" in said


@pytest.mark.dear
@pytest.mark.parametrize(("member", "teeth"), [("pinion", 25), ("wheel", 30)])
def test_teeth_count_in_meshing_order_on_both_gears(member, teeth):
    """Tooth 4 comes four base pitches after tooth 0, whichever way its gear turns."""
    crack = f"gear.{member}.odd_tooth=[{{ tooth = 4, crack = {{ depth_ratio = 0.5 }} }}]"
    others = ("gear.pinion.odd_tooth=[]",) if member == "wheel" else ()
    found = run(REVOLUTION, *others, crack)
    residual = np.abs(pitches(found, "te_residual")).max(axis=1)
    assert residual.size == teeth
    assert np.argmax(residual) == 4  # as pair 0
    assert set(np.argsort(residual)[-3:]) == {3, 4, 5}
    assert np.argmin(column(found, f"root_stress_teeth_I_{member}", "root_tension")) == 4
    load, tooth = (column(found, "tooth_loads_revolution_I", name) for name in ("load", "driver_tooth"))
    assert load[tooth == 12].max() == pytest.approx(load.max())


@pytest.mark.dear
def test_off_all_teeth_are_alike():
    found = run(REVOLUTION, "effects.odd_teeth=false")
    te = pitches(found)
    assert te.shape[0] == 25
    assert np.ptp(te, axis=0).max() == 0.0
    assert number(found, "I.mesh_stiffness_loss") == 0.0
    assert any("odd_tooth ignored because effects.odd_teeth is off" in said for said in found.remarks)
    on = run()  # with positions beside the changes of contact of odd teeth besides
    assert number(on, "I.mesh_stiffness_min_ordinary") == pytest.approx(number(found, "I.mesh_stiffness_min"), rel=1e-5)


@pytest.mark.dear
def test_a_crack_that_its_load_presses_together_is_said():
    """From the fillet of the other flank: open faces give a third less stiffness, where closed ones give 1 to 4 %."""
    crack = "gear.pinion.odd_tooth=[{ tooth = 3, crack = { depth_ratio = 0.4%s } }]"
    shut, usual = (
        run('results=["odd-tooth-stiffness"]', crack % fillet) for fillet in (", fillet = 'compression'", "")
    )
    assert any("loads on tooth 3 close its crack (K_I negative over 100 %" in said for said in shut.remarks)
    assert any('set crack_faces = "closing"' in said for said in shut.remarks)
    assert not any("close its crack" in said for said in usual.remarks)


@pytest.mark.dear
def test_faces_that_close_leave_a_tooth_nearly_ordinary():
    """In the opposite fillet a few per cent are left; from that of the loaded flank the crack stays open."""
    crack = "gear.pinion.odd_tooth=[{ tooth = 3, crack = { depth_ratio = 0.4, crack_faces = 'closing'%s } }]"
    both = 'results=["odd-tooth-stiffness", "mesh-stiffness-revolution"]'
    shut, usual = (run(both, crack % fillet) for fillet in (", fillet = 'compression'", ""))
    plain = run(both, "gear.pinion.odd_tooth=[{ tooth = 3, crack = { depth_ratio = 0.4 } }]")
    assert 0.02 < number(shut, "pinion.stiffness_loss_tooth_3") < 0.05
    assert 0.0 < number(shut, "I.mesh_stiffness_loss") < 0.02
    assert any("loads on tooth 3 close 100 % of its crack faces" in said for said in shut.remarks)
    assert any("100 % of its crack faces are closed." in said for said in shut.remarks)
    assert any('open its crack over the full length; crack_faces = "open"' in said for said in usual.remarks)
    for name in ("pinion.stiffness_loss_tooth_3", "I.mesh_stiffness_loss", "I.te_residual_max"):
        assert number(usual, name) == pytest.approx(number(plain, name), rel=1e-9)
    chart = next(one for one in shut.figures if one.name == "odd_tooth_stiffness_pinion")
    assert "closing crack faces" in chart.caption


@pytest.mark.dear
def test_other_results_say_that_they_have_ordinary_teeth():
    found = run('results=["load-sharing"]')
    assert any("here all teeth are identical" in said for said in found.remarks)


CLOSING = ("gear.pinion.odd_tooth=[{ crack = { depth = '1 mm', crack_faces = 'closing' } }]",)
LOWER = ("gear.pinion.odd_tooth=[{ tip_diameter = '53 mm' }]",)
TWICE = "gear.pinion.odd_tooth=[{ crack = { arc = '0 mm', depth = '1 mm' } }, { crack = { depth = '1 mm' } }]"


def planned(*changes):
    return make_plan(read_scene(CASE, changes), STAGES)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("tooth = 25, crack = { depth = '1 mm' }", r"odd_tooth\[0\].tooth = 25: must be less than 25"),
        ("tooth = -1, crack = { depth = '1 mm' }", r"odd_tooth\[0\].tooth = -1"),
        ("tooth = 0", r"odd_tooth\[0\].crack = \(not given\): is required"),
        ("tooth = 0, crack = { }", "depth = .*: is required, or depth_ratio or path"),
        ("tooth = 0, crack = { depth = '1 mm', depth_ratio = 0.2 }", "depth_ratio = 0.2: contradicts depth"),
        ("tooth = 0, crack = { depth = '1 mm', arc = '1 mm', radius = '23 mm' }", "radius = .*: contradicts arc"),
        ("tooth = 0, crack = { depth_ratio = 1.2 }", "depth_ratio = 1.2"),
        ("tooth = 0, crack = { depth = '1 mm', angle = '200 deg' }", "angle = 200 deg: must be between 0 and 135"),
        ("tooth = 0, crack = { depth = '9 mm' }", "depth = 9 mm: leads the crack out of its tooth"),
        ("tooth = 0, crack = { depth = '1 um' }", "piece of 0.001 mm; each must be at least 0.01 mm"),
        ("tooth = 0, crack = { depth_ratio = 0.99, angle = '90 deg' }", r"depth_ratio = 0.99: \(length .* mm\) leads"),
        ("tooth = 0, crack = { depth = '1 mm', radius = '30 mm' }", "radius = 30 mm: must be a radius on the fillet"),
        ("tooth = 0, crack = { depth = '1 mm', diameter = '60 mm' }", "diameter = 60 mm: must be a diameter on the"),
        ("tooth = 0, crack = { depth = '1 mm', arc = '60 mm' }", "arc = 60 mm: must lie on the fillet, 0 to .* mm"),
        ("tooth = 0, crack = { depth = '1 mm', tangent_angle = '95 deg' }", "tangent_angle = 95 deg: must be an angle"),
        ("tooth = 0, crack = { path = [['0 mm', '40 mm']] }", r"path = \[\[0, 40\]\] mm: leads the crack out"),
        ("tooth = 0, crack = { path = [['0 mm']] }", "path"),
        (
            "tooth = 0, crack = { depth_ratio = 0.4, angle = '0 deg' }",
            "depth_ratio = 0.4: .*requires a crack that runs",
        ),
        ("missing = true, crack = { depth = '1 mm' }", "missing = true: is not available for a cracked tooth"),
        ("missing = true, tip_diameter = '53 mm'", "tip_diameter = .*: contradicts missing"),
        (
            "missing = true, pits = [{ diameter = ['50 mm', '51 mm'], depth = '1 mm' }]",
            "pits = .*: contradicts missing",
        ),
        (
            "missing = true, deviation = [{ radii = ['25 mm', '27 mm'], removals = ['0 um', '1 um'] }]",
            "contradicts miss",
        ),
        ("missing = true, relief = { crowning = { amount = '1 um' } }", "relief = .*: contradicts missing"),
        (
            "deviation = [{ radii = ['25 mm', '27 mm'], removals = ['0 um', '1 um', '2 um'] }]",
            "removals = .*has 3 entries for 2 places",
        ),
        ("deviation = [{ file = 'none.csv' }]", r"odd_tooth\[0\]\.deviation\[0\]\.file"),
        (
            "relief = { tip = { amount = '20 um', start_radius = '29 mm' } }",
            r"odd_tooth\[0\]\.relief",
        ),
        (
            "deviation = [{ radii = ['25 mm', '27 mm'], removals = ['0 mm', '9 mm'] }]",
            r"odd_tooth\[0\]\.deviation = 9000 um .*times the maximum",
        ),
        ("tip_diameter = '55 mm'", r"tip_diameter = 55 mm: must be between .* and 54 mm, the tip diameter"),
        ("tip_diameter = '46 mm'", r"tip_diameter = 46 mm: must be between"),
        ("broken_at = '40 mm'", r"broken_at = 40 mm: must be between 45 and 54 mm"),
        ("pits = [{ depth = '1 mm' }]", "diameter = .*: is required, or radius"),
        ("pits = [{ diameter = ['51 mm', '50 mm'], depth = '1 mm' }]", "must rise from the first to the second"),
        ("pits = [{ diameter = ['50 mm', '51 mm'] }]", "depth = .*: is required with face_share = 1"),
        ("pits = [{ diameter = ['50 mm', '51 mm'], face_share = 2 }]", "face_share = 2"),
        ("pits = [{ radius = ['30 mm', '31 mm'], face_share = 0.5 }]", "radius = 30 to 31 mm: is outside the flank"),
        (
            "pits = [{ diameter = ['50 mm', '51 mm'], face_share = 0.4, face_position = '-3 mm' }]",
            r"pits\[0\].face_position = -3 mm: has no effect in plane .* pair.I.width = .solid",
        ),
        (
            "pits = [{ diameter = ['50 mm', '51 mm'], face_share = 0.4, face_position = '15 mm' }]",
            "face_position = 15 mm: places the whole pit outside the face, -10 to 10 mm",
        ),
        ("tooth = 0, crack = { depht = '1 mm' }", 'is an unknown key; did you mean "depth"'),
    ],
)
def test_what_is_no_crack_is_refused_in_a_sentence(change, said):
    with pytest.raises(InputError, match=said) as refused:
        planned(REVOLUTION, *RELIEVED, "gear.pinion.odd_tooth=[{ " + change + " }]")
    assert "\n" not in str(refused.value)
    assert "modules" not in str(refused.value)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ((TWICE,), "specified twice"),
        (("gear.pinion.tooth_mesh=own.msh",), "requires the generated mesh"),
        (('pair.I.width="solid"', *CLOSING), r'odd_tooth\[0\].crack.crack_faces = "closing": is available for plane'),
        (('pair.I.width="solid"', *LOWER), r"odd_tooth\[0\].tip_diameter = 53 mm: is available for plane"),
        (('pair.I.compliance={ source = "weber-banaschek" }', "effects.neighbour_coupling=false"), "is not available"),
        (("gear.pinion.odd_tooth=[]",), "has no effect: no gear of this case has odd_tooth"),
        (("effects.corner_contact=false", "gear.pinion.odd_tooth=[{ missing = true }]"), "at a missing tooth"),
        (('pair.I.driven="pinion"',), "is driver and driven gear of pair I"),
    ],
)
def test_where_there_are_no_odd_teeth_yet_is_said(changes, said):
    with pytest.raises(InputError, match=said):
        planned(REVOLUTION, *changes)


def test_places_that_are_the_same_are_the_same():
    def first(text):
        scene = read_scene(CASE, (f"gear.pinion.odd_tooth=[{{ crack = {{ {text} }} }}]",))
        return odd_teeth_of(scene, "pinion").cracks[0][1]

    one = first("radius = '22.7 mm', depth = '1 mm'")
    other = first("diameter = '45.4 mm', depth = '1 mm'")
    by_arc = first(f"arc = '{one.mouth * 2.0!r} mm', depth = '1 mm'")
    x, y = np.array(one.corners[0]) * 2.0
    by_path = first(
        f"radius = '22.7 mm', path = [['{x!r} mm', '{y!r} mm']]".replace("np.float64(", "").replace(")", "")
    )
    for same in (other, by_arc, by_path):
        assert same.mouth == pytest.approx(one.mouth)
        assert same.corners[0] == pytest.approx(one.corners[0])
    back = first("fillet = 'compression', radius = '22.7 mm', depth = '1 mm'")
    assert back.back
    assert back.corners[0] == pytest.approx((-one.corners[0][0], one.corners[0][1]))


def test_outlines_and_pits_of_a_case():
    text = "[{ tooth = 1, broken_at = '52 mm' }, { tooth = 2, broken_at = '46 mm' }, { tooth = 3, missing = true }, "
    pits = "[{ diameter = ['49 mm', '51 mm'], face_share = 0.3 }, { radius = ['24 mm', '24.2 mm'], depth = '50 um' }]"
    scene = read_scene(CASE, (f"gear.pinion.odd_tooth={text} {{ tooth = 4, pits = {pits} }}]",))
    found = odd_teeth_of(scene, "pinion")
    assert found.cracks == ()
    assert found.described == "teeth 2, 3 missing, tooth 1 shorter, tooth 4 pitted"
    flanks = dict(found.flanks)
    assert flanks[1].tip_radius == pytest.approx(26e-3)
    assert flanks[2].missing
    assert [pit.face_share for pit in flanks[4].pits] == [0.3, 1.0]
    assert flanks[4].pits[0].low == pytest.approx(24.5e-3)
    assert flanks[4].pits[1].depth == pytest.approx(50e-6)
    assert sorted(found.by_number(25)) == [22, 23, 24]  # pits change no body


def test_profiles_of_a_case(tmp_path):
    """By lists and by a file, in place of the gear's and beside it; not where the effect or the flank is another."""
    (tmp_path / "tooth.csv").write_text("radius [mm],relief [um]\n25,0\n26,3\n27,9\n")
    relief = "tooth = 2, relief = { tip = { amount = '20 um', start_radius = '25.5 mm' } }"
    deviation = f"tooth = 5, deviation = [{{ file = '{tmp_path / 'tooth.csv'}' }}, {{ radii = ['24 mm', '27 mm'], "
    deviation += "removals = ['1 um', '1 um'] }]"
    changes = (f"gear.pinion.odd_tooth=[{{ {relief} }}, {{ {deviation} }}]", "effects.relief=true", REVOLUTION)
    scene = read_scene(CASE, (*COARSE, *changes))
    make_plan(scene, STAGES)
    found = odd_teeth_of(scene, "pinion")
    assert found.described == "teeth 2, 5 with another profile"
    assert found.numbers == (2, 5)
    assert found.by_number(25) == {}  # profiles change no body
    profiles = dict(found.profiles)
    assert profiles[2].relief.tip[0].amount == pytest.approx(20e-6)
    flank = profiles[5].built_on(OddFlank(), scene.pairs["I"], "driver")
    roll = np.sqrt((26.5e-3 / scene.gears["pinion"].base_radius) ** 2 - 1.0)
    assert float(flank.deviation.removal(roll)) == pytest.approx(1e-6 + 6e-6, rel=0.05)
    assert found.on_other_flank().profiles == ()
    (said,) = odd_remarks(read_scene(CASE, (*COARSE, changes[0], REVOLUTION)))
    assert "profiles of single teeth ignored because effects.relief is off" in said


@pytest.mark.dear
def test_a_3d_pair_has_its_odd_teeth_over_a_revolution():
    narrow = ('pair.I.width="solid"', "gear.pinion.face_width=5 mm", "gear.wheel.face_width=5 mm")
    found = run(REVOLUTION, *narrow, "pair.I.torque=15 N*m", "load_distribution.panels=5")
    assert pitches(found).shape[0] == 25
    ordinary = np.median(pitches(found), axis=0)
    assert np.abs(pitches(found) - ordinary).max(axis=1).argmax() in (0, 1, 24)
    assert 0.2 < number(found, "I.mesh_stiffness_loss") < 0.45  # 0.314 in the plane
    loss = next(value for value in found.values if value.name == "I.mesh_stiffness_loss")
    assert 0.0 < loss.si_error < 0.02
    load, angle = (column(found, "tooth_loads_revolution_I", name) for name in ("share", "driver_angle"))
    for at in np.unique(angle)[::100]:
        assert load[angle == at].sum() == pytest.approx(1.0)
    tooth, change = (column(found, "root_stress_teeth_I_pinion", name) for name in ("tooth", "root_tension_change"))
    assert tooth.tolist() == list(range(25))
    assert change.argmin() == 0
    assert -1.0 < change[0] < -0.5
    assert np.median(change) == 0.0
    assert any("contact of the crack faces of tooth 0 is neglected (3D pair)" in said for said in found.remarks)


def test_slices_have_no_revolution():
    with pytest.raises(InputError, match="cannot be computed"):
        planned(REVOLUTION, 'pair.I.width="slices"')


def odd_remarks(scene):
    """What the pair with odd teeth says of its inputs."""
    seen = SimpleNamespace(asked=ODD_PAIR.inputs(scene, "I"))
    return [str(sentence) for sentence in _remarks(seen)]


@pytest.mark.dear
def test_a_missing_tooth_and_a_pit_in_a_case():
    """Of driver and driven gear; the missing one as of a prototype: 9.5 to 67.8 um."""
    gone = run(REVOLUTION, "gear.pinion.odd_tooth=[{ tooth = 4, missing = true }]")
    te = pitches(gone)
    assert te.max() * 1e6 == pytest.approx(67.8, rel=5e-3)
    assert column(gone, "root_stress_teeth_I_pinion", "root_tension")[4] == 0.0
    load, tooth = (column(gone, "tooth_loads_revolution_I", name) for name in ("load", "driver_tooth"))
    assert 4 not in tooth[load > 0.0]
    assert "tooth 4 missing (driver)" in " ".join(gone.answer.sentences)
    pit = "pits = [{ diameter = ['59 mm', '61 mm'], face_share = 0.4 }]"
    tip = "relief = { tip = { amount = '6 um', start_radius = '31 mm' } }"
    both = f"gear.wheel.odd_tooth=[{{ tooth = 7, {pit} }}, {{ tooth = 20, {tip} }}]"
    pitted = run(REVOLUTION, "gear.pinion.odd_tooth=[]", both, "effects.relief=true")
    residual = np.abs(pitches(pitted, "te_residual")).max(axis=1)
    assert set(np.flatnonzero(residual > 1e-12)) <= {6, 7, 8, 9, 19, 20, 21, 22}
    assert 0.05e-6 < residual[7] < 2e-6
    assert np.argmax(residual[15:]) == 5  # on pair 0 of its own base pitch
    assert 0.5e-6 < residual[20] < 6e-6
    assert "tooth 7 pitted, tooth 20 with another profile (driven)" in " ".join(pitted.answer.sentences)


@pytest.mark.dear
def test_a_gear_gets_a_crack_in_python():
    plain = fegear.Gear(25, "2 mm", face_width="20 mm", name="a")
    gear = plain.with_crack(tooth=0, depth="0.5 mm", angle="70 deg").with_crack(tooth=4, depth_ratio=0.3)
    assert gear.keys["odd_tooth"][0] == {"tooth": 0, "crack": {"depth": "0.5 mm", "angle": "70 deg"}}
    assert [one["tooth"] for one in gear.with_crack(tooth=0, depth="1 mm").keys["odd_tooth"]] == [4, 0]
    assert "odd_tooth" not in plain.keys
    with pytest.raises(InputError, match="must be less than 25"):
        plain.with_crack(tooth=25, depth="0.5 mm")
    wheel = fegear.Gear(30, "2 mm", face_width="20 mm", name="b")
    found = fegear.mesh_stiffness_revolution(
        fegear.Pair(plain.with_crack(depth_ratio=0.5), wheel), torque="60 N*m", tolerance=2e-2, cache=CACHE
    )
    assert found.values["I.mesh_stiffness_loss"].si == pytest.approx(0.314, abs=5e-3)


def test_a_gear_gets_pits_in_python():
    """One after the other on a tooth, beside its crack; another crack leaves them, a hole takes the crack's place."""
    first, second = {"diameter": ["49 mm", "50 mm"], "face_share": 0.4}, {"radius": ["25 mm", "26 mm"], "depth": "1 mm"}
    gear = fegear.Gear(25, "2 mm", face_width="20 mm", name="a").with_crack(tooth=2, depth="0.5 mm")
    pitted = gear.with_pit(tooth=2, **first).with_pit(tooth=2, **second).with_pit(**first)
    crack, deeper = {"depth": "0.5 mm"}, {"depth": "0.8 mm"}
    other = {"tooth": 0, "pits": [first]}
    assert pitted.keys["odd_tooth"] == [{"tooth": 2, "crack": crack, "pits": [first, second]}, other]
    again = pitted.with_crack(tooth=2, **deeper).keys["odd_tooth"]
    assert again == [other, {"tooth": 2, "pits": [first, second], "crack": deeper}]
    keyed = pitted.changed(bore_radius="10 mm").with_keyway(tooth=2).keys["odd_tooth"]
    assert keyed == [other, {"tooth": 2, "pits": [first, second], "keyway": {}}]
    gone = fegear.Gear(25, "2 mm", face_width="20 mm", odd_tooth={"tooth": 2, "missing": True})
    assert gone.with_pit(tooth=2, **first).keys["odd_tooth"] == [{"tooth": 2, "pits": [first]}]
    with pytest.raises(InputError, match=r"depth = .*: is required with face_share = 1"):
        gear.with_pit(diameter=["49 mm", "50 mm"])


def test_a_plane_pair_says_what_it_assumes_of_pits():
    """Where the remaining face carries; a pit over the whole face is a gap and nothing is assumed."""
    part, whole = "diameter = ['50 mm', '51 mm'], face_share = 0.4", "diameter = ['50 mm', '51 mm'], depth = '50 um'"
    odd = "gear.pinion.odd_tooth=[{{ tooth = 3, pits = [{{ {} }}] }}]"
    (said,) = odd_remarks(read_scene(CASE, (odd.format(part),)))
    assert "pinion: pits of tooth 3 change the contact only" in said
    assert odd_remarks(read_scene(CASE, (odd.format(whole),))) == []


@pytest.mark.dear
def test_a_gear_gets_a_hole_in_python():
    plain = fegear.Gear(25, "2 mm", face_width="20 mm", bore_radius="10 mm", name="a")
    hole = {"diameter": "2.5 mm", "position_radius": "19.5 mm"}
    gear = plain.with_crack(tooth=2, depth="0.5 mm").with_hole(tooth=2, **hole, angle="1 deg")
    assert gear.keys["odd_tooth"] == [{"tooth": 2, "hole": {**hole, "angle": "1 deg"}}]
    for wrong, said in (({"tooth": 25, **hole}, "must be less than 25"), ({"diameter": "3 mm"}, "position_radius")):
        with pytest.raises(InputError, match=said):
            plain.with_hole(**wrong)
    wheel = fegear.Gear(30, "2 mm", face_width="20 mm", name="b")
    found = fegear.mesh_stiffness_revolution(
        fegear.Pair(plain.with_hole(tooth=3, **hole), wheel), torque="60 N*m", tolerance=2e-2, cache=CACHE
    )
    residual = np.abs(column(found, "mesh_stiffness_revolution_I", "te_residual")).reshape(25, -1).max(axis=1)
    assert residual.argmax() in (2, 3, 4)  # on pair 0 of base pitch 3, on its neighbours before and after
    assert 0.005 < found.values["I.mesh_stiffness_loss"].si < 0.2


RIG = (
    "effects.corner_contact=false", "effects.parametric=true", "effects.contact_loss=true",
    "train.body={ a = { inertia = '0.002 kg*m^2' }, b = { inertia = '0.003 kg*m^2' } }",
    "train.mesh={ I = { driver = 'a', driven = 'b', damping_ratio = 0.1 } }",
    "train.torque={ a = '60 N*m' }", "train.balance='b'", "dynamics.speed='2000 rpm'", "dynamics.harmonics=8",
)  # fmt: skip


@pytest.mark.dear
def test_a_train_has_the_odd_teeth_of_its_pairs():
    """Its excitation repeats after a revolution, with sidebands; the FMU of the pair has the same springs."""
    found = run('results=["mesh-force-spectrum", "mesh-stiffness-revolution", "vibration-revolution"]', *RIG)
    te = pitches(found)
    assert number(found, "I.static_te_peak_to_peak") == pytest.approx(np.ptp(te), rel=1e-2)
    assert any("repeats after 25 base pitches (odd teeth)" in said for said in found.remarks)
    n, force = (column(found, "mesh_force_spectrum_I", name) for name in ("n", "force"))
    mesh = {round(order * 25): line for order, line in zip(n, force, strict=True)}
    assert 0.003 * mesh[25] < mesh[24] < mesh[25]
    assert 0.003 * mesh[25] < mesh[26] < mesh[25]
    angle, moved, residual, force, acceleration = (
        column(found, "vibration_revolution_I", name)
        for name in ("driver_angle", "te", "te_residual", "force", "acceleration")
    )
    assert angle == pytest.approx(2.0 * np.pi * np.arange(angle.size) / angle.size)
    assert force.mean() == pytest.approx(number(found, "I.mean_force"), rel=5e-3)
    # the crack is met in base pitches 0 and 1 behind the pitch point, and shakes the pair for some more
    assert np.argmax(np.abs(residual)) in range(angle.size // 25 * 2)
    regular = np.broadcast_to((moved - residual).reshape(25, -1)[0], (25, angle.size // 25))
    assert moved - residual == pytest.approx(regular.ravel(), rel=1e-9)
    assert residual.reshape(25, -1).mean(axis=0) == pytest.approx(0.0, abs=1e-12)
    step = 60.0 / 2000.0 / angle.size
    assert np.cumsum(acceleration * step).std() == pytest.approx(np.gradient(moved, step).std(), rel=2e-2)
    lines = 2.0 * np.abs(np.fft.rfft(moved)) / moved.size
    assert column(found, "vibration_orders_I", "te") == pytest.approx(lines[1:201])
    assert number(found, "I.dynamic_residual_kurtosis") > 10.0
    (model, _) = mesh_models(read_scene(CASE, (*COARSE, *RIG)))[0]
    (springs,) = model.excitations
    assert {k.pitches for k in springs.stiffness} == {25}
    x = column(found, "mesh_stiffness_revolution_I", "x").reshape(te.shape)
    assert springs.approach(model.nominal, x / model.pair.base_pitch) == pytest.approx(te, rel=1e-5)


@pytest.mark.dear
def test_a_crack_grows_in_a_case():
    """The first step's K is that of `stress-intensity` but for loads on the next teeth; steps are 0.1 modules."""
    found = run(
        'results=["crack-path", "stress-intensity"]', 'gear.pinion.bore_radius="20.3 mm"',
        'gear.pinion.rim_support={kind = "free_arc", teeth = 7}',
        'gear.pinion.odd_tooth=[{crack = {depth = "0.3 mm", angle = "60 deg"}}]',
        "crack_growth={steps = 2, paris_coefficient = 6.9e-12, paris_exponent = 3.0, toughness = 1000.0}",
    )  # fmt: skip
    k, length, cycles = (column(found, "crack_path_I_pinion_0", name) for name in ("K_I", "length", "cycles"))
    assert k[0] == pytest.approx(column(found, "stress_intensity_I_pinion_0", "K_I").max(), rel=5e-3)
    assert np.diff(length) == pytest.approx(2 * [0.2e-3], rel=1e-6)
    assert cycles[0] == 0.0
    assert (np.diff(cycles) > 0.0).all()
    error = column(found, "crack_path_I_pinion_0", "K_I_error")
    assert ((error > 0.0) & (error < 0.05 * k)).all()
    low = number(found, "I.K_I_min_start_pinion_0")
    assert low == pytest.approx(column(found, "stress_intensity_I_pinion_0", "K_I").min(), rel=1e-9)
    pressed = [said for said in found.remarks if "close the crack of tooth 0 of gear pinion" in said]
    assert len(pressed) == (low < -0.02 * column(found, "stress_intensity_I_pinion_0", "K_I").max())
    assert low < 0.0


@pytest.mark.parametrize(
    ("growth", "words"),
    [
        ("{paris_exponent = 3.0}", "paris_coefficient.*is required together with paris_exponent"),
        ("{threshold = 2.0}", "threshold = 2.*requires Paris' law"),
        ("{load_factors = [1.0, 2.0], cycle_shares = [1.0]}", "must have one value for each of the 2 load_factors"),
        ("{load_factors = [1.0, 2.0], cycle_shares = [0.5, 0.6]}", r"cycle_shares = 1\.1: must have the sum 1"),
        ("{steps = 0}", "steps"),
    ],
)
def test_growth_that_has_no_law_is_refused_in_words(growth, words):
    with pytest.raises(InputError, match=words):
        read_scene(CASE, ['results=["crack-path"]', f"crack_growth={growth}"])


def test_a_keyway_is_refused_where_it_cannot_be():
    for keys, rule in (
        ("[{ keyway = {} }, { tooth = 5, missing = true }]", "beside other teeth with a different body"),
        ("[{ keyway = {}, crack = { depth = '1 mm' } }]", "is not available together with crack"),
        ("[{ keyway = { depth = '11 mm' } }]", r"keyway.depth = 11 mm: leaves"),
    ):
        with pytest.raises(InputError, match=rule):
            make_plan(read_scene(CASE, (REVOLUTION, f"gear.pinion.odd_tooth={keys}")), STAGES)
