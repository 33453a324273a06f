"""Any result of a gear or a pair from Python, and formulas beside finite elements."""

import pytest

import fegear

GEAR = {"module": "3 mm", "face_width": "20 mm"}
A, B = fegear.Gear(20, name="a", **GEAR), fegear.Gear(31, name="b", **GEAR)
PAIR = fegear.Pair(A, B, friction={"coefficient": 0.05})


def test_results_of_a_gear_and_of_a_pair_come_without_a_case():
    both = fegear.compute(PAIR, ["geometry", "tooth-geometry-check"], progress=False)
    assert any("geometry_check" in name for name in both.tables.keys())  # noqa: SIM118  (tables are no mapping)
    assert float(both.values["I.contact_ratio"]) == pytest.approx(float(PAIR.data.values["I.contact_ratio"]))
    found = fegear.compute(A, "geometry", progress=False)
    assert "gear_data" in found.tables
    torque = {"torque": "90 N*m", "speed": "1500 rpm", "tolerance": 0.1, "progress": False}
    loss = fegear.compute(PAIR, "gear-mesh-power-loss", **torque)
    more = fegear.compute(
        PAIR, ["gear-mesh-power-loss"], tables={"pair": {"I": {"friction": {"coefficient": 0.1}}}}, **torque
    )
    one, two = (float(each.values["I.tooth_loss"]) for each in (loss, more))
    assert two == pytest.approx(2.0 * one, rel=1e-6)  # by Coulomb's law


def test_the_crosscheck_of_a_pair_has_that_of_its_gears():
    quick = {"tolerance": 0.1, "progress": False}
    found = fegear.crosscheck(PAIR, torque="90 N*m", positions=4, **quick)
    assert {"crosscheck_compliance_I", "crosscheck_iso_6336_I", "crosscheck_root_stress_b"} <= set(found.tables.keys())
    assert list(found.tables["crosscheck_iso_6336_I"]["gear"]) == ["a", "b"]
    alone = fegear.crosscheck(A, positions=4, **quick)
    assert 0.5 < float(alone.values["a.root_stress.iso-6336-3.lowest_ratio"]) < 1.1
    assert "crosscheck_root_stress_a" in alone.tables


@pytest.mark.parametrize(
    ("ask", "rule"),
    [
        (lambda: fegear.compute(PAIR, "load-dist"), "load-dist"), (lambda: fegear.compute(PAIR, []), "at least one"),
        (lambda: fegear.compute(A, "geometry", torque="1 N*m"), "applies to pairs, not to gears"),
        (lambda: fegear.compute(3, "geometry"), "must be a fegear.Gear or a fegear.Pair"),
        (lambda: fegear.crosscheck(A, load="3 kN"), "applies to pairs, not to gears"),
        (lambda: fegear.compute(PAIR, "transmission-error"), "load"),
        (lambda: fegear.compute(PAIR, "geometry", tables={"stifness": {}}), "stifness"),
        (lambda: fegear.compute(PAIR, "transmission-error", torque="1 N*m", load="3 N"), "or load"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_in_one_sentence(ask, rule):
    with pytest.raises(fegear.InputError) as refused:
        ask()
    assert rule in str(refused.value)
    assert "\n" not in str(refused.value)
