"""Designed flanks as their sheet reads them: a design made up, everything shown of it found from its numbers."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.shown import shows
from fegear.design.flanks.families import FamilyBest
from fegear.design.flanks.flank_tolerance import FlankTolerance, LeadTolerance
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.judge import Judged, Number
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.engine.sheet.seen import Seen
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.relief import flank_design
from fegear.results.relief import flank_design_answer as answer
from fegear.results.relief import flank_design_sheet as sheet
from fegear.results.relief.flank_design_data import FlankDesignData, FlankDesignInputs, FlanksShown
from fegear.results.relief.ground_flank_keys import keys_of
from fegear.results.relief.lead_charts import lead_k_chart

RACK = BasicRack(1.0, 1.25, 0.38)
GEAR = Gear(Tooth(24, RACK), 2e-3, 0.01, face_width=0.02)
PAIR = GearPair(GEAR, replace(GEAR, tooth=Tooth(37, RACK)))
X = np.linspace(PAIR.x_start, PAIR.x_end, 5)
Z = np.linspace(-0.01, 0.01, 4)
#: A plane over both: interpolation has it exactly.
EXACT = 1e-6 * (3.0 + 200.0 * X[:, None] + 300.0 * Z[None, :])
RELIEFS = {
    "lead": GroundRelief(crowning=6e-6, slope=4e-6),
    "profile-and-lead": GroundRelief(10e-6, 1e-3, 20e-6, 1.5e-3, crowning=5e-6),
    "profile": GroundRelief(12e-6, 1e-3, 24e-6, 1.5e-3, tip_power=2.0),
}
ALLOWED = LeadTolerance(2e-6, 1e-6, 3e-6)


@dataclass(frozen=True)
class Mapped:
    """What is left over three misalignments and two loads."""

    left: float

    @property
    @shows("um", "peak-to-peak value", name="te_peak_to_peak")
    def peak_to_peak(self):
        return 1e-6 * self.left * np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])

    @property
    @shows("", "K_Hbeta")
    def face_load_factor(self):
        return 1.0 + self.left * np.array([[1.0, 3.0], [4.0, 2.0], [6.0, 5.0]])

    @property
    @shows("MPa", "pressure")
    def pressure(self):
        return 1e8 * self.left * np.array([[6.0, 5.0], [4.0, 3.0], [2.0, 1.0]])


def state(label, left, relief=None, most=None):
    """A way that leaves so many um at the first load, and half of it more at the second one."""

    def value(found):
        return Number(found, 0.01 * found)

    over = 1e-6 * left * np.array([1.0, 1.5])
    return SimpleNamespace(
        label=label, relief=relief, te=1e-6 * left * np.array([1.0, -0.5, 0.25]), modifications=2,
        judged=Judged(
            value(1e-6 * left), value(1.0 + left / 10.0), value(1e8 * left), value(2e-6 * left), value(3e-6 * left),
            value(2.0 + left / 10.0),
        ),
        over_peak_to_peak=over, over_first=0.4 * over, over_most=most, over_error=0.01 * over, over_mean=1.2 * over,
        mapped=Mapped(left),
    )  # fmt: skip


def shown(*, scattered=True, gear="both", weights=None, lead=ALLOWED):
    none, exact = state("no relief", 8.0), state("exact topography", 0.0)
    found = {
        label: FamilyBest(label, one, one, 1e-6, (one,), None, len(label), 2 * len(label), 3e-6, 1e-7, label != "lead")
        for label, one in RELIEFS.items()
    }
    ways = [state(label, left, RELIEFS[label], 1e-6 * left * np.array([3.0, 4.0]))
            for label, left in (("lead", 6.0), ("profile-and-lead", 1.0), ("profile", 1.9))]  # fmt: skip
    design = SimpleNamespace(
        states=(none, exact, *ways), unrelieved=none, exact=exact, best=ways[2], least=ways[1], chosen=(ways[2],),
        found=found, finer=0, unrelieved_most=None, scattered=scattered, x=X, z=Z,
        removal=EXACT, roll=np.array([0.0, 1e-3, 2e-3]),
        left_by=lambda one: one.judged.peak_to_peak.value,
        task=SimpleNamespace(
            load=1500.0, loads=(500.0, 1500.0), weights=weights, map_over_face=(-1e-6, 0.0, 1e-6),
            map_loads=(100.0, 200.0), deviation=5e-6,
            loading=SimpleNamespace(line_load=lambda x, z: 3.0 + 100.0 * x + 10.0 * z),
        ),
    )  # fmt: skip
    tolerance = FlankTolerance((TipTolerance(1e-6, 1e-4, 0.0), TipTolerance(3e-6, 1e-4, 0.0)), lead)
    asked = FlankDesignInputs(SimpleNamespace(gear=gear), "I", {"driver": "p", "driven": "w"}, None, tolerance)
    return FlanksShown(FlankDesignData(PAIR, design), asked)


@pytest.mark.parametrize(
    ("gear", "shares"), [("both", {"p": 0.5, "w": 0.5}), ("driver", {"p": 1.0}), ("driven", {"w": 1.0})]
)
def test_gears_share_the_topography(gear, shares):
    found = shown(gear=gear)
    assert (found.driver, found.load) == ("p", 1500.0)
    assert found.topography_depth == pytest.approx(EXACT.max() - EXACT.min())
    assert {one.gear for one in found.topographies} == set(shares)
    for one in found.topographies:
        member = "driver" if one.gear == "p" else "driven"
        assert one.removal == pytest.approx(shares[one.gear] * EXACT.ravel())
        assert one.x == pytest.approx(np.repeat(X, Z.size))
        assert one.roll_angle == pytest.approx(PAIR.roll_angle(one.x, member))
        assert one.diameter == pytest.approx(2.0 * PAIR.radius(one.x, member))
        height = np.tile(Z, X.size)
        assert one.z == pytest.approx(height + PAIR.face_height(member))
        assert one.line_load == pytest.approx(1500.0 * (3.0 + 100.0 * one.x + 10.0 * height))


def test_surfaces_profiles_and_leads_are_sections_of_one_removal_counted_from_its_least():
    found = shown()
    exact, profile = found.drawn
    assert (exact.relief, profile.relief) == ("exact topography", "profile")
    assert [way.relief for way in found.mapped] == ["no relief", "exact topography", "profile"]
    for way in found.drawn:
        assert (way.x[0], way.x[-1], way.z[0], way.z[-1]) == (X[0], X[-1], Z[0], Z[-1])
        assert way.roll_angle == pytest.approx(PAIR.roll_angle(way.x, "driver"))
        assert way.removal.shape == (way.z.size, way.x.size)
        assert way.removal.min() == 0.0
    plane = 1e-6 * (200.0 * (exact.x - X[0])[None, :] + 300.0 * (exact.z - Z[0])[:, None])
    np.testing.assert_allclose(exact.removal, plane, atol=1e-12)
    relief = RELIEFS["profile"].removal(PAIR, *np.meshgrid(profile.x, profile.z))
    np.testing.assert_allclose(profile.removal, relief - relief.min(), atol=1e-15)
    assert found.deepest == (0.0, pytest.approx(max(plane.max(), profile.removal.max())))
    assert found.highest("peak_to_peak") == pytest.approx(6.0 * 8e-6)
    # Sections: at -9 / 10, 0 and 9 / 10 of half the face, and after 1, 5 and 9 tenths of the path of contact.
    profiles, leads = exact.profiles, exact.leads
    assert [one.label for one in profiles] == ["z = -9 mm", "z = 0 mm", "z = 9 mm"]
    for one, height in zip(profiles, (-9e-3, 0.0, 9e-3), strict=True):
        np.testing.assert_allclose(one.removal, 1e-6 * (200.0 * (exact.x - X[0]) + 300.0 * (height - Z[0])), atol=1e-12)
        assert one.roll == pytest.approx(exact.roll_angle)
    for one, share in zip(leads, (0.1, 0.5, 0.9), strict=True):
        place = X[0] + share * (X[-1] - X[0])
        assert one.label == f"diameter {2e3 * float(PAIR.radius(place, 'driver')):.5g} mm"
        np.testing.assert_allclose(one.removal, 1e-6 * (200.0 * (place - X[0]) + 300.0 * (exact.z - Z[0])), atol=1e-12)
        assert one.z == pytest.approx(exact.z)


def test_a_way_has_the_numbers_of_its_state():
    found = shown()
    none, _, lead, both, _ = found.ways
    assert [way.unrelieved for way in found.ways] == [True, False, False, False, False]
    assert (none.best, lead.best.relief, both.word) == (None, RELIEFS["lead"], "profile_and_lead")
    assert lead.left == 6e-6
    assert lead.minus_mean.mean() == pytest.approx(0.0, abs=1e-20)
    assert np.ptp(lead.minus_mean) == pytest.approx(1.5 * 6e-6)
    assert lead.roll.tolist() == [0.0, 1e-3, 2e-3]
    assert (lead.over_face.tolist(), lead.load.tolist()) == ([-1e-6, 0.0, 1e-6], [100.0, 200.0])
    assert found.unproven == "lead"


@pytest.mark.parametrize("scattered", [True, False])
def test_what_every_way_leaves_stands_beside_each_other_the_last_lowest(scattered):
    found = shown(scattered=scattered)
    left = found.left
    order = np.array([1.9, 1.0, 6.0, 0.0, 8.0])
    assert left.place.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert left.peak_to_peak == pytest.approx(1e-6 * order)
    assert left.factor == pytest.approx(1.0 + order / 10.0)
    if scattered:
        assert left.mean == pytest.approx(2e-6 * order)
        assert left.worst == pytest.approx(2.0 + order / 10.0)
    else:
        assert (left.mean, left.worst) == (None, None)
    high, low = found.by_size
    assert [way.relief for way in high.ways] == ["no relief", "lead"]
    assert [way.relief for way in low.ways] == ["exact topography", "profile-and-lead", "profile"]
    with_scatter = "standard deviation 5 µm" in sheet._beside_caption(
        SimpleNamespace(data=found, said=lambda text: text)
    )
    assert with_scatter == scattered


@pytest.mark.parametrize(("weights", "shares"), [(None, [1.0, 1.0]), ((0.5, 2.0), [0.25, 1.0])])
def test_torques_have_what_every_way_leaves_and_at_most_of_those_that_are_ground(weights, shares):
    found = shown(weights=weights)
    for way in found.ways:
        one = found.over_range[way.relief]
        assert one.torque == pytest.approx(np.array([500.0, 1500.0]) * PAIR.driver.base_radius)
        assert one.weight == pytest.approx(shares)
        assert one.peak_to_peak == pytest.approx(way.left * np.array([1.0, 1.5]))
        assert one.first == pytest.approx(0.4 * one.peak_to_peak)
        assert one.mean == pytest.approx(1.2 * one.peak_to_peak)
        assert one.errors == pytest.approx(0.01 * one.peak_to_peak)
        assert (one.most is None) == (way.relief in ("no relief", "exact topography"))
    assert shown(scattered=False).over_range["lead"].mean is None
    seen = SimpleNamespace(data=found)
    torque, left = answer._left(seen, "lead")
    assert (torque.tolist(), left.tolist()) == (
        found.over_range["lead"].torque.tolist(), found.over_range["lead"].peak_to_peak.tolist()
    )  # fmt: skip
    one = {"lead": SimpleNamespace(torque=np.array([9.0]), peak_to_peak=np.array([7.0]))}
    data = SimpleNamespace(over_range=one, design=found.design, load=found.load, data=found.data)
    for over in (None, "spectrum"):
        torque, left = answer._left(SimpleNamespace(data=data, asked=SimpleNamespace(over=over)), "lead")
        assert torque == pytest.approx([9.0 if over else 1500.0 * PAIR.driver.base_radius])
        assert left.tolist() == [7.0 if over else 6e-6]


def test_rows_and_charts_begin_with_what_is_to_be_ground_then_by_what_is_left():
    found = shown()
    designs = list(dict.fromkeys(row.design for row in found.grinding))
    assert designs == ["profile", "profile-and-lead", "lead"]
    tips = [(row.gear, row.amount_tolerance) for row in found.grinding if row.design == "profile"]
    assert tips == [("p", 1e-6), ("w", 3e-6)]
    assert list(found.profile_charts) == ["profile", "profile-and-lead"]
    for label, both in found.profile_charts.items():
        assert [one.gear for one in both] == ["p", "w"]
        amounts = [RELIEFS[label].driver_tip, RELIEFS[label].driven_tip]
        assert [-one.profile.min() for one in both] == pytest.approx(amounts)
        assert [one.profile.min() - one.lower.min() for one in both] == pytest.approx([1e-6, 3e-6])
    assert list(found.lead_charts) == ["profile-and-lead", "lead"]
    assert [one.gear for one in found.lead_charts.values()] == ["p", "p"]
    assert shown(lead=None).lead_charts == {}
    chart = found.lead_charts["profile-and-lead"]
    axis = sheet_ordinate(chart)
    height = (chart.upper.max() - chart.lower.min()) * 1e6
    assert axis.limits[0] < chart.lower.min() * 1e6
    assert axis.limits[1] > chart.upper.max() * 1e6
    assert axis.limits[1] - axis.limits[0] == pytest.approx(height + 2.0 * (chart.lower.min() * 1e6 - axis.limits[0]))


@pytest.mark.parametrize("recommended", ["lead", "profile-and-lead", ""])
def test_lead_charts_say_which_of_them_is_recommended(recommended):
    """That of a design which the answer declines was drawn as the one to grind."""
    found = shown()
    found.__dict__["recommended"] = recommended
    assert [label for label, one in found.lead_charts.items() if one.recommended] == [recommended] * bool(recommended)
    seen = Seen(found, found.asked, "I")
    (figure,) = (one.made() for one in lead_k_chart("lead_charts").figures(seen))
    marked = [view for view in figure.views if "(recommended)" in view.panels[0].title]
    assert [view.label for view in marked] == [f"{recommended} (recommended)"] * bool(recommended)
    assert len(figure.views) == 2


def test_a_tip_relief_of_one_gear_only_has_its_charts():
    found = shown()
    only = GroundRelief(driven_tip=5e-6, driven_tip_length=1e-3)
    found.design.found["lead"] = replace(found.design.found["lead"], relief=only)
    assert [one.profile.min() * 1e6 for one in found.profile_charts["lead"]] == pytest.approx([0.0, -5.0])


def sheet_ordinate(chart):
    from fegear.results.relief.lead_charts import _ordinate

    return _ordinate(SimpleNamespace(one=chart))


def columns(table):
    return {column.name: column.si for column in table.columns}


def test_tables_have_a_row_for_every_way():
    found = shown()
    seen = Seen(found, found.asked, "I")
    tables = {table.name: table for one in sheet.FLANK_DESIGN_SHEET.tables for table in one.tables(seen)}
    ways = columns(tables["flank_designs_I"])
    left = np.array([8.0, 0.0, 6.0, 1.0, 1.9])
    assert list(ways["relief"]) == ["no relief", "exact topography", "lead", "profile-and-lead", "profile"]
    for name, values in (
        ("te_peak_to_peak", 1e-6 * left), ("K_Hbeta", 1.0 + left / 10.0), ("hertz_pressure", 1e8 * left),
        ("te_mean_over_scatter", 2e-6 * left), ("te_p95_over_scatter", 3e-6 * left),
        ("K_Hbeta_p95_over_scatter", 2.0 + left / 10.0),
    ):  # fmt: skip
        np.testing.assert_allclose(ways[name], values, atol=1e-15)
        np.testing.assert_allclose(ways[f"{name}_error"], 0.01 * values, atol=1e-15)
    assert ways["driver_tip"].tolist() == [0.0, 0.0, 0.0, 10e-6, 12e-6]
    assert ways["driven_tip_length"].tolist() == [0.0, 0.0, 0.0, 1.5e-3, 1.5e-3]
    assert ways["slope"].tolist() == [0.0, 0.0, 4e-6, 0.0, 0.0]
    assert ways["combinations"].tolist() == [0, 0, 4, 16, 7]
    assert ways["loaded_exactly"].tolist() == [0, 0, 8, 32, 14]
    assert ways["best_on_grid"].tolist() == [0.0, 0.0, 3e-6, 3e-6, 3e-6]
    (error,) = [one for name, one in ways.items() if name == "quick_error" or "screening" in name]
    assert np.isnan(error[:2]).all()
    assert (error[2:] == 1e-7).all()
    (proven,) = [one for name, one in ways.items() if "proven" in name]
    assert proven.tolist() == [1.0, 1.0, 0.0, 1.0, 1.0]
    maps = columns(tables["flank_map_I"])
    assert len(maps["relief"]) == 5 * 3 * 2
    np.testing.assert_allclose(
        maps["te_peak_to_peak"].reshape(5, 3, 2), np.stack([way.state.mapped.peak_to_peak for way in found.ways])
    )
    roll = columns(tables["flank_design_roll_I"])
    assert roll["te_profile_and_lead"].tolist() == found.ways[3].te.tolist()
    numbers = {value.name: value for one in sheet.FLANK_DESIGN_SHEET.values[1:] for value in one.values(seen)}
    assert numbers["I.profile.te_peak_to_peak"].si == pytest.approx(1.9e-6)
    assert numbers["I.profile.te_peak_to_peak"].si_error == pytest.approx(1.9e-8)
    assert numbers["I.lead.te_mean_over_scatter"].si == pytest.approx(12e-6)


def test_of_alignment_that_does_not_scatter_no_value_over_scatter_is_said():
    found = shown()
    found.design.task.deviation = 0.0
    seen = Seen(found, found.asked, "I")
    numbers = [value.name for one in sheet.FLANK_DESIGN_SHEET.values[1:] for value in one.values(seen)]
    assert len(numbers) == 5 * 3
    assert not any("scatter" in name for name in numbers)


@pytest.mark.parametrize("scattered", [True, False])
def test_figures_draw_what_every_way_leaves(scattered):
    found = shown(scattered=scattered)
    seen = Seen(found, found.asked, "I")
    figures = {one.name: one.made() for chart in sheet.FLANK_DESIGN_SHEET.figures for one in chart.figures(seen)}
    # Points of every way, the last one lowest: as specified, and over the scatter where there is any.
    left, factor = figures["flank_designs_I"].panels
    assert (left.x.log, factor.x.log) == (True, False)
    for panel, numbers in (
        (left, (found.left.peak_to_peak, found.left.mean)),
        (factor, (found.left.factor, found.left.worst)),
    ):
        assert len(panel.items) == 1 + scattered
        assert len({one.size for one in panel.items}) == 1
        for one, x in zip(panel.items, numbers, strict=False):
            scale = 1e6 if panel is left else 1.0
            np.testing.assert_allclose(one.x, scale * x)
            assert list(one.y) == [0.0, 1.0, 2.0, 3.0, 4.0]
        assert list(panel.y.categories) == ["profile", "profile and lead", "lead", "exact topography", "no relief"]
    roll = figures["flank_design_roll_I"].panels
    assert [panel.title for panel in roll] == [one.title for one in found.by_size]
    for panel, like in zip(roll, found.by_size, strict=True):
        for curve, way in zip(panel.items, like.ways, strict=True):
            np.testing.assert_allclose(curve.y, 1e6 * way.minus_mean)
            assert curve.name == f"{way.relief}: {way.left * 1e6:.3g} µm"
            assert (curve.role == "no relief") == (way.relief == "no relief")
    views = figures["flank_topography_I"].views
    assert [view.label for view in views] == ["exact topography", "profile"]
    for view, way in zip(views, found.drawn, strict=True):
        (surface,) = view.panels[0].items
        np.testing.assert_allclose(surface.z, 1e6 * way.removal)
        assert surface.limits == pytest.approx((0.0, 1e6 * found.deepest[1]))
    sections = figures["flank_charts_I"].panels
    assert [panel.title for panel in sections] == [
        f"{way}: {kind}" for way in ("exact topography", "profile") for kind in ("profile", "lead")
    ]
    for panel, wanted in zip(sections, (found.drawn[0].profiles, found.drawn[0].leads), strict=False):
        for curve, section in zip(panel.items, wanted, strict=True):
            np.testing.assert_allclose(curve.y, 1e6 * section.removal)
            assert (curve.name, curve.dash) == (section.label, "solid")
    maps = figures["flank_map_I"].views
    assert [view.label for view in maps] == ["no relief", "exact topography", "profile"]
    for view, way in zip(maps, found.mapped, strict=True):
        for panel, numbers, scale in zip(
            view.panels, (way.state.mapped.peak_to_peak, way.state.mapped.face_load_factor), (1e6, 1.0), strict=True
        ):
            (tiles,) = panel.items
            np.testing.assert_allclose(tiles.z, scale * numbers.T)


def test_keys_of_the_gears_are_said_also_for_one_gear_where_both_would_be_ground():
    found = shown()

    def keys(label):
        seen = SimpleNamespace(data=found, asked=found.asked, one=SimpleNamespace(label=label))
        return sheet._keys(seen)

    assert keys("lead").startswith("Pair I, lead: keys of the gears: gear.p.lead = ")
    assert "ground on" not in keys("lead")
    both = keys("profile")
    assert "gear.w.relief" in both
    assert " With the same gaps, ground on p only: " in both
    assert "gear.w" not in both.partition("ground on")[2]


def test_a_map_of_a_way_is_over_misalignment_and_load_with_one_scale(monkeypatch):
    over = sheet._tiles("peak_to_peak", "label", "title", 0.5)
    (tiles,) = over.lines
    found = shown()
    seen = SimpleNamespace(data=found, one=found.ways[2])
    assert tiles.si(seen).tolist() == found.ways[2].state.mapped.peak_to_peak.T.tolist()
    assert tiles.limits(seen) == (0.5, pytest.approx(48e-6))
    assert tiles.numbers  # few tiles: each bears its number


def test_a_design_is_made_of_the_flanks_without_relief_and_the_coarser_gears(monkeypatch):
    asked, bodies = (
        {},
        {"p": SimpleNamespace(fine="fine", coarse="coarse"), "w": SimpleNamespace(fine="w", coarse=None)},
    )
    apart = SimpleNamespace(shafts=SimpleNamespace(given="bent"))
    flanks = SimpleNamespace(pair=PAIR)
    found = SimpleNamespace(flanks=flanks, unrelieved=apart, nominal=300.0, known="known")
    monkeypatch.setattr(flank_design, "loaded_flanks", lambda upstream, name: found if name == "I" else None)
    monkeypatch.setattr(
        flank_design, "solid_solution_of", lambda upstream, gear: bodies[gear] if upstream == {} else None
    )
    monkeypatch.setattr(flank_design, "_task", lambda *given: given)
    monkeypatch.setattr(
        "fegear.design.flanks.flank_design.design_flanks", lambda *given: asked.update(given=given) or "design"
    )
    inputs = FlankDesignInputs("part", "I", {"driver": "p", "driven": "w"}, "over", "tolerance")
    data = flank_design._compute(inputs, {}, SimpleNamespace(progress="progress"))
    assert data == FlankDesignData(PAIR, "design", "bent")
    task = ("part", PAIR, 300.0, "over", "tolerance")
    assert asked["given"] == (flanks, {"driver": "coarse", "driven": "w"}, "known", apart, task, "progress")


def speaking(**more):
    """What sentences read, with torques of 11.28 and 33.83 N m."""
    found = shown(**more)
    d = found.design
    d.finer, d.decisive, d.ground = 0, (), d.states[2:]
    d.alike, d.within_tolerance = lambda state: False, lambda state: True
    d.left_under, d.worst_load = lambda state: state.over_peak_to_peak, lambda left: int(np.argmax(left))
    return Seen(found, found.asked, "I")


def test_sentences_say_what_is_ground_what_it_leaves_at_both_ends_and_within_its_tolerances():
    """Without relief 8 and 12 um are left, with the best 1.9 and 2.85, within its tolerances 5.7 and 7.6."""
    seen = speaking()
    ground, within, further = answer._grind(seen)
    assert "grind 12 µm from d " in ground
    assert " on gear p, 24 µm from d " in ground
    assert ground.endswith(
        "transmission error 12 -> 2.8 µm (within tolerances at most 7.6 µm) at 33.83 N m, 8 -> 1.9 µm (at most 5.7 µm) "
        "at 11.28 N m, peak to peak."
    )
    # 5.7 of 8 is more than 7.6 of 12.
    assert "at most 5.7 µm at 11.28 N m (8 µm without relief)" in within
    assert "± 1 µm on gear p, ± 3 µm on gear w" in within
    assert further.endswith(
        "profile-and-lead (2 modifications) is only 47 % better than profile (2), by modifications below their "
        "tolerances (5 ± 1 µm crowning)."
    )
    design = seen.data.design
    design.within_tolerance = lambda state: False
    assert list(answer._grind(seen))[-1].endswith(
        "is better than profile (2) as drawn (1.5, not 2.8 µm at 33.83 N m), but worse within its tolerances (at most "
        "4, not 7.6 µm at 33.83 N m)."
    )
    design.alike = lambda state: True
    assert list(answer._grind(seen))[-1].endswith("is only 47 % better than profile (2), within the estimated error.")
    design.least = design.best
    assert len(list(answer._grind(seen))) == 2
    design.best.over_most = None
    (only,) = answer._grind(seen)
    assert "tolerances" not in only
    design.best.over_most = 1e-6 * np.array([9.0, 13.0])  # more than without relief at both torques
    design.finer = 2
    lost, ground = answer._grind(seen)
    assert "the transmission error is smaller without relief at every torque: 12 µm at 33.83 N m" in lost
    assert "± 0.5 µm on gear p, ± 1.5 µm on gear w" in lost  # two classes finer
    assert ": without deviations grind 12 µm" in ground
    seen = speaking()  # where another way leaves less as drawn, that is the one without deviations
    design, best = seen.data.design, seen.data.design.best
    design.within_tolerance, design.finer = (lambda state: False), 2
    best.over_most = 1e-6 * np.array([9.0, 13.0])
    lost, ground, compared = answer._grind(seen)
    assert f"with {best.label} relief at most 13 µm" in lost
    assert ": without deviations grind " in ground
    assert "5 µm crowning" in ground
    assert "12 -> 1.5 µm (within tolerances at most 4 µm) at 33.83 N m" in ground
    assert "is better than profile (2) as drawn" in compared


def test_no_relief_has_deviations_within_the_tolerances_of_the_relief_too():
    seen = speaking()
    design = seen.data.design
    design.best.over_most = 1e-6 * np.array([9.0, 13.0])  # more than exact flanks, less than those of the same class
    design.unrelieved_most = 1e-6 * np.array([10.0, 16.0])
    ground, within, *_ = answer._grind(seen)
    assert ground.startswith("Pair I: grind 12 µm")
    assert "(8 µm without relief, at most 10 µm with profile slopes within the same tolerance)." in within
    assert seen.data.recommended == design.best.label


def test_modifications_that_nobody_can_grind_are_none_and_round_off_of_a_grid_is_no_slope():
    seen = speaking()
    best = seen.data.design.best
    tiny = replace(RELIEFS[best.label], driver_tip=0.1e-6, driven_tip=0.2e-6, slope=2e-19)
    seen.data.design.found[best.label] = replace(seen.data.design.found[best.label], relief=tiny)
    (only,) = answer._grind(seen)
    assert only.startswith("Pair I: no modification needed: the optimum, 0.1 µm from d ")
    assert only.endswith(
        "is below a quarter of its tolerances and cannot be ground; transmission error without relief 12 µm at "
        "33.83 N m, 8 µm at 11.28 N m, peak to peak."
    )
    assert seen.data.recommended == ""
    assert [row.modification for row in seen.data.grinding if row.design == best.label] == ["tip relief"] * 2
    assert "slope" not in "; ".join(keys_of(tiny, PAIR, {"driver": "p", "driven": "w"}))
    assert sheet._size(tiny, "slope") == 0.0
    assert sheet._size(tiny, "driver_tip") == 0.1e-6


def test_tolerances_of_all_that_is_ground_are_said_by_their_kinds_and_finer_by_classes():
    seen = speaking()
    rows = [row for row in seen.data.grinding if row.design == "profile-and-lead"]
    assert answer._allowed(seen, rows, 0).endswith(", ± 1 µm crowning")
    finer = answer._allowed(seen, rows, 2)  # each class by the root of two
    assert finer.endswith(", ± 0.5 µm crowning")
    assert finer.startswith("± 0.5 µm on gear p, ± 1.5 µm on gear w")
    only = [row for row in seen.data.grinding if row.design == "lead"]
    assert answer._allowed(seen, only, 0) == "± 1 µm crowning, ± 2 µm helix slope"


def test_the_exact_topography_is_said_to_leave_more_at_other_torques_where_it_does():
    seen = speaking()
    assert list(answer._exact(seen)) == [
        "Pair I: the exact topography reduces the transmission error from 8 to 0 µm at 33.83 N m."
    ]
    seen.data.design.exact.over_peak_to_peak = 1e-6 * np.array([9.0, 0.0])
    (said,) = answer._exact(speaking_of(seen))
    assert said.endswith("; at 11.28 N m it is 9 µm, more than without relief (8 µm).")


def speaking_of(seen):
    return Seen(FlanksShown(seen.data.data, seen.asked), seen.asked, "I")


def test_a_relief_for_scattered_alignment_is_chosen_by_its_mean_and_another_is_better_aligned():
    seen = speaking()
    (said,) = answer._scattered(seen)
    assert "profile is chosen by the mean over the scatter of misalignment (maximum over the torques" in said
    assert ": 14 -> 3.4 µm at 33.83 N m, 9.6 -> 2.3 µm at 11.28 N m" in said
    assert said.endswith("; aligned as specified profile-and-lead leaves less, 1.5 µm at 33.83 N m.")
    seen.data.design.states[3].over_peak_to_peak = 1e-6 * np.array([1.0, 2.75])  # within five per cent
    (said,) = answer._scattered(speaking_of(seen))
    assert "aligned as specified" not in said
    assert list(answer._scattered(speaking(scattered=False))) == []
    seen.data.design.ground = ()
    assert list(answer._scattered(seen)) == []


def test_ends_of_the_search_are_said_of_what_is_ground_and_of_what_leaves_least(monkeypatch):
    monkeypatch.setattr(
        sheet, "end_notes", lambda head, best, pair, gears: [(head, best.family, pair, gears["driven"])]
    )
    seen = speaking()
    assert list(sheet._ends(seen)) == [
        (f"Pair I, {label}", label, PAIR, "w") for label in ("profile", "profile-and-lead")
    ]
    seen.data.design.least = seen.data.design.best
    assert len(list(sheet._ends(seen))) == 1
