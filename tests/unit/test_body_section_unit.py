"""The drawn section of a gear's body: what it encloses, its dimensions and its holes, from what the case gives."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.base.errors import GeometryError
from fegear.case.reading import build_scene
from fegear.output.export import export_gears
from fegear.results.gear.body_section import body_figures, dimensions, hatched

TEETH, MODULE = 24, 2.0
TIP, ROOT = 26.0, 21.5
SHARE = st.floats(0.0, 1.0)


def gear(width, bore, **body):
    given_ = {key: one if isinstance(one, dict) else f"{one!r} mm" for key, one in body.items() if one is not None}
    if "web_inclination" in given_:
        given_["web_inclination"] = f"{body['web_inclination']!r} deg"
    part = {"teeth": TEETH, "module": f"{MODULE} mm", "face_width": f"{width!r} mm", "bore_radius": f"{bore!r} mm"}
    return build_scene({"results": ["geometry"], "gear": {"a": part | {"body": given_}}}, "case", Path()).gears["a"]


@st.composite
def bodies(draw):
    """A gear with any body that can be, and what the case says of it [mm, deg]."""
    width, bore, thick = draw(st.floats(4.0, 60.0)), draw(st.floats(3.0, 7.0)), draw(st.floats(2.0, 7.0))
    rim, held = ROOT - thick, draw(st.booleans())
    hub = bore + 2.0 + draw(SHARE) * (rim - bore - 4.0) if held else bore
    lean = draw(st.sampled_from([0.0, -30.0, -7.0, 4.0, 20.0]))
    web = 0.5 + draw(SHARE) * (0.8 * width - 0.5)
    shift = math.tan(math.radians(lean)) * (rim - hub)
    low, high = max(0.0, -shift) - 0.5 * (width - web), min(0.0, -shift) + 0.5 * (width - web)
    assume(low <= high)
    offset = low + draw(SHARE) * (high - low)
    given_ = {"rim_thickness": thick, "web_thickness": web, "web_offset": offset, "web_inclination": lean}
    if held:
        start = -0.5 * width + draw(SHARE) * (offset + shift - 0.5 * web + 0.5 * width)
        end = 0.5 * width - draw(SHARE) * (0.5 * width - offset - shift - 0.5 * web)
        given_ |= {"hub_radius": hub, "hub_width": end - start, "hub_offset": 0.5 * (start + end)}
    try:
        return gear(width, bore, **given_), {"face_width": width, "bore_radius": bore} | given_
    except GeometryError:  # beside an inclined web the rim must reach as far as a fifth of what the hub does
        assume(False)


def corners(made):
    return np.array(made.body.section(made.tip_radius, made.bore_radius, made.face_width)).T


def enclosed(z, r):
    """Integrals of r, r z and r^2 over the inside of a closed line that runs clockwise."""
    (a, b), (c, d) = (z[:-1], z[1:]), (r[:-1], r[1:])
    turn = b * c - a * d
    return (
        float((turn * (c + d)).sum() / 6.0),
        float((turn * (a * (2.0 * c + d) + b * (c + 2.0 * d))).sum() / 24.0),
        float((turn * (c**2 + c * d + d**2)).sum() / 12.0),
    )


@given(bodies())
def test_the_outline_encloses_what_the_case_gives(drawn):
    """Volume, its moment along the axis and its second radial moment over 2 pi, of rim and teeth, web and hub."""
    made, said = drawn
    outline = 1e3 * corners(made)
    rim, bore, slope = (
        ROOT - said["rim_thickness"],
        said["bore_radius"],
        math.tan(math.radians(said["web_inclination"])),
    )
    hub = said.get("hub_radius", bore)
    web, offset = said["web_thickness"], said["web_offset"]

    def ring(outer, inner, power=2):
        return (outer**power - inner**power) / power

    volume = said["face_width"] * ring(TIP, rim) + web * ring(rim, hub)
    squares = said["face_width"] * ring(TIP, rim, 3) + web * ring(rim, hub, 3)
    moment = web * ((offset + slope * rim) * ring(rim, hub) - slope * ring(rim, hub, 3))
    if "hub_radius" in said:
        volume += said["hub_width"] * ring(hub, bore)
        squares += said["hub_width"] * ring(hub, bore, 3)
        moment += said["hub_width"] * said["hub_offset"] * ring(hub, bore)
    found = enclosed(*outline)
    assert found == pytest.approx((volume, moment, squares), rel=1e-9, abs=1e-9 * volume * said["face_width"])
    assert np.abs(outline[0]).max() == pytest.approx(0.5 * said["face_width"])


@given(bodies())
def test_every_dimension_is_as_long_as_it_says(drawn):
    made, said = drawn
    shown = dimensions(made, made.body)
    wanted = {key: value for key, value in said.items() if abs(value) > 1e-6}
    assert {key: size for key, (_, size, _) in shown.items() if abs(size) > 1e-6} == pytest.approx(wanted, abs=1e-9)
    for key, (_, size, line) in shown.items():
        if key != "web_inclination":
            (a, b), (c, d) = line
            assert math.hypot(b - a, d - c) == pytest.approx(abs(size), abs=1e-9)
            continue
        tip, vertex, foot = line[:, :3].T
        (x, y), (u, v) = tip - vertex, foot - vertex
        assert math.degrees(math.atan2(x, -y) - math.atan2(u, -v)) == pytest.approx(size)
        half_way = 0.55 * (vertex[1] - said.get("hub_radius", said["bore_radius"]))  # of the web, on a circle about it
        away = np.hypot(*(line - vertex[:, None]))
        assert away[np.isfinite(away) & (away > 0.0)] == pytest.approx(half_way)


@given(bodies())
def test_what_is_hatched_lies_inside(drawn):
    """Middles of the lines, at 45 degrees; how much of the section they stand for."""
    made, _ = drawn
    outline = corners(made)
    lines = hatched(made, made.body).reshape(2, -1, 3)[:, :, :2]
    z, r = lines.mean(axis=2)
    (a, b), (c, d) = (outline[0, :-1, None], outline[0, 1:, None]), (outline[1, :-1, None], outline[1, 1:, None])
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = ((c > r) != (d > r)) & (z < a + (r - c) / (d - c) * (b - a))
    assert (crossed.sum(axis=0) % 2 == 1).all()
    step = np.diff(lines, axis=2)[:, :, 0]
    assert step[0] == pytest.approx(step[1])
    size = max(made.face_width, made.tip_radius)
    area = abs(float((outline[0, :-1] * outline[1, 1:] - outline[0, 1:] * outline[1, :-1]).sum())) / 2.0
    assert np.abs(step[0]).sum() * size / 40.0 == pytest.approx(area, rel=0.1)


def test_holes_lie_where_the_case_says_and_tooth_0_at_the_top():
    """The first hole on the side that the loaded flank faces, at the right; dashed over the web in the section."""
    made = gear(
        8.0, 7.0, rim_thickness=3.0, web_thickness=3.0, hub_radius=9.0,
        holes={"count": 5, "circle_diameter": "27 mm", "diameter": "7 mm", "angle": "20 deg", "tooth": 3},
    )  # fmt: skip
    (figure,) = body_figures({"disc": build_scene(
        {"results": ["geometry"], "gear": {"b": {"teeth": 24, "module": "2 mm"}}}, "case", Path()
    ).gears["b"], "a": made})  # fmt: skip
    assert figure.key == "gear_body_a"
    for words in ("b = 8 mm (face_width)", "r_h = 9 mm (hub_radius)", "5 holes of 7 mm", "20 deg", "tooth 3"):
        assert words in figure.caption
    section, front = figure.panels
    (dashed,) = (item for item in section.items if getattr(item, "name", "") == "holes")
    assert np.unique(dashed.y[np.isfinite(dashed.y)]) == pytest.approx([10.0, 17.0])
    assert (np.nanmin(dashed.x), np.nanmax(dashed.x)) == pytest.approx((-1.5, 1.5))
    (round_,) = (item for item in front.items if getattr(item, "name", "") == "holes")
    rings = np.stack([round_.x, round_.y]).reshape(2, 5, -1)[:, :, :-1]
    middles = 0.5 * (rings.max(axis=2) + rings.min(axis=2))
    angles = np.radians(20.0 + 72.0 * np.arange(5))
    assert middles == pytest.approx(13.5 * np.stack([np.sin(angles), np.cos(angles)]), abs=2e-3)
    assert np.hypot(*(rings - middles[:, :, None])) == pytest.approx(3.5, abs=2e-3)
    (teeth,) = (item for item in front.items if getattr(item, "name", "") == "teeth")
    radius = np.hypot(teeth.x, teeth.y)
    assert (radius.min(), radius.max()) == pytest.approx((ROOT, TIP))
    assert teeth.y.max() == pytest.approx(TIP)


def test_a_disc_has_no_such_figure():
    disc = build_scene({"results": ["geometry"], "gear": {"a": {"teeth": 24, "module": "2 mm"}}}, "case", Path())
    assert body_figures(disc.gears) == ()


@pytest.mark.dear("body1", "body0")
@pytest.mark.parametrize("body", [{}, {"body": {"rim_thickness": "4 mm", "web_thickness": "5 mm"}}])
def test_a_step_file_is_a_disc_and_says_so_where_the_case_has_a_body(tmp_path, body):
    part = {"teeth": 12, "module": "2 mm", "face_width": "10 mm", "bore_radius": "4 mm", **body}
    scene = build_scene({"results": ["geometry"], "gear": {"a": part}}, "case", Path())
    said = export_gears(scene, tmp_path, (), "step").remarks
    assert (
        [one for one in said if ", STEP: solid disc of full face width; add web" in one]
        == list(said)
        == ([said[0]] if body else [])
    )


def test_a_hatch_line_that_only_touches_a_corner_is_none():
    """Hub and web of one length and offset: two lines met corners of parts without extent."""
    made = gear(13.2, 3.0, rim_thickness=2.0, web_thickness=0.5, web_offset=-6.35)
    assert hatched(made, made.body).shape[1] % 3 == 0
