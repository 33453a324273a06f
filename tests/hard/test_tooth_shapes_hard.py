"""Tooth shapes at the edge of what can be cut: limits recovered, orders kept, what cannot be refused in words."""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from fegear.base.errors import FegearError, GeometryError, InputError, RangeError
from fegear.fem.plane.contact_width import corner_angles
from fegear.fem.plane.settings import MeshSettings, settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.table import stiffness_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

#: Twice the default edges: what is compared here is shapes, not meshes.
FAST = MeshSettings().scaled(2.0)
RACK = BasicRack()
HALF_WIDTH = 0.02


def gear(tooth, bore=0.5, nu=0.3, plane="strain"):
    """Module and Young's modulus one, bore as a part of the root radius."""
    return Gear(tooth, 1.0, bore * tooth.root_radius, 10.0, Material(1.0, nu), plane)


def solved(tooth, settings=FAST, **options):
    return solve_gear(gear(tooth, **options), settings, estimate_error=False)


def flank(tooth, n=7):
    return tooth.radius_of_roll(np.sqrt(np.linspace(tooth.involute.start**2, tooth.involute.end**2, n)))


def undercut_limit(teeth, rack=RACK):
    """Profile shift at which the rack's straight flank ends where the line of action meets the base circle."""
    sin = math.sin(rack.pressure_angle)
    return rack.dedendum - rack.tip_radius * (1.0 - sin) - 0.5 * teeth * sin**2


# ---- undercut -------------------------------------------------------------------------------------------------------
def test_undercut_pinions_are_softer_and_more_stressed_the_fewer_teeth_they_have():
    compliance, tension = [], []
    for teeth in (8, 10, 12, 14, 16, 17, 18):
        tooth = Tooth(teeth)
        assert tooth.undercut == (undercut_limit(teeth) > 0.0)
        known, radii = solved(tooth), flank(tooth)
        compliance.append(known.self_compliance(radii, HALF_WIDTH))
        tension.append(known.largest_root_stress(0, "tension", radii)[0])
    # Place by place along the flank, from the very start of the involute to the tip.
    assert (np.diff(compliance, axis=0) < 0.0).all()
    assert (np.diff(tension, axis=0) < 0.0).all()
    assert np.min(compliance) > 0.0


def test_an_undercut_pinion_knows_its_own_error():
    g = gear(Tooth(8))
    table = stiffness_table(g, flank(g.tooth), HALF_WIDTH)
    assert (np.abs(table.errors["c_self"] / table.c_self) < 5e-3).all()
    assert (np.abs(table.errors["root_tension"] / table.root_tension) < 1e-2).all()


def exact_form_radius(teeth, shift, rack=RACK):
    """Where trochoid and involute cross, in 50 digits: the two branches meet in a cusp, so doubles lose them."""
    with mpmath.workdps(50):
        m = mpmath.mpf
        alpha, rho, r = m(rack.pressure_angle), m(rack.tip_radius), m(teeth) / 2
        rb = r * mpmath.cos(alpha)
        offset = (
            mpmath.pi / 4 - m(rack.dedendum) * mpmath.tan(alpha) - rho * (1 - mpmath.sin(alpha)) / mpmath.cos(alpha)
        )
        v = m(shift) - (m(rack.dedendum) - rho)
        half = (mpmath.pi / 2 + 2 * m(shift) * mpmath.tan(alpha)) / teeth + mpmath.tan(alpha) - alpha

        def place(beta):
            x, y = -v * mpmath.tan(beta) + rho * mpmath.sin(beta), r + v - rho * mpmath.cos(beta)
            phi = (-v * mpmath.tan(beta) - offset) / r
            return mpmath.hypot(x, y), mpmath.pi / teeth - (mpmath.atan2(x, y) - phi)

        def apart(beta):
            radius, angle = place(beta)
            roll = mpmath.sqrt(max(radius**2 / rb**2 - 1, 0))
            return angle - (half - roll + mpmath.atan(roll))

        def bisect(f, low, high):
            for _ in range(150):
                middle = (low + high) / 2
                low, high = (middle, high) if f(middle) < 0 else (low, middle)
            return high

        end = mpmath.pi / 2 - alpha
        low = bisect(lambda beta: place(beta)[0] - rb, m(0), end)
        radius = place(bisect(apart, low, end))[0]
        return radius - rb


@pytest.mark.parametrize("below", [1e-1, 1e-2, 1e-3, 2.5e-4, 1.5e-4, 1e-5, 1e-7])
def test_slight_undercut_starts_the_involute_where_fifty_digits_say(below):
    shift = undercut_limit(14) - below
    tooth = Tooth(14, RACK, shift)
    assert tooth.undercut
    height = tooth.form_radius - tooth.base_radius
    exact = float(exact_form_radius(14, shift))
    assert 0.0 < exact < 0.1 * below**1.5
    assert height == pytest.approx(exact, rel=1e-3, abs=4e-15)
    meet = tooth.fillet.points(tooth.fillet.end) - tooth.involute.points(tooth.involute.start)
    assert np.abs(meet).max() < 1e-14


def test_the_limit_of_undercut_is_crossed_without_a_jump():
    """Shifts a hair below, at and above the limit once ended in an error of a root finder."""
    limit = undercut_limit(14)
    answers = {}
    for beside in (-1e-3, -1e-9, -1e-14, 0.0, 1e-14, 1e-9, 1e-3):
        tooth = Tooth(14, RACK, limit + beside)
        assert tooth.form_radius - tooth.base_radius <= 1e-6
        known, radii = solved(tooth), np.array([6.65, 7.0, tooth.tip_radius])
        answers[beside] = [
            known.self_compliance(radii, HALF_WIDTH), known.largest_root_stress(0, "tension", radii)[0],
        ]  # fmt: skip
    for beside, found in answers.items():
        assert np.abs(np.array(found) / answers[0.0] - 1.0).max() < 1e-4 + 5.0 * abs(beside)


@pytest.mark.parametrize("beside", [-9e-10, -1e-14, -2.3e-17, 0.0, 1e-14])
@pytest.mark.parametrize("dedendum", [1.25, 1.4])
def test_an_undercut_below_round_off_is_none(beside, dedendum):
    """A gear on the line itself began its flank in a corner or without one by the last bit of its rack's numbers."""
    for rounding in (0.25, 0.3, 0.38):
        rack = BasicRack(1.0, dedendum, rounding)
        for teeth in (11, 12, 14, 17):
            shift = undercut_limit(teeth, rack) + beside
            tooth = Tooth(teeth, rack, shift, tip_radius=0.5 * teeth + shift + 0.7)
            assert not tooth.undercut
            assert tooth.form_radius - tooth.base_radius < 1e-12
            assert corner_angles(tooth)[0] == math.pi
            assert Tooth(teeth, rack, shift - 1e-8, tip_radius=tooth.tip_radius).undercut


def test_at_the_start_of_the_involute_the_limit_is_crossed_within_the_reported_error():
    """There a contact just ends at the corner of an undercut flank; a smooth fillet carries it on."""
    found = []
    for beside in (-1e-6, 1e-6):
        tooth = Tooth(14, RACK, undercut_limit(14) + beside)
        known, roll = solve_gear(gear(tooth)), tooth.roll(tooth.form_radius)
        held = np.sqrt(roll**2 + 2.0 * HALF_WIDTH / tooth.base_radius)
        place = np.array([tooth.form_radius if tooth.undercut else tooth.radius_of_roll(held)])
        found.append((known.self_compliance(place, HALF_WIDTH)[0], known.self_error(place, HALF_WIDTH)[0]))
    (below, its_error), (above, other_error) = found
    assert abs(above - below) < its_error + other_error
    assert its_error + other_error < 1e-3 * below


@pytest.mark.parametrize("teeth", [5, 6, 7, 8])
def test_teeth_that_undercut_cuts_off_are_refused(teeth):
    refused = 0
    for shift in np.linspace(-1.0, 0.5, 31):
        try:
            tooth = Tooth(teeth, BasicRack(1.0, 1.4, 0.1), shift)
        except GeometryError as problem:
            refused += "cut off" in str(problem) or "a neck of" in str(problem)
            continue
        x, _ = tooth.fillet.points(np.linspace(tooth.fillet.start, tooth.fillet.end, 999))
        assert x.min() > 0.015
    assert refused


# ---- fillets and tips -----------------------------------------------------------------------------------------------
@pytest.mark.parametrize("teeth", [8, 20, 300])
def test_full_fillets_lower_the_root_stress_of_every_gear(teeth):
    shift = 0.5 if teeth == 8 else 0.0
    full, usual = Tooth(teeth, BasicRack.full_fillet(), shift), Tooth(teeth, RACK, shift)
    assert full.root_land is None
    radii = flank(full)[3:]
    rounded, sharp = (solved(t).largest_root_stress(0, "tension", radii)[0] for t in (full, usual))
    assert (rounded < sharp).all()
    assert (rounded > 0.5 * sharp).all()


@pytest.mark.dear
@pytest.mark.parametrize("rack", [
    BasicRack(1.213, 0.34, 0.0, math.radians(19.07)), pytest.param(BasicRack(1.0, 1.25, 0.0), marks=pytest.mark.long),
])  # fmt: skip
def test_a_sharp_rack_tip_leaves_a_mesh_that_can_be_solved(rack):
    """The fillet of a sharp tool turns 70 degrees however short it is; few edges along it turned elements over."""
    for factor in (1.0, 1.6, 4.0):
        known = solve_gear(gear(Tooth(91, rack), bore=0.1), MeshSettings().scaled(factor), estimate_error=False)
        assert np.isfinite(known.self_compliance([45.5], HALF_WIDTH)).all()


def test_a_tip_rounding_that_vanishes_leaves_the_sharp_tip():
    """A rounding of a micrometre once changed the compliance at the tip by 4.6 % and the stress by 1.7 %."""
    sharp = solved(Tooth(28))
    for rounding in (1e-9, 1e-6, 1e-4, 1e-3, 1e-2):
        tooth = Tooth(28, tip_rounding=rounding)
        known = solved(tooth)
        for radius in (13.6, 14.0, 14.9, tooth.involute_tip_radius):
            at = 15.0 if radius == tooth.involute_tip_radius else radius
            c, limit = known.self_compliance([radius], HALF_WIDTH), sharp.self_compliance([at], HALF_WIDTH)
            assert c == pytest.approx(limit, rel=5e-4 + 2.0 * rounding)
            stress = [s.largest_root_stress(0, "tension", [r])[0] for s, r in ((known, radius), (sharp, at))]
            assert stress[0] == pytest.approx(stress[1], rel=2e-3 + rounding)


def test_root_stress_grows_up_to_the_end_of_a_flank_with_any_rounding():
    for rounding in (0.001, 0.02, 0.3):
        tooth = Tooth(28, tip_rounding=rounding)
        radii = np.linspace(tooth.involute_tip_radius - 0.1, tooth.involute_tip_radius, 9)
        assert (np.diff(solved(tooth).largest_root_stress(0, "tension", radii)[0]) > 0.0).all()


# ---- rims and bores -------------------------------------------------------------------------------------------------
def test_a_thinner_rim_on_a_stiff_hub_is_stiffer_and_tends_to_a_tooth_on_rigid_ground():
    bores = (0.3, 0.5, 0.8, 0.9, 0.95, 0.97, 0.99, 0.995, 0.998)
    radii = np.array([14.0, 15.0])
    known = [solved(Tooth(28), bore=b) for b in bores]
    c = np.array([k.self_compliance(radii, HALF_WIDTH) for k in known])
    coupling = np.array([np.diagonal(k.neighbour(1, radii, radii)) for k in known])
    assert (np.diff(c, axis=0) < 0.0).all()
    assert (np.diff(coupling[:, 0]) < 0.0).all()
    assert (np.abs(coupling[-1]) < 1e-8).all()
    # What a held root still gives way falls with the rim's thickness.
    rim = 1.0 - np.array(bores[-3:])
    slope = np.diff(c[-3:], axis=0) / np.diff(rim)[:, None]
    assert slope[1] == pytest.approx(slope[0], rel=0.15)


@pytest.mark.parametrize(
    ("bore", "near"), [pytest.param(1.0 - 1e-5, "the root circle", marks=pytest.mark.long), (1e-6, "the centre")]
)
def test_bores_that_no_elements_resolve_are_refused_with_one_that_they_do(bore, near):
    """One asked for 32 GiB, another never came back."""
    tooth = Tooth(28)
    g = Gear(tooth, 3e-3, bore * tooth.root_radius * 3e-3, 0.01)
    with pytest.raises(RangeError, match=f"too close to {near}") as refused:
        solve_gear(g)
    low, high = (float(w) * 1e-3 for w in refused.value.remedy.split(" mm")[0].split() if w[0].isdigit())
    named = Gear(tooth, 3e-3, low if near == "the centre" else high, 0.01)
    assert np.isfinite(solve_gear(named, FAST, estimate_error=False).self_compliance([42e-3], 1e-5)).all()


# ---- numbers of teeth -----------------------------------------------------------------------------------------------
@pytest.mark.dear
def test_many_teeth_tend_to_the_rack_like_one_over_their_number():
    """On a rim of 2.5 modules; what is left to the rack halves when the number of teeth doubles."""
    c = []
    for teeth in (125, 250, 500, 1000):
        tooth = Tooth(teeth)
        # the last step is .4 % of the compliance, and FAST's meshes leave a tenth of it
        known = solved(tooth, settings_at(0), bore=1.0 - 2.5 / tooth.root_radius)
        c.append(known.self_compliance([tooth.pitch_radius, tooth.tip_radius], HALF_WIDTH))
    steps = -np.diff(c, axis=0)
    assert (steps > 0.0).all()
    assert steps[0] / steps[1] == pytest.approx([2.0, 2.0], rel=0.45)  # at the tip 2.76 on the finest meshes
    assert steps[1, 0] / steps[2, 0] == pytest.approx(2.0, rel=0.1)


# ---- Poisson's ratio ------------------------------------------------------------------------------------------------
@pytest.mark.dear
def test_nearly_incompressible_steel_leads_to_a_limit_and_finer_meshes_confirm_it():
    radii = np.array([13.5, 14.0, 15.0])
    values = {nu: solved(Tooth(28), MeshSettings(), nu=nu).self_compliance(radii, HALF_WIDTH)
              for nu in (0.4, 0.45, 0.49, 0.4999)}  # fmt: skip
    assert (np.diff(list(values.values()), axis=0) < 0.0).all()
    known = solve_gear(gear(Tooth(28), nu=0.4999))
    better = solved(Tooth(28), settings_at(2), nu=0.4999).self_compliance(radii, HALF_WIDTH)
    assert (np.abs(values[0.4999] - better) < known.self_error(radii, HALF_WIDTH)).all()
    assert values[0.4999] == pytest.approx(better, rel=5e-4)


def test_without_poissons_ratio_plane_strain_is_plane_stress():
    radii = np.array([13.5, 14.0, 15.0])
    strain, stress = (solved(Tooth(28), nu=0.0, plane=p) for p in ("strain", "stress"))
    np.testing.assert_array_equal(strain.self_compliance(radii, 0.02), stress.self_compliance(radii, 0.02))
    assert strain.largest_root_stress(0, "tension", radii)[0] == pytest.approx(
        stress.largest_root_stress(0, "tension", radii)[0], rel=1e-13
    )


@pytest.mark.parametrize(
    ("nu", "plane"), [(0.5, "strain"), (0.49999, "strain"), (0.7, "strain"), (0.5, "stress"), (0.7, "stress"),
                      (-1.0, "stress"), (math.nan, "stress")],
)  # fmt: skip
def test_materials_that_are_unstable_or_cannot_be_distinguished_from_rigid_are_refused(nu, plane):
    with pytest.raises(InputError, match=r"material\.poisson_ratio"):
        gear(Tooth(28), nu=nu, plane=plane)
    assert gear(Tooth(28), nu=0.4999, plane=plane).plane_modulus > 0.0


# ---- loads at the ends of the flank ---------------------------------------------------------------------------------
@pytest.mark.parametrize("teeth", [8, 28])
def test_loads_at_both_ends_of_the_flank_are_finite_and_off_it_refused(teeth):
    g = gear(Tooth(teeth, tip_rounding=0.0))
    ends = np.array([g.form_radius, g.involute_tip_radius])
    table = stiffness_table(g, ends, HALF_WIDTH, FAST)
    for name in ("c_self", "c_next", "c_prev", "root_tension", "root_compression"):
        assert np.isfinite(getattr(table, name)).all()
    assert all(np.isfinite(e).all() for e in table.errors.values())
    assert table.c_self[1] > table.c_self[0] > 0.0
    for radius in (ends[0] - 1e-3, ends[1] + 1e-3, math.nan):
        with pytest.raises(FegearError, match="is outside the involute flank,"):
            stiffness_table(g, [radius], HALF_WIDTH, FAST)


def test_a_sharp_rack_tip_on_the_pitch_line_is_refused_and_one_beside_it_holds():
    """Dedendum equal to the shift, no tip radius: the corner rolls on the pitch line and generates a point."""
    with pytest.raises(
        GeometryError, match="is a sharp corner on the pitch line and would generate a notch instead of a fillet"
    ):
        Tooth(15, BasicRack(1.0, 1.0, 0.0, math.radians(12.0)), 1.0, tip_radius=9.5)
    beside = Tooth(15, BasicRack(1.0, 1.01, 0.0, math.radians(12.0)), 1.0, tip_radius=9.5)
    assert np.all(np.isfinite(beside.fillet.points(np.linspace(beside.fillet.start, beside.fillet.end, 9))[0]))


@pytest.mark.parametrize("angle", [14.5, 20.0, 30.0, 34.0, 38.0])
@pytest.mark.parametrize("teeth", [5, 8])
def test_a_slight_undercut_joins_fillet_and_flank_at_every_pressure_angle(angle, teeth):
    """The trochoid ends at less than 1 rad where the rack's flanks are flat."""
    rack = BasicRack(0.8, 0.9, 0.1, math.radians(angle))
    shift = undercut_limit(teeth, rack) - 1e-5
    tooth = Tooth(teeth, rack, shift, tip_radius=0.5 * teeth + shift + 0.5)
    assert tooth.undercut
    meet = tooth.fillet.points(tooth.fillet.end) - tooth.involute.points(tooth.involute.start)
    assert np.abs(meet).max() < 1e-14


@pytest.mark.parametrize(("teeth", "angle", "protuberance", "shift", "dedendum", "rounding"), [
    (39, 15.633668056331215, 4.0062999404059645e-17, 0.05997835027448478, 1.3053182070903948, 0.09770588700867389),
    (80, 13.52245553551916, 8.024426206675523e-16, 0.17685323443289502, 1.3128432209097425, 0.15013802642206447),
    (27, 8.313837420534837, 7.680360934777446e-17, 0.3294778329858022, 1.2033324703103443, 0.08046577610255023),
])  # fmt: skip
def test_a_protuberance_that_is_lost_in_round_off_is_none(teeth, angle, protuberance, shift, dedendum, rounding):
    plain = BasicRack(1.0, dedendum, rounding)
    rack = replace(plain, protuberance=protuberance, protuberance_angle=math.radians(angle))
    found, wanted = (Tooth(teeth, one, shift, tip_radius=0.5 * teeth + shift + 0.6) for one in (rack, plain))
    assert found.form_radius == pytest.approx(wanted.form_radius, abs=1e-13)
    assert found.fillet.end == pytest.approx(wanted.fillet.end, abs=1e-7)
