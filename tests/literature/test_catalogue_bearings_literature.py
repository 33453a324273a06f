"""Insides of bearings that are published, and ratings printed for the same designation.

Sources: number, diameter and pitch diameter of the balls of 6205 and 6203 from the bearing data center of Case Western
Reserve University (0.3126 and 0.2656 in), of UER204 from Wang, Lei, Li, Li, IEEE Transactions on Reliability 69 (2020)
401-412 (its inside is that of a 6204), of a bearing with the envelope of 6305 from the repository minzhun/ISO16281.
C and C_0 of 6205, 6305 as printed in the model of a gearbox published with REXS; of 6203 and 6204 of the catalogues.
"""

import pytest

from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import envelope_of
from fegear.shafts.load_ratings import dynamic_rating, static_rating
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
