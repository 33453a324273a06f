"""Micropitting, scuffing and rating of a printed report through a case file, and the film of its spur stage.

Source: KISSsoft 03/2017 reports of 26.02.2020 on the NREL 5 MW gearbox (fegear/verify/data/kisssoft_stage_*.toml),
which print ISO/TR 15144-1:2014 method B, ISO/TR 13989:2000 and ISO 6336:2006 factor by factor.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.case.built.pair_surface import pair_surface
from fegear.case.reading import build_scene
from fegear.formulas.flash_temperature import STEEL_HEAT
from fegear.formulas.friction import Surface
from fegear.formulas.iso6336 import part20_flash, part21_integral, part22_micropitting
from fegear.formulas.iso6336.rated import LoadFactors, RatedSurface
from fegear.formulas.lubricant import Oil
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.workbench.run import run

OIL = Oil(220e-6, 19e-6, 890.0)


def _gear(teeth, shift, tip, bore, pitch, form, hand):
    return {
        "teeth": teeth, "normal_module": "14 mm", "helix_angle": "10 deg", "hand": hand, "profile_shift": shift,
        "rack": "ISO 53 A", "tip_diameter": tip, "face_width": "360 mm", "bore_radius": bore, "rim_thickness": "70 mm",
        "web_thickness": "90 mm", "material": {"young_modulus": "206 GPa", "density": "7830 kg/m^3"},
        "roughness": {"flank": "0.6 um", "flank_rz": "4.8 um", "root_rz": "20 um"}, "tolerance_class": 6,
        "deviations": {"base_pitch": pitch, "profile_form": form, "helix_slope": "18 um"},
        "flank_treatment": "case-carburized",
        "strength": {"material": "case-hardened-steel", "quality": "MQ", "hardness": "61 HRC", "contact": "1500 MPa",
                     "bending": "430 MPa"},
    }  # fmt: skip


#: The third stage as its report prints it.
THIRD = {
    "results": ["rating"],
    "gear": {
        "pinion": _gear(24, 0.4800, "380.747 mm", "89.55 mm", "13.1 um", "18 um", "right"),
        "wheel": _gear(95, 0.6691, "1395.376 mm", "596.66 mm", "15.9 um", "22 um", "left"),
    },
    "pair": {
        "I": {
            "driver": "pinion", "driven": "wheel", "centre_distance": "861 mm", "torque": "40953.0 N*m",
            "speed": "1165.9 rpm", "iso_6336": {"edition": 2006},
            "lubricant": {"viscosity_40": "220 mm^2/s", "viscosity_100": "19 mm^2/s", "density_15": "890 kg/m^3",
                          "temperature": "80 degC", "scuffing_load_stage": 14, "micropitting_load_stage": 10},
            "operation": {"application_factor": 1.25, "life": "175200 h", "face_load_factor": 1.15,
                          "safety_contact": 1.25, "safety_root": 1.56},
        }
    },
    "rating": {"beside": []},
}  # fmt: skip


def third_surface():
    return pair_surface(build_scene(THIRD, "case", None), "I")


def falls_on(found, printed):
    """Whether a number rounds to what is printed."""
    digits = len(printed.partition(".")[2])
    return abs(found - float(printed)) <= (0.5 + 1e-6) * 10.0**-digits


def test_the_film_of_a_helical_pair_is_the_printed_one():
    """Spur load sharing at A, 1/3, gave X_Y .333, p_dyn 621 MPa and lambda_GF 1.39."""
    asked = third_surface()
    rated = asked.rated
    found = part22_micropitting.rated_film(rated, np.array([rated.pair.x_start]))
    assert falls_on(found.sharing[0], "0.889")
    assert found.nominal[0] / 1e6 == pytest.approx(783.093, rel=1e-5)
    assert found.dynamic[0] / 1e6 == pytest.approx(1014.701, rel=1e-5)
    assert falls_on(found.friction, "0.030")
    assert falls_on(found.bulk, "85.0")
    assert falls_on(found.film.thickness[0] * 1e6, "0.632")
    least, place = part22_micropitting.least_ratio(rated)
    assert (falls_on(least, "1.053"), place) == (True, "A")
    assert falls_on(part22_micropitting.loss_factor(rated.pair), "0.106")
    assert float(rated.at(rated.pair.x_start).relative_radius) == pytest.approx(37.122e-3, rel=2e-5)
    assert part22_micropitting.relief_factor(rated) == 1.0


def test_the_permissible_film_of_the_test_is_within_one_percent_of_print():
    """lambda_GFT .102 and lambda_GFP .143 are printed; spur sharing at A and tips cut back gave .1176 and .165."""
    assert part22_micropitting.film_of_test(OIL, 10) == pytest.approx(0.102, rel=0.012)
    assert part22_micropitting.permissible_ratio(OIL, 10) == pytest.approx(0.143, rel=0.01)
    # a carburized gear on a through-hardened one: W_W = .75 and lambda_GFP = .107 are printed
    mixed = part22_micropitting.permissible_ratio(OIL, 10, material=0.75)
    assert mixed == pytest.approx(0.107, rel=0.012)


def test_flanks_of_two_steels_take_the_mean_material_factor():
    case = {**THIRD, "gear": {**THIRD["gear"]}}
    soft = {"material": "through-hardened-alloy-steel", "hardness": "240 HBW"}
    wheel = {key: value for key, value in case["gear"]["wheel"].items() if key != "flank_treatment"}
    case["gear"]["wheel"] = wheel | {"strength": soft}
    assert pair_surface(build_scene(case, "case", None), "I").tests.material_factor == 0.75
    assert third_surface().tests.material_factor == 1.0
    case["gear"]["wheel"] = wheel | {"strength": {"material": "nitrided-nitriding-steel"}}
    recalled = pair_surface(build_scene(case, "case", None), "I")
    assert recalled.tests.material_factor == 1.25
    assert any("W_W = 1.5 for nitrided flanks is not verified" in text for text in recalled.remarks)
    pair = THIRD["pair"]["I"] | {"iso_6336": {"edition": 2006, "micropitting_material_factor": 0.9}}
    given = pair_surface(build_scene({**case, "pair": {"I": pair}}, "case", None), "I")
    assert given.tests.material_factor == 0.9
    assert not any("recalled" in text for text in given.remarks)


def test_the_film_of_a_spur_stage_is_the_printed_one():
    """Planet (driver) and sun of the second stage at E; the report takes a third of the power, not the rolling one."""
    steel, rack = Material(206e9, 0.3, 7830.0), BasicRack.named("A", math.radians(20.0))
    gears = [
        Gear(Tooth(z, rack, profile_shift=x, tip_radius=0.5 * tip / 0.021), 0.021, 0.1, 0.55, steel)
        for z, x, tip in ((36, 0.5039, 0.815663), (18, 0.3890, 0.432838))
    ]
    pair = GearPair(*gears, 0.584)
    load = 285900.438 / math.cos(math.radians(20.0))
    product = (784.475 / 452.469) ** 2  # K_A K_gamma K_v K_Hbeta of the printed pressures
    turning = 0.5 * (294.5 - 47.8) * math.pi / 30.0  # planet and sun against the carrier
    rated = RatedSurface(pair, turning, load, LoadFactors(product), Surface(OIL, 75.0, 0.6e-6))
    found = part22_micropitting.rated_film(rated, np.array([pair.x_end]))
    assert found.sharing[0] == pytest.approx(1.0 / 3.0)
    assert found.nominal[0] / 1e6 == pytest.approx(452.469, rel=1e-4)
    least, place = part22_micropitting.least_ratio(rated)
    assert place == "E"
    assert least == pytest.approx(0.536, rel=0.015)


def test_helical_load_sharing_goes_from_spur_to_even_as_the_overlap_grows():
    wide = third_surface().rated.pair

    def at_start(overlap):
        faces = [replace(g, face_width=0.36 * overlap / wide.overlap_ratio) for g in (wide.driver, wide.driven)]
        pair = GearPair(*faces, wide.centre_distance)
        return float(part22_micropitting.load_sharing(pair, pair.x_start)), part22_micropitting.narrow(pair)

    shares = [at_start(overlap)[0] for overlap in (0.8, 1.0, 1.2, 3.0)]
    assert shares[0] == pytest.approx(1.3 * (1.0 - 0.2 * 0.3 / 1.3) / 3.0)  # X_but = 1 + .3 eps_beta up to 1
    assert shares[1] == pytest.approx(0.5 * 1.3 * (1.0 / 3.0 + 1.0 / wide.contact_ratio))
    assert shares[2:] == pytest.approx([1.3 / wide.contact_ratio] * 2)
    assert [at_start(overlap)[1] for overlap in (0.8, 1.19, 1.21)] == [True, True, False]


def test_temperatures_of_scuffing_are_the_printed_ones():
    """One B_M for both: the film falls on print with 13.780 N/(mm s^.5 K), and so do X_M and the mean temperature."""
    rated = third_surface().rated
    assert STEEL_HEAT / 1e3 == 13.780
    assert falls_on(rated.unit_load / 1e3, "1119.6")
    assert rated.tip_relief == pytest.approx((2.0e-6, 2.0e-6), abs=0.05e-6)  # running in, printed 2.00
    whole = part21_integral.integral_temperature(rated)
    assert falls_on(whole.thermal, "50.06")
    assert falls_on(whole.relief, "1.095")
    assert falls_on(whole.contact_ratio, "0.263")
    assert falls_on(whole.geometry, "0.230")
    assert falls_on(whole.mean, "16.25")
    assert falls_on(whole.bulk, "91.37")
    assert whole.integral == pytest.approx(115.75, abs=0.011)
    flash = part20_flash.flash_temperatures(rated, np.array([rated.pair.x_end]))
    assert falls_on(flash.friction, "0.041")
    assert falls_on(flash.load_sharing[0], "0.889")
    assert flash.mean_flash == pytest.approx(30.20, rel=0.01)
    assert flash.largest == pytest.approx(169.50, rel=0.01)
    assert part20_flash.scuffing_temperature(rated, 14) == pytest.approx(451.98, abs=0.02)


def test_a_case_reaches_the_printed_rating():
    """Web and rim give C_R, and gears at printed values mesh without an invented backlash."""
    found = run(THIRD, progress=False)
    table = next(one for one in found.tables if one.name == "rating_I")
    columns = {column.name: column.si for column in table.columns}
    rows = dict(zip(columns["symbol"], zip(columns["driver"], columns["driven"], strict=True), strict=True))
    for symbol, printed in (
        ("C_R", "0.898"), ("c'", "13.832"), ("c_gamma_alpha", "18.632"), ("c_gamma_beta", "15.837"), ("N", "0.410"),
        ("K_v", "1.092"), ("K_Halpha", "1.069"), ("Z_H", "2.307"), ("Z_epsilon", "0.827"), ("Z_beta", "1.008"),
        ("sigma_HG", "1338.30"), ("sigma_HP", "1070.64"), ("sigma_FG", "637.15"), ("sigma_FP", "408.43"),
        ("S_H", "1.81"), ("S_F", "3.26"),
    ):  # fmt: skip
        assert falls_on(rows[symbol][0], printed), (symbol, rows[symbol][0], printed)
    for symbol, printed in (("sigma_HG", 1387.31), ("sigma_HP", 1109.85), ("sigma_FG", 654.72), ("sigma_FP", 419.69)):
        assert rows[symbol][1] == pytest.approx(printed, rel=1e-5)  # load cycles from a speed of five digits
    assert falls_on(rows["S_H"][1], "1.88")
    assert rows["sigma_H"][0] == pytest.approx(739.61, rel=1e-4)  # the torque is printed with six digits
    assert rows["m_red"][0] == pytest.approx(0.36503, rel=1e-3)  # the inside of the rim, as the report has it
    values = {value.name: value.value for value in found.values}
    # printed for pinion and wheel: flanks 10477.39 and 11258.73 kW, roots 10438.07 and 9905.30 kW
    assert values["I.transmittable_power_H"] == pytest.approx(10477.39, rel=1e-4)
    assert values["I.transmittable_power_F"] == pytest.approx(9905.30, rel=1e-3)  # as S_F, .08 % by h_Fe
    assert values["I.transmittable_power"] == values["I.transmittable_power_F"]
    assert any("backlash is negative by 0.11 um" in text for text in found.remarks)
