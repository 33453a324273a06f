"""Drawings hold the exact tooth: polylines to the chord tolerance, splines far below it, ends that close."""

from __future__ import annotations

import math

import ezdxf
import numpy as np
import pytest
from scipy.interpolate import BSpline

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.generated_fillet import ProtuberanceFillet
from fegear.geometry.outline import gear_outline, tooth_outline
from fegear.geometry.rack import BasicRack
from fegear.output.dxf import CHORD_TOLERANCE, write_dxf

GEARS = {
    "plain": Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3e-3, 15e-3),
    "undercut": Gear(Tooth(9, BasicRack.named("A")), 2e-3, 4e-3),
    "rounded": Gear(Tooth(28, BasicRack.full_fillet(), tip_rounding=0.12), 3e-3, 15e-3),
    "protuberance": Gear(Tooth(28, BasicRack(1.0, 1.4, 0.35, protuberance=0.06, protuberance_angle=0.26)), 3e-3, 15e-3),
    "chamfered": Gear(Tooth(17, BasicRack.named("D"), profile_shift=0.3, tip_chamfer=0.1), 1e-3, 4e-3),
}


#: The outline with the most pieces costs most, and splines meet it in the ordinary run.
POLYLINES = [
    pytest.param(one, id=name, marks=pytest.mark.long if name == "protuberance" else ()) for name, one in GEARS.items()
]


@pytest.mark.dear
@pytest.mark.parametrize("gear", POLYLINES)
def test_polylines_are_closed_and_lie_on_the_tooth(gear, tmp_path):
    paths = {path.stem: path for path in write_dxf(gear, tmp_path, "g")}
    document = ezdxf.readfile(paths["g_gear_polyline"])
    assert document.units == ezdxf.units.MM
    (line,) = document.modelspace().query("LWPOLYLINE")
    assert line.closed
    points = np.array(line.get_points("xy")).T
    radius, angle = np.hypot(*points), np.arctan2(points[0], points[1])
    assert radius.max() == pytest.approx(gear.tip_radius * 1e3, rel=1e-12)
    assert radius.min() == pytest.approx(gear.root_radius * 1e3, rel=1e-9)
    # On the involutes the polar angle is known in closed form.
    pitch = 2 * math.pi / gear.teeth
    turn = np.abs((angle + pitch / 2) % pitch - pitch / 2)
    flank = (radius > gear.form_radius * 1e3 * (1 + 1e-9)) & (radius < gear.involute_tip_radius * 1e3 * (1 - 1e-9))
    assert flank.sum() > 8 * gear.teeth
    expected = gear.tooth.half_thickness_angle(radius[flank] / gear.module / 1e3)
    assert np.abs(turn[flank] - expected).max() < 1e-12
    (circle,) = document.modelspace().query("CIRCLE")
    assert circle.dxf.radius == pytest.approx(gear.bore_radius * 1e3)
    (sector,) = ezdxf.readfile(paths["g_tooth_polyline"]).modelspace().query("LWPOLYLINE")
    assert sector.closed


@pytest.mark.parametrize("gear", GEARS.values(), ids=GEARS)
def test_area_converges_with_the_square_of_the_chord(gear):
    def area(tolerance):
        x, y = gear_outline(gear, tolerance)
        return 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))

    fine = area(1e-9)
    assert abs(area(1e-4) - fine) < 2 * math.pi * gear.tip_radius * gear.teeth * 1e-4 * gear.module
    assert abs(area(1e-6) - fine) < 0.1 * abs(area(1e-4) - fine)


@pytest.mark.dear
@pytest.mark.parametrize("gear", GEARS.values(), ids=GEARS)
def test_splines_hold_the_curves_and_their_ends_meet(gear, tmp_path):
    paths = {path.stem: path for path in write_dxf(gear, tmp_path, "g")}
    for part, count in (("g_tooth_spline", 1), ("g_gear_spline", gear.teeth)):
        space = ezdxf.readfile(paths[part]).modelspace()
        splines = list(space.query("SPLINE"))
        # A flank, and a fillet that is two curves where the protuberance's involute follows the trochoid.
        assert len(splines) == (6 if isinstance(gear.tooth.fillet, ProtuberanceFillet) else 4) * count
        ends = []
        for spline in splines:
            curve = BSpline(np.array(spline.knots), np.array(spline.control_points)[:, :2], spline.dxf.degree)
            u = np.linspace(spline.knots[0], spline.knots[-1], 301)
            points = curve(u).T
            radius = np.hypot(*points) / gear.module / 1e3
            pitch = 2 * math.pi / gear.teeth
            turn = np.abs((np.arctan2(points[0], points[1]) + pitch / 2) % pitch - pitch / 2)
            flank = (radius > gear.tooth.form_radius + 1e-6) & (radius < gear.tooth.involute_tip_radius)
            off = radius[flank] * (turn[flank] - gear.tooth.half_thickness_angle(radius[flank]))
            assert off.size == 0 or np.abs(off).max() < 1e-7
            ends += [points[:, 0], points[:, -1]]
        for arc in space.query("ARC"):
            if arc.dxf.layer == "OUTLINE":
                ends += [np.array(arc.start_point)[:2], np.array(arc.end_point)[:2]]
        for line in space.query("LINE"):
            ends += [np.array(line.dxf.start)[:2], np.array(line.dxf.end)[:2]]
        if part == "g_gear_spline":  # a closed curve: every end meets exactly one other
            ends = np.array(ends)
            distance = np.hypot(*(ends[:, None] - ends[None]).transpose(2, 0, 1)) + np.eye(len(ends)) * 9
            assert ((distance < 1e-9 * gear.tip_radius * 1e3).sum(axis=1) == 1).all()


def test_splines_of_a_fillet_of_two_curves_lie_on_both(tmp_path):
    gear = GEARS["protuberance"]
    fillet = gear.tooth.fillet
    assert isinstance(fillet, ProtuberanceFillet)
    paths = {path.stem: path for path in write_dxf(gear, tmp_path, "g")}
    both = {"trochoid": fillet.trochoid, "involute": fillet.involute}
    looked = dict.fromkeys(both, 0)
    for spline in ezdxf.readfile(paths["g_tooth_spline"]).modelspace().query("SPLINE"):
        curve = BSpline(np.array(spline.knots), np.array(spline.control_points)[:, :2], spline.dxf.degree)
        # Both are interpolated in the curve's own parameter, so that the knots say where on it a point belongs.
        for name, piece in both.items():
            if sorted(np.abs([spline.knots[0], spline.knots[-1]])) == pytest.approx(
                [piece.start, piece.end], abs=1e-12
            ):
                u = np.linspace(spline.knots[0], spline.knots[-1], 301)
                points = curve(u).T / gear.module / 1e3
                exact = piece.points(u)
                turn = np.arctan2(exact[0], exact[1]) - np.abs(np.arctan2(points[0], points[1]))
                assert np.abs(np.hypot(*points) - np.hypot(*exact)).max() < 2e-8
                assert np.abs(turn).max() < 2e-8
                looked[name] += 1
    assert looked == {"trochoid": 2, "involute": 2}


def test_the_tooth_outline_is_symmetric_and_spans_one_pitch():
    tooth = GEARS["plain"].tooth
    outline = tooth_outline(tooth, CHORD_TOLERANCE)
    assert np.abs(outline + outline[:, ::-1] * np.array([[1.0], [-1.0]])).max() == 0.0
    x, y = outline[:, -1]
    assert math.atan2(x, y) == pytest.approx(math.pi / tooth.teeth, abs=1e-14)
