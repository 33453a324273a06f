"""Where torque enters a shaft beside its gears: couplings and bevel gears, these in the middle of their face."""

from __future__ import annotations

from types import SimpleNamespace as Space

import pytest

from fegear.exchange.rexs.places import COUPLINGS, joints_of, middle_on_shaft

SHAFT, BEVEL, OTHER = Space(id=1, type="shaft"), Space(id=2, type="bevel_gear"), Space(id=3, type="shaft")


def model(version="1.4", **parts):
    """What a model says: of vectors, words and numbers by component and name; of links by component and way."""
    known = {"vectors": {}, "words": {}, "numbers": {}, "links": {}, "yes": {}} | parts

    def link(component, *way):
        return known["links"].get((component.id, way), [])

    def needed(component, quantity, name):
        assert quantity == "length"
        return known["numbers"][component.id, name]

    def number(component, quantity, name):
        assert quantity == "length"
        return known["numbers"].get((component.id, name))

    return Space(
        model=Space(version=version), across=known.get("across", ()), linked=link, needed=needed, number=number,
        vector=lambda one, name: known["vectors"].get((one.id, name)),
        word=lambda one, name: known["words"].get((one.id, name)),
        yes=lambda one, name: known["yes"].get((one.id, name)),
    )  # fmt: skip


VECTORS = {(1, "support_vector"): (0.1, 0.0, 0.0), (2, "support_vector"): (0.16, 0.2, 0.3)}


def test_the_middle_of_a_face_is_where_its_support_vector_leads_from_that_of_its_shaft():
    said = model(vectors=VECTORS)
    assert middle_on_shaft(said, BEVEL, SHAFT) == pytest.approx(0.06)
    turned = model(vectors=VECTORS | {(1, "u_axis_vector"): (-1.0, 0.0, 0.0)})
    assert middle_on_shaft(turned, BEVEL, SHAFT) == pytest.approx(-0.06)
    # vectors from two origins cannot be compared; the place on the shaft can
    apart = {(2, "reference_component_for_position"): "other"}
    said = model(vectors=VECTORS, words=apart, numbers={(2, "u_coordinate_on_shaft"): 0.05})
    assert middle_on_shaft(said, BEVEL, SHAFT) == pytest.approx(0.05)
    assert middle_on_shaft(model(vectors=VECTORS, words=apart), BEVEL, SHAFT) is None
    assert middle_on_shaft(model(), BEVEL, SHAFT) is None


@pytest.mark.parametrize(("version", "middle"), [("1.0", 0.055), ("1.4", 0.05)])
def test_the_first_version_says_where_a_face_begins(version, middle):
    said = model(version, numbers={(2, "u_coordinate_on_shaft"): 0.05, (2, "face_width"): 0.01})
    assert middle_on_shaft(said, BEVEL, SHAFT) == pytest.approx(middle)


def test_joints_are_couplings_in_gear_to_shafts_and_bevel_gears_that_have_a_place():
    first, second, loose, casing = (Space(id=n, type="coupling") for n in (11, 12, 13, 14))
    links = {
        (1, ("inner_part", "side", "assembly", *COUPLINGS)): [first, loose, casing],
        (1, ("outer_part", "side", "assembly", *COUPLINGS)): [second],
        (11, ("assembly", "side", "outer_part", "shaft")): [OTHER],
        (13, ("assembly", "side", "outer_part", "shaft")): [OTHER],
        (12, ("assembly", "side", "inner_part", "shaft")): [OTHER],
        (1, ("assembly", "assembly", "part", "bevel_gear")): [BEVEL, Space(id=4, type="bevel_gear")],
    }
    numbers = {
        (11, "u_coordinate_on_shaft_inner_side"): 0.01, (12, "u_coordinate_on_shaft_outer_side"): 0.3,
        (13, "u_coordinate_on_shaft_inner_side"): 0.02, (14, "u_coordinate_on_shaft_inner_side"): 0.03,
    }  # fmt: skip
    said = model(links=links, numbers=numbers, vectors=VECTORS, yes={(13, "is_engaged"): False})
    assert joints_of(said, SHAFT) == pytest.approx((0.01, 0.3, 0.06))  # of bevel 4 nothing is said
    engaged = model(links=links, numbers=numbers, vectors=VECTORS, yes={(13, "is_engaged"): True})
    assert joints_of(engaged, SHAFT) == pytest.approx((0.01, 0.02, 0.3, 0.06))
    assert joints_of(model(), SHAFT) == ()
