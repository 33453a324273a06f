"""Small parts of gears' solutions and of designed loads by the laws that they stand for; answers made up."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.plane.engagement import Engagement
from fegear.contact.wide import maker
from fegear.design.loading import Ramp
from fegear.fem.plane import gear as plane_gear
from fegear.fem.plane import outline_motion
from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.imported_mesh import _check_boundary
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.outline_motion import OutlineMotion
from fegear.fem.revolved_body import RevolvedBody, _basis
from fegear.fem.solid.body_modes import _cuts
from fegear.fem.solid.extruded import with_stations
from fegear.fem.solid.face import face_functions
from fegear.fem.solid.influence import SolidInfluence
from fegear.fem.solid.slices import plane_compliance
from fegear.fem.solid.tooth_over_holes import as_if_all_were
from fegear.results.pair.flank_surface_data import ShownSurface
from fegear.results.pair.mesh_stiffness_data import MeshStiffnessData


# ---- designed loads --------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("slope", "exponent"), [(1.0, None), (0.3, None), (2.0, None), (1.0, 3), (0.4, 5), (2.5, 7)])
def test_the_slope_of_a_loading_is_the_derivative_of_its_load_and_what_it_is_named_by_at_its_start(slope, exponent):
    one = Ramp(slope=slope, exponent=exponent)
    x = np.linspace(-0.99, 0.99, 23)
    by_differences = (one.load(x + 1e-6) - one.load(x - 1e-6)) / 2e-6
    np.testing.assert_allclose(one.slope_at(x), by_differences, atol=1e-8)
    np.testing.assert_allclose(one.slope_at([-1.0, 1.0]), [slope, slope], atol=1e-12)
    np.testing.assert_allclose(one.load([-3.0, -1.0, 0.0, 1.0, 3.0]), [-1.0, -1.0, 0.0, 1.0, 1.0], atol=1e-12)


# ---- stations and cuts along the face --------------------------------------------------------------------------------
def test_stations_give_way_to_those_that_are_wanted_near_them():
    stations = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    found = with_stations(stations, [2.2, 0.5, 3.26, 2.2, 4.2, 7.0, -0.3])
    np.testing.assert_allclose(found, [0.0, 0.5, 1.0, 2.2, 3.0, 3.26, 4.2])


def test_beside_each_end_of_a_web_there_is_a_cut_unless_something_ends_there():
    body = SimpleNamespace(web=(-1.0, 3.0), ends=(-1.0, 3.0, -5.0, 5.0))
    plain = _cuts(body, 20.0)
    short = plain[5] + 1.0
    assert plain[:4] == [-1.0, 3.0, -5.0, 5.0]
    np.testing.assert_allclose(plain[4:], [-1.0 - short, -1.0 + short, 3.0 - short, 3.0 + short])
    assert 0.0 < short < 1.0
    near = SimpleNamespace(web=(-1.0, 3.0), ends=(-1.0, 3.0, -1.0 - 1.2 * short, 5.0))
    np.testing.assert_allclose(_cuts(near, 20.0)[4:], [-1.0 + short, 3.0 - short, 3.0 + short])
    np.testing.assert_allclose(_cuts(body, 2.0 * (3.0 + short))[4:], [-1.0 - short, -1.0 + short, 3.0 - short])


# ---- errors and means ------------------------------------------------------------------------------------------------
def estimate(off, scatter=0.0, beside=0.97, reach=1):
    """Neighbours that give way nearly as the tooth itself, by the finer solution more."""
    noise = scatter * np.array([[1.0, -1.0, 1.0, -1.0], [-1.0, 1.0, -1.0, 1.0]])

    def neighbour(more):
        return lambda k, p, q, patch: np.full(4, beside) + (noise[0 if k == 1 else 1] + off if more else 0.0)

    own = np.ones(4)
    return SimpleNamespace(
        fine=SimpleNamespace(reach=reach, neighbour=neighbour(True), self_compliance=lambda r, patch, b: own),
        coarse=SimpleNamespace(neighbour=neighbour(False)), _samples=np.arange(4.0), patch=0.1,
    )  # fmt: skip


@pytest.mark.parametrize("off", [0.05, -0.05])
def test_all_teeth_turn_by_what_their_neighbours_have_in_common_less_their_scatter(off):
    turned = Estimate._turned.func
    assert turned(estimate(off)) == pytest.approx(off)
    some = turned(estimate(off, scatter=0.001))
    assert 0.0 < abs(some) < abs(off)
    assert math.copysign(1.0, some) == math.copysign(1.0, off)
    assert turned(estimate(off, scatter=1.0)) == 0.0
    assert turned(estimate(off, beside=1e-4)) == 0.0
    assert turned(estimate(off, reach=0)) == 0.0


def test_a_check_of_the_own_compliance_is_the_work_of_the_contact_s_own_pressure():
    loads = np.array([[0.5, 0.5, 0.0], [0.0, 0.25, 0.75]])
    compliance = np.array([[4.0, 1.0, 0.0], [1.0, 5.0, 2.0], [0.0, 2.0, 6.0]])
    one = SimpleNamespace(
        place=lambda radius, width: (radius, width), compliance={0: compliance}, log_slope=0.8,
        flank=SimpleNamespace(patches=lambda arc, width: loads.T if arc == "r" and width == "b" else None),
    )  # fmt: skip
    one.flank = SimpleNamespace(patches=lambda arc, width: loads.T if (arc, width) == ("r", "b") else None)
    found = Influence.mean_compliance(one, "r", "b")
    np.testing.assert_allclose(found, [row @ compliance @ row + 0.2 for row in loads])


def test_teeth_on_pins_are_said_in_the_gear_s_own_units(monkeypatch):
    asked = []

    def over(fine, radius, patch, half_width):
        asked.append((fine, radius.tolist(), patch, half_width.tolist()))
        return {"c_self": np.array([[6.0]]), "root_tension": np.array([[8.0]]), "root_compression": np.array([[-4.0]])}

    monkeypatch.setattr(plane_gear, "over_the_teeth", over)
    one = SimpleNamespace(
        fine="fine", settings=SimpleNamespace(patch_half_width=0.18), _modules=lambda radius: np.array(radius) / 2e-3,
        gear=SimpleNamespace(module=2e-3, material=SimpleNamespace(young_modulus=3.0)),
    )  # fmt: skip
    found = GearInfluence.over_the_teeth(one, [0.04], [1e-4])
    assert asked == [("fine", [20.0], 0.18, [0.05])]
    assert {key: value.tolist() for key, value in found.items()} == {
        "c_self": [[2.0]], "root_tension": [[4000.0]], "root_compression": [[-2000.0]],
    }  # fmt: skip


def test_slices_err_by_a_share_of_both_stations_own_compliance():
    known = np.array([[4.0, 1.0], [1.0, 9.0]])
    one = SimpleNamespace(
        settings=SimpleNamespace(source="slices"), error={"contact": 0.1}, contact_compliance=lambda *given: known
    )
    np.testing.assert_allclose(SolidInfluence.contact_error(one, [1, 2], [0, 1], 0.1), [[0.4, 0.6], [0.6, 0.9]])
    bare = SimpleNamespace(settings=SimpleNamespace(source="solid"), coarse=None)
    found = SolidInfluence.contact_error(bare, [1.0, 2.0], [0.0, 1.0], 0.1)
    assert found.shape == (2, 2)
    assert np.isnan(found).all()


@dataclass(frozen=True)
class Holed:
    compliance: dict
    displacement: dict
    holed: object


def test_a_gear_all_of_whose_teeth_stand_as_one_does_deflects_on_both_sides_as_on_average():
    apart = {-1: np.array([[0.1, 0.2], [0.3, 0.4]]), 0: np.zeros((2, 2)), 1: np.array([[1.0, 2.0], [3.0, 4.0]])}
    holes = SimpleNamespace(flank_apart=lambda k, n: n * apart[k], fillet_apart=lambda k, n, side: n * 1.0)
    own = {k: np.full((2, 2), 10.0 + k) for k in (-1, 0, 1)}
    found = as_if_all_were(Holed(own, {(0, "tension"): 5.0}, holes), 3)
    for k in (-1, 0, 1):
        np.testing.assert_allclose(found.compliance[k], found.compliance[-k].T)
    before, after = 9.0 + 3.0 * apart[-1], 11.0 + 3.0 * apart[1]
    np.testing.assert_allclose(found.compliance[1], 0.5 * (after + before.T))
    assert (found.displacement, found.holed) == ({(0, "tension"): 8.0}, None)


@pytest.mark.parametrize("width", [1.0, 4.0])
def test_a_plane_section_s_compliance_is_that_of_loads_that_are_even_over_its_width(width):
    """Of nodes and functions along the face: the work of functions' integrals, for each unit of width."""
    face = face_functions(width, 3)
    z, weight = np.polynomial.legendre.leggauss(8)
    whole = face.values(0.5 * width * z) @ (0.5 * width * weight)
    each = np.random.default_rng(2).standard_normal((2, face.count, 2, face.count))
    plane = SimpleNamespace(
        face=face, width=width, flank=SimpleNamespace(nodes=2), compliance={1: each.reshape(2 * face.count, -1)}
    )
    wanted = np.array([[whole @ each[i, :, j] @ whole for j in range(2)] for i in range(2)]) / width
    np.testing.assert_allclose(plane_compliance(plane)[1], wanted, rtol=1e-12)


# ---- pairs -----------------------------------------------------------------------------------------------------------
def test_an_exchanged_engagement_takes_reliefs_and_spacing_along():
    one = SimpleNamespace(
        compliance=SimpleNamespace(reversed=lambda: "reversed"), driver_relief="r1", driven_relief="r2",
        driver_spacing="s1", driven_spacing="s2", corner_contact=True, driver_odd="o1", driven_odd="o2",
    )  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fegear.contact.plane.engagement.Engagement", lambda *given: given)
        assert Engagement.reversed(one) == ("reversed", "r2", "r1", "s2", "s1", True, "o2", "o1")


@pytest.mark.parametrize("enough", [1.0, 2.0, 1e9])
def test_edges_are_followed_farther_until_none_of_the_last_bears(enough, monkeypatch):
    @dataclass(frozen=True)
    class Flanks:
        most_gap: float

        def compliance(self, about):
            return about

        def solve(self, loads, gaps, known):
            assert (loads, gaps, known) == ((5.0, 9.0), "gaps", 7.0)
            return SimpleNamespace(reaches_the_last_edges=self.most_gap < enough, gap=self.most_gap)

    monkeypatch.setattr(maker, "FlankPair", lambda *given, most_gap, **how: Flanks(most_gap))
    monkeypatch.setattr(maker, "as_specified", lambda spec, bare: bare)
    monkeypatch.setattr(maker, "open_gaps", lambda spec: "gaps")
    monkeypatch.setattr(maker, "usual_gap", lambda placed, load: 0.5 if load == 9.0 else None)
    spec = SimpleNamespace(
        placed=None, panel=0.1, face=SimpleNamespace(positions=4), corner_contact=True, loads=(5.0, 9.0), nominal=7.0
    )
    flanks, _, found = maker.load_flanks(spec, None, None)
    assert flanks.most_gap == found.gap
    assert flanks.most_gap == (enough if enough < 1e9 else 0.5 * 2.0**maker._LONGER_EDGES)


# ---- what is shown ---------------------------------------------------------------------------------------------------
def test_quantities_of_a_surface_stand_in_rows_where_flanks_touch():
    load = np.array([[1.0, np.nan, 3.0], [np.nan, 5.0, 6.0]])
    computed = SimpleNamespace(
        line_load=load, x=np.array([10.0, 20.0, 30.0]), z=np.array([-1.0, 1.0]), speed=np.array([7.0, 8.0, 9.0]),
        ratio=np.array([[1.0, 2.0, 1e9], [3.0, 4.0, 5.0]]), least_ratio=1.0,
    )  # fmt: skip
    one = SimpleNamespace(computed=computed)
    for key, wanted in {
        "x": [10.0, 30.0, 20.0, 30.0], "z": [-1.0, -1.0, 1.0, 1.0], "line_load": [1.0, 3.0, 5.0, 6.0],
        "speed": [7.0, 9.0, 8.0, 9.0],
    }.items():  # fmt: skip
        assert ShownSurface.touching(one, key).tolist() == wanted
    drawn = ShownSurface.mapped_ratio.fget(one)
    assert drawn.shape == (3, 2)
    np.testing.assert_array_equal(drawn[:2], [[1.0, 3.0], [2.0, 4.0]])
    assert math.isnan(drawn[2, 0])


def test_under_every_load_there_are_the_means_of_stiffness_and_lever():
    found = SimpleNamespace(
        lever=np.array([[1.0, 2.0], [3.0, 6.0]]), mean=lambda values: values.mean(axis=0),
        mean_parameters=(np.array([5.0, 6.0]), np.array([0.1, 0.2]), np.array([0.3, 0.4])),
    )  # fmt: skip
    one = SimpleNamespace(
        found=found, _slope=10.0, flanks=SimpleNamespace(found=SimpleNamespace(load=np.array([70.0, 90.0])))
    )
    shown = MeshStiffnessData.over_loads.fget(one)
    values = [getattr(shown, name).tolist() for name in shown.__dataclass_fields__]
    assert values == [[70.0, 90.0], [5.0, 6.0], [0.1, 0.2], [0.3, 0.4], [20.0, 40.0]]


# ---- meshes of users -------------------------------------------------------------------------------------------------
def boundary(points, corners):
    said = []

    def refuse(rule, remedy):
        said.append(rule)
        return InputError("mesh", "file", rule, remedy)

    place = np.vstack([np.array(points, dtype=float).T, np.zeros(len(points))])
    try:
        _check_boundary(place, np.array(corners).T, lambda p: f"at {p[0]:g}, {p[1]:g}", refuse)
    except InputError:
        return said[0]
    return ""


def test_a_sector_is_one_part_whose_edges_belong_to_two_elements_at_most():
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    assert boundary(square, [(0, 1, 2), (0, 2, 3)]) == ""
    assert boundary([*square, (2, 2)], [(0, 1, 2), (0, 2, 3), (0, 2, 4)]).startswith(
        "has edges between more than two elements (one at 0, 0)"
    )
    two = [*square, (5, 5), (6, 5), (6, 6)]
    assert boundary(two, [(0, 1, 2), (0, 2, 3), (4, 5, 6)]).startswith("has 1 holes or unconnected parts (one at 0, 0)")
    touching = [*square, (2, 1), (2, 2)]
    assert boundary(touching, [(0, 1, 2), (0, 2, 3), (2, 4, 5)]).startswith(
        "is connected by a single node only (at 1, 1)"
    )


# ---- bodies on shafts and moved outlines -----------------------------------------------------------------------------
@pytest.mark.parametrize("lean", [0.0, 0.3])
def test_elements_of_a_body_on_a_shaft_fill_rim_web_and_hub_and_end_where_these_do(lean):
    """Of the cross-section's area, wherever an inclined web lies, and with rows of nodes at the ends of the hub."""
    width, outer, rim, web, bore = 0.04, 0.1, 0.08, 0.04, 0.02
    body = RevolvedBody(
        outer, width, ((rim, -0.02, 0.02), (web, -0.006, 0.006), (bore, -0.017, 0.0185)), (-0.017, 0.0185), lean=lean
    )
    basis, seat, teeth = _basis(body, 1)
    mesh = basis.mesh
    x, y = (mesh.p[k][mesh.t] for k in range(2))
    area = 0.5 * np.abs((x[0] - x[2]) * (y[1] - y[3]) - (x[1] - x[3]) * (y[0] - y[2])).sum()
    assert area == pytest.approx((outer - rim) * width + (rim - web) * 0.012 + (web - bore) * 0.0355, rel=1e-6)
    place = basis.doflocs[:, seat]
    np.testing.assert_allclose(place[0], bore)
    assert (place[1, 0], place[1, -1]) == (pytest.approx(-0.017), pytest.approx(0.0185))
    tip = basis.doflocs[:, teeth]
    np.testing.assert_allclose(tip[0], outer)
    assert (tip[1, 0], tip[1, -1]) == (pytest.approx(-0.02), pytest.approx(0.02))
    assert (np.diff(place[1]) > 0.0).all()
    # The web's middle line leans by its tangent from the rim to the hub.
    in_web = (mesh.p[0] > web + 1e-6) & (mesh.p[0] < rim - 1e-6)
    for r in np.unique(np.round(mesh.p[0, in_web], 9)):
        at = mesh.p[1, np.abs(mesh.p[0] - r) < 1e-8]
        shift = lean * (rim - r)
        assert (at.min() - shift, at.max() - shift) == (pytest.approx(-0.006), pytest.approx(0.006))


@pytest.mark.parametrize(
    ("arc", "half_width", "patch", "wide"),
    [
        (5.0, 0.01, 0.18, 0.18),  # in the middle of the flank the mesh's own pressure
        (5.0, 0.3, 0.18, 0.3),  # which is no narrower than the contact
        (1.1, 0.01, 0.18, None),  # narrowed where the flank ends
        (1.0, 0.01, 0.18, 0.02),  # by no more than the corner's distance
    ],
)
def test_the_pressure_that_moves_an_outline_fits_on_the_flank(arc, half_width, patch, wide):
    asked = []

    def patches(at, width):
        asked.append((at.tolist(), width.tolist()))
        raise NotImplementedError

    flank = SimpleNamespace(flank_start=1.0, flank_end=9.0, arc_of_radius=lambda radius: radius, patches=patches)
    one = SimpleNamespace(influence=SimpleNamespace(flank=flank, corner_distance=0.02))
    with pytest.raises(NotImplementedError):
        OutlineMotion.displacement(one, np.array([arc]), patch, np.array([half_width]))
    (((at,), (width,)),) = asked
    assert at == max(arc, 1.02)
    if wide is None:
        assert 0.01 <= width <= at - 1.0
        assert width == pytest.approx(outline_motion._ROOM_SHARE * 0.1)
    else:
        assert width == pytest.approx(wide)
