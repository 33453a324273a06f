"""The bearing to change to where one does not last: it does, none below it does, and none is named where none does."""

import pytest

from fegear.shafts.designations import KNOWN, designation_of, envelope_of
from fegear.shafts.larger_bearing import larger_bearing, rating_of


@pytest.mark.parametrize("name", ["6206", "6006-2RS", "NU206", "NJ 2208 ECP", "30206", "6310"])
@pytest.mark.parametrize("times", [1.3, 2.0, 8.0])
def test_it_is_the_smallest_that_lasts(name, times):
    radial, axial = 3000.0, 0.0 if name.startswith("N") else 900.0
    present = envelope_of(name)
    own = max((key for key in KNOWN if name.replace(" ", "").startswith(key)), key=len)
    wanted = times * rating_of(own).revolutions(radial, axial)
    found = larger_bearing(name, radial, axial, wanted)
    letters = own.rstrip("0123456789")
    like = {
        key: one for key, one in KNOWN.items()
        if one.kind == present.kind and key.rstrip("0123456789") == letters
        and rating_of(key).revolutions(radial, axial) >= wanted
    }  # fmt: skip
    of_bore = {key for key, one in like.items() if one.bore == present.bore}
    of_series = {key for key, one in like.items() if key[:-2] == own[:-2] and one.bore > present.bore}
    if not of_bore | of_series:
        assert found is None
        return
    assert found is not None
    assert found.revolutions >= wanted
    assert found.same_bore is bool(of_bore)
    if of_bore:
        assert found.designation == min(of_bore, key=lambda key: (rating_of(key).dynamic_rating, key))
    else:
        assert found.designation == min(of_series, key=lambda key: KNOWN[key].bore)


def test_by_hand():
    # 6206 with P = 3 kN: C = 3 kN (L/10^6)^(1/3); 6306 is the next of bore 30 mm, then 6207 of the series
    enough = rating_of("6306").revolutions(3000.0, 0.0)
    assert larger_bearing("6206-2Z/C3", 3000.0, 0.0, 0.999 * enough).designation == "6306"
    further = larger_bearing("6206", 3000.0, 0.0, 1.001 * enough)
    assert not further.same_bore
    assert further.designation == next(
        f"62{n:02d}" for n in range(7, 21) if rating_of(f"62{n:02d}").revolutions(3000.0, 0.0) >= 1.001 * enough
    )
    assert larger_bearing("6206", 3e6, 0.0, 1e9) is None
    assert larger_bearing("7206", 3e3, 0.0, 1e6) is None  # a series that is not tabulated


def test_an_envelope_has_the_designation_that_has_it():
    one = KNOWN["6305"]
    assert designation_of("ball", one.bore, one.outside_diameter, one.width) == "6305"
    assert designation_of("ball", one.bore, one.outside_diameter, 1.01 * one.width) == ""
    roller = KNOWN["NU204"]  # N, NJ and NUP share its envelope and its rating
    assert designation_of("cylindrical", roller.bore, roller.outside_diameter, roller.width).endswith("204")
