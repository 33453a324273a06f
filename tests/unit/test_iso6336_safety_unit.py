"""Rating by ISO 6336: what the interface promises whatever the numbers are."""

import math
from dataclasses import replace

import pytest

from fegear.base.errors import RangeError
from fegear.formulas.iso6336.conditions import Conditions, Replacement
from fegear.formulas.iso6336.pair_geometry import PairGeometry, of_pair
from fegear.formulas.iso6336.part1_face_load import Alignment, PinionShaft
from fegear.formulas.iso6336.rated import Duty, Quality, Strength
from fegear.formulas.iso6336.safety import rate_pair
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Strength("Eh", 1500e6, 500e6)
FINE = Quality(5, 7e-6, 8e-6, 8e-6, 4e-6, 16e-6)
ALIGNED = Alignment(PinionShaft("a", 0.12, 0.02, 0.035))


def pair(z: tuple[int, int] = (20, 47), beta: float = 0.0) -> GearPair:
    rack, hands = BasicRack.named("A"), ("right", "left") if beta else ("spur", "spur")
    gears = [Gear(Tooth(n, rack, helix_angle=beta), 3e-3, 10e-3, 30e-3, hand=h) for n, h in zip(z, hands, strict=True)]
    return GearPair(*gears)


def conditions(geometry: PairGeometry) -> Conditions:
    return Conditions(geometry, (STEEL, STEEL), (FINE, FINE), Duty(5e3, 150.0, (1e8, 4e7), 220e-6), ALIGNED)


def test_pinion_comes_first_whichever_gear_drives():
    ahead, back = (of_pair(p) for p in (pair((20, 47)), pair((47, 20))))
    assert ahead.members == ("driver", "driven")
    assert back.members == ("driven", "driver")
    one, other = (rate_pair(conditions(g)) for g in (ahead, back))
    assert other.contact_safety == pytest.approx(one.contact_safety, rel=1e-12)
    assert other.bending_safety == pytest.approx(one.bending_safety, rel=1e-12)


def test_of_equal_teeth_the_pinion_is_the_gear_with_more_profile_shift():
    """c' of ISO 6336-1 tells x_1 from x_2, so who drives would move it."""
    rack = BasicRack.named("A")
    small, large = (Gear(Tooth(30, rack, x), 3e-3, 10e-3, 30e-3) for x in (0.1, 0.4))
    ahead, back = of_pair(GearPair(small, large)), of_pair(GearPair(large, small))
    assert (ahead.members, back.members) == (("driven", "driver"), ("driver", "driven"))
    assert ahead.gears == back.gears
    assert rate_pair(conditions(ahead)).contact_safety == rate_pair(conditions(back)).contact_safety


def test_every_factor_has_a_clause_and_its_name_once():
    for beta in (0.0, math.radians(20.0)):
        rating = rate_pair(conditions(of_pair(pair(beta=beta))))
        names = [f.symbol for f in rating.factors]
        assert len(names) == len(set(names))
        assert all(f.clause.startswith("ISO ") for f in rating.factors)
        assert all(math.isfinite(v) for f in rating.factors for v in f.values)
        assert rating["S_H"].values == rating.contact_safety
        for s in ("S_H", "S_F"):
            assert rating[f"{s}_static"].value > rating[s].value > 0.0
        with pytest.raises(KeyError):
            rating["K_Z"]


def test_computed_values_stand_in_and_say_so():
    c = conditions(of_pair(pair()))
    plain = rate_pair(c)
    factor = tuple(
        s * c.geometry.module * c.geometry.gears[i].face_width / c.duty.tangential
        for i, s in enumerate(plain["sigma_F0"].values)
    )
    same = Replacement(
        plain["K_v"].value,
        plain["K_Hbeta"].value,
        plain["K_Halpha"].value,
        plain["K_Fbeta"].values,
        plain["K_Falpha"].values,
        factor,
    )
    again = rate_pair(c, same)
    assert again.contact_safety == pytest.approx(plain.contact_safety, rel=1e-12)
    assert again.bending_safety == pytest.approx(plain.bending_safety, rel=1e-12)
    assert len([r for r in again.remarks if "FE value instead of the formula" in r]) == 6
    doubled = rate_pair(c, Replacement(K_Hbeta=4.0 * plain["K_Hbeta"].value, K_Halpha=plain["K_Halpha"].value))
    assert doubled.contact_stress[0] == pytest.approx(2.0 * plain.contact_stress[0], rel=1e-12)


def test_what_cannot_be_rated_says_why():
    c = conditions(of_pair(pair()))
    with pytest.raises(RangeError, match="K_Hbeta by method C requires the pinion"):
        rate_pair(replace(c, alignment=Alignment()))
    with pytest.raises(RangeError, match="tolerance of grade 5"):
        rate_pair(replace(c, alignment=replace(ALIGNED, contact_pattern="favourable")))
    with pytest.raises(RangeError, match="fewer teeth first"):
        replace(c.geometry, gears=c.geometry.gears[::-1])


def test_a_high_contact_ratio_is_rated_with_a_remark():
    def remarks(rack: BasicRack) -> tuple[float, str]:
        gears = [Gear(Tooth(z, rack), 3e-3, 10e-3, 30e-3) for z in (45, 70)]
        rating = rate_pair(conditions(of_pair(GearPair(*gears))))
        return rating["epsilon_alpha_n"].value, rating["Y_F"].remark

    low, high = remarks(BasicRack.named("A")), remarks(BasicRack(1.25, 1.5, 0.2))
    assert low[0] < 2.0
    assert low[1] == ""
    assert high[0] > 2.0
    assert "2 or more" in high[1]


def test_crowned_flanks_bend_no_less_than_they_press():
    c = conditions(of_pair(pair()))
    plain, crowned = (rate_pair(replace(c, alignment=replace(ALIGNED, modification=m))) for m in ("none", "crowned"))
    assert plain["K_Fbeta"].value < plain["K_Hbeta"].value
    assert crowned["K_Fbeta"].value == crowned["K_Hbeta"].value < plain["K_Hbeta"].value
