"""Insides of bearings that are published, and ratings printed for the same designation.

Sources: number, diameter and pitch diameter of the balls of 6205 and 6203 from the bearing data center of Case Western
Reserve University (0.3126 and 0.2656 in), of UER204 from Wang, Lei, Li, Li, IEEE Transactions on Reliability 69 (2020)
401-412 (its inside is that of a 6204), of a bearing with the envelope of 6305 from the repository minzhun/ISO16281.
C and C_0 of 6205, 6305 as printed in the model of a gearbox published with REXS; of 6203 and 6204 of the catalogues.
NTN, Ball and Roller Bearings: C, C_0 and f_0 of deep groove bearings, from which ISO 76 gives number and diameter of
the balls; C, C_0 and the raceway diameters F_w, E_w of cylindrical roller bearings of two designs.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import catalogue_rating, envelope_of
from fegear.shafts.load_ratings import dynamic_rating, static_rating
from fegear.shafts.printed_ratings import printed_rating
from fegear.shafts.rolling_bearing import RollingBearing

#: Designation, balls, their diameter [mm], C and C_0 [kN].
PUBLISHED = (("6203", 8, 6.746, 9.5, 4.75), ("6204", 8, 7.92, 12.7, 6.55), ("6205", 9, 7.94, 14.0, 7.8),
             ("6305", 7, 11.5, 22.4, 11.4))  # fmt: skip


@pytest.mark.parametrize(("designation", "count", "diameter", "c", "c_0"), PUBLISHED)
def test_printed_ratings_give_the_published_inside(designation, count, diameter, c, c_0):
    known = envelope_of(designation)
    printed = CatalogueBearing("ball", known.bore, known.outside_diameter, known.width, c * 1e3, c_0 * 1e3)
    assert printed.inside.count == count
    assert printed.inside.element_diameter * 1e3 == pytest.approx(diameter, rel=0.02)
    made = RollingBearing("ball", count, diameter * 1e-3, printed.inside.pitch_diameter)
    ratio = made.count * made.constant / (printed.inside.count * printed.inside.constant)
    assert abs(ratio ** (2.0 / 3.0) - 1.0) < printed.error
    bare = CatalogueBearing("ball", known.bore, known.outside_diameter, known.width)
    ratio = made.count * made.constant / (bare.inside.count * bare.inside.constant)
    assert abs(ratio ** (2.0 / 3.0) - 1.0) < bare.error
    # The ratings themselves, by ISO 76 and ISO 281.
    assert static_rating(made) == pytest.approx(c_0 * 1e3, rel=0.03)
    assert dynamic_rating(made) == pytest.approx(c * 1e3, rel=0.03)


def test_ratings_of_eight_bearings_of_one_gearbox_belong_together():
    """With C_0 alone C comes out as printed: b_m of the seven ball bearings within 12 % of ISO 281's 1.3."""
    rows = (("6305", 22.4, 11.4), ("6205", 14.0, 7.8), ("6202", 7.8, 3.75), ("6302", 11.4, 5.4), ("6303", 15.0, 6.5),
            ("6207", 25.5, 15.3), ("6308", 42.5, 25.0))  # fmt: skip
    for designation, c, c_0 in rows:
        known = envelope_of(designation)
        printed = CatalogueBearing("ball", known.bore, known.outside_diameter, known.width, c * 1e3, c_0 * 1e3)
        assert printed.rating_factor == pytest.approx(1.3, rel=0.12)
    roller = envelope_of("NUP204-E-XL-TVP2")
    size = roller.bore, roller.outside_diameter, roller.width
    assert CatalogueBearing(roller.kind, *size, 32.5e3, 24.7e3).rating_factor == pytest.approx(1.3, rel=0.05)


#: Designation, C and C_0 [kN], f_0.
BALLS = (
    ("6003", 7.55, 3.35, 13.6), ("6004", 10.4, 5.05, 13.9), ("6005", 11.2, 5.85, 14.5), ("6007", 17.7, 10.3, 14.8),
    ("6008", 18.6, 11.5, 15.2), ("6009", 23.2, 15.1, 15.3), ("6010", 24.2, 16.6, 15.5), ("6014", 42, 31, 15.6),
    ("6015", 44, 33.5, 15.8), ("6016", 53, 40, 15.6), ("6017", 55, 43, 15.8), ("6018", 64.5, 49.5, 15.6),
    ("6019", 67, 54, 15.8), ("6020", 66.5, 54, 15.9), ("6201", 6.75, 2.75, 12.7), ("6202", 8.6, 3.6, 12.7),
    ("6203", 10.6, 4.6, 12.8), ("6204", 14.2, 6.65, 13.2), ("6206", 21.6, 11.3, 13.8), ("6209", 36, 20.4, 14.1),
    ("6210", 39, 23.2, 14.4), ("6211", 48, 29.2, 14.3), ("6212", 58, 36, 14.3), ("6213", 63.5, 40, 14.4),
    ("6214", 69, 44, 14.5), ("6215", 73.5, 49.5, 14.7), ("6217", 92, 64, 14.7), ("6218", 106, 71.5, 14.5),
    ("6219", 121, 82, 14.4), ("6220", 135, 93, 14.4), ("6300", 9.1, 3.5, 11.4), ("6301", 10.8, 4.2, 11.1),
    ("6303", 15, 6.55, 12.2), ("6305", 23.5, 10.9, 12.6), ("6307", 37, 19.1, 13.1), ("6308", 45, 24, 13.2),
    ("6309", 58.5, 32, 13.1), ("6311", 79.5, 45, 13.2), ("6312", 90.5, 52, 13.2), ("6313", 103, 60, 13.2),
    ("6314", 115, 68, 13.2), ("6315", 126, 77, 13.2), ("6316", 136, 86.5, 13.3),
)  # fmt: skip
#: Designation, C and C_0 [kN], F_w and E_w [mm]: bores above 45 mm, which no assumed share comes from.
CYLINDRICAL = (
    ("NU210", 53.5, 51, 60.4, 80.4), ("NU210EA", 81.5, 76.5, 59.5, 81.5), ("NU2210", 71, 73.5, 60.4, 80.4),
    ("NU2210EA", 98.5, 97, 59.5, 81.5), ("NU310", 96.5, 86, 65, 95), ("NU310EA", 130, 113, 65, 97),
    ("NU2310", 134, 131, 65, 95), ("NU2310EA", 192, 187, 65, 97), ("NU211", 64.5, 62.5, 66.5, 88.5),
    ("NU211EA", 102, 98.5, 66, 90), ("NU2211", 83.5, 87, 66.5, 88.5), ("NU2211EA", 120, 122, 66, 90),
    ("NU311", 123, 111, 70.5, 104.5), ("NU311EA", 162, 143, 70.5, 106.5), ("NU2311", 164, 162, 70.5, 104.5),
    ("NU2311EA", 238, 233, 70.5, 106.5), ("NU212", 76, 75, 73.5, 97.5), ("NU212EA", 115, 107, 72, 100),
    ("NU2212", 107, 116, 73.5, 97.5), ("NU2212EA", 155, 157, 72, 100), ("NU312", 137, 126, 77, 113),
    ("NU312EA", 177, 157, 77, 115), ("NU2312", 187, 188, 77, 113), ("NU2312EA", 263, 262, 77, 115),
    ("NU213", 93, 94.5, 79.6, 105.6), ("NU213EA", 127, 119, 78.5, 108.5), ("NU2213", 133, 149, 79.6, 105.6),
    ("NU2213EA", 176, 181, 78.5, 108.5), ("NU313", 150, 139, 83.5, 121.5), ("NU313EA", 213, 191, 82.5, 124.5),
    ("NU2313", 208, 212, 83.5, 121.5), ("NU2313EA", 293, 287, 82.5, 124.5), ("NU214", 92.5, 95, 84.5, 110.5),
    ("NU214EA", 140, 137, 83.5, 113.5), ("NU2214", 132, 151, 84.5, 110.5), ("NU2214EA", 184, 194, 83.5, 113.5),
    ("NU314", 175, 168, 90, 130), ("NU314EA", 242, 222, 89, 133), ("NU2314", 247, 262, 90, 130),
    ("NU2314EA", 325, 325, 89, 133), ("NU215", 107, 111, 88.5, 116.5), ("NU215EA", 154, 156, 88.5, 118.5),
    ("NU2215", 144, 162, 88.5, 116.5), ("NU2215EA", 191, 207, 88.5, 118.5), ("NU315", 211, 205, 95.5, 139.5),
    ("NU315EA", 284, 263, 95, 143), ("NU2315", 286, 300, 95.5, 139.5), ("NU2315EA", 390, 395, 95, 143),
)  # fmt: skip


def printed_balls() -> list[tuple[CatalogueBearing, RollingBearing]]:
    """C_0/f_0 = Z D_w^2 has one Z for which f_0 belongs to D_w/D_pw; grooves are not printed: 0.52 and 0.53."""
    found = []
    for name, c, c_0, factor in BALLS:
        known = envelope_of(name)
        pitch = 0.5 * (known.bore + known.outside_diameter)

        sizes = {count: math.sqrt(c_0 / factor / count * 1e-3) for count in range(5, 18)}
        made = [RollingBearing("ball", count, size, pitch, 0.0, (0.52, 0.53)) for count, size in sizes.items()
                if size < pitch * math.sin(math.pi / count)]  # fmt: skip
        fits = [abs(static_rating(one) / (c_0 * 1e3) - 1.0) for one in made]
        assert min(fits) < 0.016  # f_0 is rounded, the pitch diameter is only near the mean of d and D
        size = known.bore, known.outside_diameter, known.width
        found.append((CatalogueBearing("ball", *size, c * 1e3, c_0 * 1e3), made[int(np.argmin(fits))]))
    return found


def printed_rollers() -> list[tuple[CatalogueBearing, RollingBearing]]:
    """Diameter and pitch circle are printed, C_0 gives Z L; the stiffness hardly depends on Z (L^(-1/9))."""
    found = []
    for name, c, c_0, inner, outer in CYLINDRICAL:
        known = envelope_of(name.replace("EA", ""))
        size, pitch = 0.5e-3 * (outer - inner), 0.5e-3 * (outer + inner)
        count = int(0.85 * math.pi / math.asin(size / pitch))
        unit = RollingBearing("roller", count, size, pitch, roller_length=1e-3)
        made = RollingBearing("roller", count, size, pitch, roller_length=c_0 / static_rating(unit))
        envelope = known.bore, known.outside_diameter, known.width
        found.append((CatalogueBearing("cylindrical", *envelope, c * 1e3, c_0 * 1e3), made))
    return found


@pytest.mark.parametrize("without", [(), ("static_rating",), ("static_rating", "dynamic_rating")])
@pytest.mark.parametrize(("known", "count", "useful"), [(printed_balls, 43, 0.22), (printed_rollers, 48, 0.4)])
def test_estimates_of_printed_insides_are_within_the_stated_error(known, count, useful, without):
    shares = []
    for printed, made in known():
        estimated = replace(printed, **dict.fromkeys(without))
        ratio = estimated.inside.count * estimated.inside.constant / (made.count * made.constant)
        shares.append(abs(ratio ** (1.0 / made.exponent) - 1.0) / estimated.error)
        assert estimated.error < useful
    assert len(shares) == count
    assert max(shares) < 1.0


@pytest.mark.parametrize(("known", "low", "high"), [(printed_balls, 0.92, 1.16), (printed_rollers, 0.72, 1.27)])
def test_printed_ratings_are_within_the_error_of_those_that_a_designation_gives(known, low, high):
    """C without any rating; no printed C or C_0 is taken for that of another designation."""
    ratios = []
    for printed, _ in known():
        bare = replace(printed, dynamic_rating=None, static_rating=None)
        ratios.append(printed.dynamic_rating / bare.estimated_rating)
        assert abs(ratios[-1] - 1.0) < printed.rating_error
        given = {"dynamic_rating": printed.dynamic_rating, "static_rating": printed.static_rating}
        assert printed.misfits(**given) == ()
        # with C_0 the estimate is no worse
        by_static = printed.dynamic_rating / replace(printed, dynamic_rating=None).estimated_rating
        assert abs(by_static - 1.0) < printed.rating_error
    assert (min(ratios), max(ratios)) == (pytest.approx(low, abs=0.01), pytest.approx(high, abs=0.01))


#: C_0 [kN] of SKF, General Catalogue, from the first bore number on (0: not printed); its C is in `printed_ratings`.
STATIC = {
    "160": (2, (2.85, 3.25, 4.05, 4.75, 7.35, 8.15, 9.15, 10.8, 11.4, 14, 15, 16.6, 25, 27, 31.5, 33.5, 39, 41.5,
        44)),
    "64": (3, (10.8, 15, 19.3, 23.6, 31, 36.5, 45, 52, 62, 69.5, 78, 104, 114, 125, 137, 150)),
    "72": (0, (3.35, 3.8, 5.1, 5.85, 8.15, 10, 15.6, 20.8, 26, 28.5, 31, 40, 50, 54, 64, 64, 75, 90, 104, 118,
        134)),
    "73": (2, (6.7, 8.3, 10, 15.3, 21.2, 26.5, 32.5, 40.5, 51, 60, 76.5, 86.5, 98, 104, 118, 132, 146, 163, 208)),
    "302": (3, (18.6, 28, 33.5, 44, 56, 68, 76.5, 91.5, 106, 114, 134, 156, 176, 183, 220, 245, 275, 320)),
    "303": (3, (25, 32.5, 43, 56, 73.5, 95, 120, 140, 163, 196, 228, 260, 290, 320, 365, 400, 0, 490)),
    "313": (5, (40, 50, 67, 81.5, 102, 120, 137, 166, 193, 220, 245, 265, 285, 315, 355)),
    "320": (4, (27, 32.5, 44, 54, 71, 80, 88, 116, 122, 127, 153, 163, 216, 224, 270, 270, 280)),
    "322": (6, (57, 78, 86.5, 98, 100, 129, 160, 193, 208, 212, 245, 285, 340, 390, 440)),
    "323": (3, (33.5, 45.5, 63, 85, 106, 140, 170, 212, 250, 290, 335, 380, 440, 500, 530, 610, 670, 780)),
    "222": (5, (44, 60, 85, 90, 98, 108, 127, 166, 216, 228, 240, 270, 325, 375, 450, 490)),
    "223": (8, (140, 183, 224, 280, 335, 360, 430, 475, 540, 620, 695, 765, 950)),
}  # fmt: skip
#: Designation, C and C_0 [kN] of NSK, Rolling Bearings.
SPHERICAL = (
    ("22205", 37.5, 37), ("22206", 50, 50), ("22207", 69, 71), ("22208", 90.5, 99.5), ("22209", 94.5, 111),
    ("22210", 99, 119), ("22211", 119, 144), ("22212", 142, 174), ("22213", 177, 230), ("22214", 180, 232),
    ("22215", 190, 244), ("22216", 212, 275), ("22217", 250, 325), ("22218", 289, 395), ("22219", 330, 450),
    ("22220", 365, 490), ("22308", 136, 153), ("22309", 166, 195), ("22310", 197, 234), ("22311", 234, 292),
    ("22312", 271, 340), ("22313", 300, 380), ("22314", 340, 435), ("22315", 390, 505), ("22316", 435, 565),
    ("22317", 480, 630), ("22318", 535, 705), ("22319", 590, 780), ("22320", 690, 930),
)  # fmt: skip


def other_types() -> list[tuple[str, float, float]]:
    """Designation, C and C_0 [N] of the series besides 60, 62, 63 and cylindrical ones."""
    rows = [
        (f"{series}{first + n:02d}", printed_rating(series, first + n), rated * 1e3)
        for series, (first, ratings) in STATIC.items() for n, rated in enumerate(ratings) if rated
    ]  # fmt: skip
    return rows + [(name, c * 1e3, c_0 * 1e3) for name, c, c_0 in SPHERICAL]


def test_ratings_of_other_series_are_within_the_error_of_those_that_a_designation_gives():
    """Of two makers, and C of ISO 281 from an inside with the printed C_0: both belong to one bearing."""
    rows = other_types()
    assert len(rows) > 200
    for name, c, c_0 in rows:
        one = envelope_of(name)
        bare = CatalogueBearing(
            one.kind, one.bore, one.outside_diameter, one.width, contact_angle=one.contact_angle or None
        )
        assert abs(c / bare.estimated_rating - 1.0) < bare.rating_error, name
        assert bare.misfits(dynamic_rating=c, static_rating=c_0) == (), name
        by_static = replace(bare, static_rating=c_0).estimated_rating
        assert abs(c / by_static - 1.0) < 1.25 * bare.rating_error, name  # thin rings of 160: b_m 1.2 times the usual


def test_a_c_printed_by_one_maker_is_within_the_error_of_an_estimate_and_of_another_maker():
    """SKF against NTN (60, 62, 63, NU) and NSK (222, 223): what is said where the maker is not known."""
    others = [(name, c) for name, c, _, _ in BALLS] + [(name.replace("EA", ""), c) for name, c, _, _, _ in CYLINDRICAL]
    for name, c in [*others, *((name, c) for name, c, _ in SPHERICAL)]:
        one = envelope_of(name)
        bare = CatalogueBearing(
            one.kind, one.bore, one.outside_diameter, one.width, contact_angle=one.contact_angle or None
        )
        assert abs(c * 1e3 / catalogue_rating(name) - 1.0) < bare.rating_error, name
