"""Cracked and pitted teeth by the potential-energy method in mesh, beside springs in parallel added up by hand."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.contact.compared.odd_cycle import OddTeethOfPair, OddTooth, odd_passages
from fegear.contact.odd_flank import OddFlank, Pit
from fegear.contact.plane.odd_formula_compliance import OddFormulaCompliance, odd_formula_compliance
from fegear.fem.alike_teeth import meshing_order
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.formulas import potential_energy_simplified as simplified
from fegear.formulas.sources import pair_compliance
from fegear.results.gear.crosscheck_odd import said_of_passage, silent_on_odd_teeth

NAME = "potential-energy-simplified"
GEARS = tuple(
    fegear.Gear(z, "3 mm", bore_radius=bore, face_width="18 mm", plane="stress", name=f"z{z}")
    for z, bore in ((22, "14 mm"), (51, "35 mm"))
)
PAIR = fegear.Pair(*GEARS).geometry
LOAD = 90.0 / PAIR.driver.base_radius
CRACK = straight_crack(
    PAIR.driver.tooth, mouth_at_tangent(PAIR.driver.tooth, math.radians(30.0)), math.radians(65.0), share=0.4
)


def by_hand(along, tooth, softer):
    """Mesh stiffness with pair 0 at `along` when tooth 0 meshes; of one tooth pair the compliance is softer by this."""
    x = np.linspace(PAIR.x_start, PAIR.x_end, 2001)
    whole = pair_compliance(simplified.SOURCE, PAIR, x, LOAD / PAIR.face_width).total
    of_pair = {False: PAIR.face_width / whole, True: PAIR.face_width / (whole + softer(x))}
    at = [along - n * PAIR.base_pitch for n in range(tooth - 2, tooth + 3)]
    return sum(np.interp(one, x, of_pair[n == 2], 0.0, 0.0) for n, one in enumerate(at))


def by_crack(x):
    radius = PAIR.radius(x, "driver")
    whole, cracked = (simplified.tooth_compliance(PAIR.driver, radius, tip) for tip in (None, CRACK.corners[-1]))
    return cracked.total - whole.total


def by_pit(x):
    radius = PAIR.radius(x, "driver")
    contact = 4.0 * (1.0 - 0.3**2) / (math.pi * PAIR.driver.material.young_modulus)
    return np.where((radius >= 32.5e-3) & (radius <= 34e-3), contact * (1.0 / 0.7 - 1.0), 0.0)


@pytest.mark.parametrize(
    ("odd", "softer"),
    [
        (lambda gear: gear.with_crack(tooth=5, depth_ratio=0.4, angle="65 deg"), by_crack),
        (lambda gear: gear.with_pit(tooth=5, diameter=["65 mm", "68 mm"], face_share=0.3), by_pit),
    ],
)
def test_a_revolution_is_that_of_springs_in_parallel(odd, softer):
    pair = fegear.Pair(odd(GEARS[0]), GEARS[1], compliance=NAME)
    found = fegear.mesh_stiffness_revolution(pair, torque="90 N*m", effects={"corner_contact": False})
    table = found.tables["mesh_stiffness_revolution_I"]
    assert len(table["driver_angle [deg]"]) > 22 * 100
    along = np.radians(table["driver_angle [deg]"]) * PAIR.driver.base_radius
    near = (along > PAIR.x_end + 2 * PAIR.base_pitch) & (along < PAIR.x_start + 8 * PAIR.base_pitch)
    wanted = 1e-6 * by_hand(along[near], 5, softer)
    stiffness = table["mesh_stiffness [N/um]"][near]
    off = np.abs(stiffness / wanted - 1.0)
    assert np.quantile(off, 0.98) < 2e-4  # rows on the jumps themselves are on either side
    assert found.values["I.mesh_stiffness_loss"].value > 1.0
    assert any("tooth 5" in sentence for sentence in found.answer.sentences)


@pytest.mark.parametrize("member", ["driver", "driven"])
def test_only_the_passage_of_the_odd_tooth_changes(member):
    """Stand-ins for finite elements: the same formula; a crack of the driven gear passes as that of the driver."""
    gear = PAIR.gear(member)
    tip = (0.4, gear.tooth.root_radius / gear.module * gear.module)
    tips = {member: {meshing_order(3, gear.teeth, member): tip}}
    ordinary = tuple(odd_formula_compliance(PAIR.gear(m), NAME, {}) for m in ("driver", "driven"))
    odd = tuple(odd_formula_compliance(PAIR.gear(m), NAME, tips.get(m, {})) for m in ("driver", "driven"))
    known = OddTeethOfPair((OddTooth(member, "a", 3, "cracked"),), tips, {})
    (found,) = odd_passages(PAIR, odd, ordinary, LOAD / PAIR.face_width, known)
    by = found.formulas[NAME].value
    assert found.uncoupled.odd == pytest.approx(by.odd, rel=1e-12)
    assert found.fe.ordinary == pytest.approx(by.ordinary, rel=1e-12)
    there = (found.x > PAIR.x_start) & (found.x < PAIR.x_end)
    inside = by.ordinary[there] / by.odd[there] - 1.0
    assert inside.min() > 1e-3
    assert by.odd[~there] == pytest.approx(by.ordinary[~there], rel=1e-12)
    assert found.driver_angle == pytest.approx(found.x / PAIR.driver.base_radius)


def test_a_crack_beside_the_tooth_is_none_and_few_base_pitches_differ():
    gear = PAIR.driver
    radius = np.linspace(gear.form_radius, gear.involute_tip_radius, 7)
    source = odd_formula_compliance(gear, NAME, {-4: (9.0, 0.0), 2: (0.2, 0.0)})
    assert isinstance(source, OddFormulaCompliance)
    assert source.own(18, radius) == pytest.approx(source.ordinary.own(0, radius), rel=1e-12)
    assert (source.own(2, radius) > 1.05 * source.own(3, radius)).all()
    assert source.own(2 - 22, radius) == pytest.approx(source.own(2, radius))
    assert len({source.same_as(first, 2) for first in range(-22, 22)}) == 5
    with pytest.raises(fegear.InputError, match="no formula for a cracked tooth"):
        odd_formula_compliance(gear, "cornell", {0: (0.2, 0.0)})


def test_pits_alone_leave_the_compliance_of_the_tooth():
    flank = OddFlank(pits=(Pit(32.5e-3, 34e-3, 0.3),))
    known = OddTeethOfPair((OddTooth("driver", "a", 0, "pitted"),), {}, {"driver": {0: flank}})
    ordinary = tuple(odd_formula_compliance(PAIR.gear(m), NAME, {}) for m in ("driver", "driven"))
    (found,) = odd_passages(PAIR, ordinary, ordinary, LOAD / PAIR.face_width, known)
    assert 0.0 < found.fe.loss < 0.1
    assert found.formulas[NAME].value.loss == pytest.approx(found.uncoupled.loss, rel=1e-12)


@pytest.mark.parametrize("silent_anyway", [False, True])
def test_an_answer_names_formulas_that_the_crack_silences(silent_anyway):
    """Those that give nothing of ordinary teeth either are named with the compliance of one tooth pair."""
    tooth = SimpleNamespace(tooth=5, gear="z22", what="cracked")
    found = SimpleNamespace(tooth=tooth, fe=SimpleNamespace(odd=np.array([9e7, 8e7]), loss=0.5))
    one = SimpleNamespace(pair="I", found=found, formulas={}, silent={NAME: "the reason"}, title="Title")
    known = SimpleNamespace(compliance=SimpleNamespace(silent=(NAME,) if silent_anyway else ()))
    seen = SimpleNamespace(one=one, data=SimpleNamespace(pairs={"I": known}))
    (said,) = said_of_passage(seen)
    assert said.endswith("FE 80 N/µm (-50 %)." if silent_anyway else ", potential energy (no fillet) not valid here.")
    assert silent_on_odd_teeth(seen) == ([] if silent_anyway else [f"Title: {NAME} gives no value: the reason"])


def test_other_formulas_and_bodies_are_refused():
    cracked = GEARS[0].with_crack(tooth=5, depth_ratio=0.4, angle="65 deg")
    with pytest.raises(fegear.InputError, match="potential-energy-simplified"):
        fegear.mesh_stiffness_revolution(fegear.Pair(cracked, GEARS[1], compliance="cornell"), torque="90 N*m")
    deep = fegear.Pair(GEARS[0].with_crack(depth_ratio=0.9, angle="75 deg"), GEARS[1], compliance=NAME)
    with pytest.raises(fegear.InputError, match=r"beyond the centre line of the tooth\): must leave material") as said:
        fegear.mesh_stiffness_revolution(deep, torque="90 N*m")
    assert said.value.key == "gear.z22.odd_tooth.crack"
    holed = GEARS[0].with_hole(tooth=0, diameter="2 mm", position_radius="22 mm")
    with pytest.raises(fegear.InputError, match=r"odd_tooth\[0\]\.hole"):
        fegear.mesh_stiffness_revolution(fegear.Pair(holed, GEARS[1], compliance=NAME), torque="90 N*m")


@pytest.mark.dear
def test_a_crosscheck_has_the_odd_tooth_as_the_revolution_has_it():
    cracked = GEARS[0].with_crack(tooth=5, depth_ratio=0.4, angle="65 deg")
    pair = fegear.Pair(cracked, GEARS[1])
    found = fegear.crosscheck(pair, torque="90 N*m", positions=4, tolerance=1e-2)
    table = found.tables["crosscheck_odd_tooth_I_z22_5"]
    whole = fegear.mesh_stiffness_revolution(pair, torque="90 N*m", tolerance=1e-2, effects={"corner_contact": False})
    least, ordinary = (whole.values[f"I.mesh_stiffness_min{end}"].value for end in ("", "_ordinary"))
    assert table["mesh_stiffness_fe [N/um]"].min() == pytest.approx(least, rel=2e-3)
    assert table["mesh_stiffness_fe_ordinary [N/um]"].min() == pytest.approx(ordinary, rel=2e-3)
    loss = found.values["I_z22_5.mesh_stiffness_loss.potential-energy-simplified"].value
    assert loss == pytest.approx(found.values["I_z22_5.mesh_stiffness_loss.fe"].value, abs=6.0)
    said = "Pair I, tooth 5 of gear z22 cracked: minimum mesh stiffness on the path of contact"
    assert found.answer.sentences[0].startswith(said)
    assert "path of contact" not in whole.answer.sentences[0]  # there nothing else touches
    curves = found.figures["crosscheck_odd_tooth_I_z22_5"].panels[0].items
    assert {curve.dash or "solid" for curve in curves if curve.name.endswith("cracked")} == {"solid"}
    assert {curve.dash for curve in curves if curve.name.endswith("ordinary")} == {"dash"}
    assert "potential energy (no fillet), cracked" in [curve.name for curve in curves]
    own = [key for key in found.values.keys() if key.startswith("I")]  # noqa: SIM118  (of names, not of values)
    assert own[0] == "I_z22_5.mesh_stiffness_loss.fe"


@pytest.mark.dear
def test_non_working_flanks_that_carry_load_over_a_revolution_are_said():
    cracked = GEARS[0].with_crack(tooth=5, depth_ratio=0.5, angle="65 deg")
    asked = {"torque": "90 N*m", "speed": "6500 rpm"}
    notes = {}
    for damping in (0.02, 0.3):
        pair = fegear.Pair(cracked, GEARS[1], compliance=NAME)
        found = fegear.vibration_revolution(pair, damping_ratio=damping, **asked)
        notes[damping] = [note for note in found.notes() if "non-working flanks carry load" in note]
        force = found.tables["vibration_revolution_I"]["force [N]"]
        assert bool(notes[damping]) == (force.min() < 0.0)
    assert len(notes[0.02]) == 1
    assert 'train.mesh.I.backlash (a length or "unlimited")' in notes[0.02][0]


@pytest.mark.dear
def test_the_answer_on_the_dynamic_factor_has_the_load_on_non_working_flanks():
    """Without backlash teeth hardly lose contact near the resonance: their other flanks carry load."""
    driver = fegear.Gear(22, "2.5 mm", face_width="17 mm", name="z22")
    said = []
    for room in ("0 um", "60 um"):
        driven = fegear.Gear(43, "2.5 mm", face_width="17 mm", thickness_allowance=room, name="z43")
        pair = fegear.Pair(driver, driven, compliance=NAME)
        found = fegear.dynamic_factor(pair, torque="90 N*m", speeds=["10000 rpm"], damping_ratio=0.03)
        said.append((found.tables["dynamic_factor_I"]["backside_fraction"].max(), found.answer.sentences[-1]))
    (share, tight), (none, loose) = said
    assert share > 0.05
    assert "loss of contact at no speed; " in tight
    (shown,) = re.findall(r"; the non-working flanks carry load up to ([0-9.]+) % of the time\.$", tight)
    assert float(shown) == pytest.approx(100.0 * share, rel=0.02)
    assert none == 0.0
    assert re.search(r"loss of contact up to [0-9.]+ % of the time\.$", loose)
