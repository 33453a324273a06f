"""What AGMA 2101 is asked for a pair of a case: load, speed, steel and reversal, whoever drives."""

import math
from pathlib import Path

import pytest

from fegear.case.built.agma_pair import agma_inputs
from fegear.case.built.rated_pair import pair_to_rate
from fegear.case.reading import read_scene

CASES = Path(__file__).parents[2] / "cases"


def asked(*settings, case="rating_spur"):
    scene = read_scene(CASES / f"{case}.toml", [*settings])
    return agma_inputs(scene, pair_to_rate(scene, "I"))


@pytest.mark.parametrize(
    "drive",
    [
        (),
        ("pair.I.driver='wheel'", "pair.I.driven='pinion'", f"pair.I.torque='{520 * 62 / 21!r} N m'",
         f"pair.I.speed='{1480 * 21 / 62!r} rpm'"),
    ],
)  # fmt: skip
def test_load_times_speed_is_the_power(drive):
    inputs, _ = asked(*drive)
    power = 520.0 * 1480.0 * math.pi / 30.0
    assert inputs.service.tangential * inputs.service.speed == pytest.approx(power, rel=1e-12)
    assert inputs.service.overload == 1.0


def test_idlers_bear_seven_tenths_and_steels_are_those_of_agma():
    plain, said = asked("pair.I.operation={life='1 h'}")
    bent, _ = asked("pair.I.operation={life='1 h', idler='driven'}")
    assert plain.allowed[0] == bent.allowed[0]
    assert bent.allowed[1].bending == pytest.approx(0.7 * plain.allowed[1].bending, rel=1e-12)
    assert plain.allowed[0].treatment == "carburized"
    assert plain.allowed[0].contact == 1550e6
    assert any("A_v = 6" in one for one in said)


def test_own_numbers_and_other_materials_are_not_asked_and_why_is_said():
    nothing, said = asked("gear.pinion.strength.contact='1400 MPa'")
    assert nothing is None
    assert "user-defined stress limits are those of ISO 6336" in said[0]
    own = "gear.pinion.strength.agma_contact='1400 MPa'", "gear.pinion.strength.agma_bending='430 MPa'"
    given, said = asked("gear.pinion.strength.contact='1400 MPa'", *own)
    assert (given.allowed[0].contact, given.allowed[0].bending) == (1400e6, 430e6)
    assert given.allowed[1].bending == 450e6
    assert [one for one in said if "set agma_bending" in one] == [one for one in said if "wheel: sigma_FP = 450" in one]
    nothing, said = asked("gear.wheel.strength={material='grey-iron', hardness='200 HBW'}")
    assert nothing is None
    assert "material not included" in said[0]


def test_grade_3_of_a_steel_that_has_none_is_grade_2():
    strength = "{material='through-hardened-alloy-steel', quality='ME', hardness='300 HBW'}"
    inputs, said = asked(f"gear.pinion.strength={strength}", f"gear.wheel.strength={strength}")
    assert any(": AGMA 2101 defines no grade 3 for" in one for one in said)
    assert inputs.allowed[0].brinell == pytest.approx(300.0)
