"""The outline of a sector of a rack: closed, straight at sides and back, with edges of the sizes asked for."""

from __future__ import annotations

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.rack.rack_mesh import THICKEST_BODY, THINNEST_BODY, rack_boundary, rack_sector
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_tooth import RackTooth

TOOTH, BODY, SETTINGS = RackTooth(BasicRack(1.0, 1.25, 0.38)), 1.5, MeshSettings()
PITCH = np.pi


def chains(pin_width=0.0, body=BODY):
    return rack_boundary(TOOTH, body, SETTINGS, pin_width)


@pytest.mark.parametrize("pin_width", [0.0, 1.2])
def test_an_outline_is_closed_and_runs_counterclockwise(pin_width):
    found = chains(pin_width)
    for one, following in zip(found, [*found[1:], found[0]], strict=True):
        assert one.vertices[:, -1] == pytest.approx(following.vertices[:, 0], abs=1e-12)
    x, y = np.concatenate([one.vertices[:, :-1] for one in found], axis=1)
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    # The body below the root and the tooth on it: half a pitch thick at the reference line.
    tooth = area - BODY * PITCH
    assert 0.45 * 2.25 * PITCH < tooth < 0.56 * 2.25 * PITCH
    assert y.min() == pytest.approx(TOOTH.root_height - BODY)
    assert (x.min(), x.max()) == pytest.approx((-0.5 * PITCH, 0.5 * PITCH))


@pytest.mark.parametrize("pin_width", [0.0, 1.2])
def test_sides_are_upright_and_fit_one_pitch_on(pin_width):
    found = {one.name: one for one in chains(pin_width) if one.name.startswith("side")}
    right, left = found["side_b"].vertices, found["side_a"].vertices
    assert (right[0] == 0.5 * PITCH).all()
    assert (left[0] == -0.5 * PITCH).all()
    assert left[1, ::-1].tolist() == right[1].tolist()
    assert (right[1, 0], right[1, -1]) == (TOOTH.root_height - BODY, TOOTH.root_height)
    assert (np.diff(right[1]) > 0.0).all()
    for name, way in (("side_b", 1.0), ("side_a", -1.0)):
        assert found[name].tangents == pytest.approx(np.tile([[0.0], [way]], right.shape[1]))
        assert found[name].middles == pytest.approx(0.5 * (found[name].vertices[:, 1:] + found[name].vertices[:, :-1]))


@pytest.mark.parametrize("body", [0.3, 1.5, 20.0])
def test_edges_of_a_side_grow_from_those_of_the_root_to_the_widest_of_the_body(body):
    (side,) = (one for one in chains(body=body) if one.name == "side_b")
    root = next(one for one in chains(body=body) if one.name not in ("bore", "side_b"))
    first = float(np.hypot(*(root.vertices[:, 1] - root.vertices[:, 0])))
    edge, depth = np.diff(side.vertices[1]), TOOTH.root_height - side.vertices[1]
    middle = 0.5 * (depth[1:] + depth[:-1])
    widest = min(SETTINGS.body_fraction * PITCH, SETTINGS.rim_fraction * body)
    wanted = np.minimum(first + SETTINGS.side_growth * middle, widest)
    scale = edge / wanted  # all by one factor, which makes their number whole
    assert scale == pytest.approx(scale.mean(), rel=0.12)
    assert 1.0 / scale.mean() == pytest.approx(1.0, abs=0.6 / edge.size + 0.05)


def test_the_back_is_held_all_over_in_even_edges():
    back = rack_boundary(TOOTH, BODY, SETTINGS)[0]  # without a pin
    assert back.name == "bore"
    edge = np.diff(back.vertices[0])
    assert edge == pytest.approx(edge[0])
    assert (back.vertices[1] == TOOTH.root_height - BODY).all()
    widest = min(SETTINGS.body_fraction * PITCH, SETTINGS.rim_fraction * BODY)
    assert edge.size == round(PITCH / widest)


def test_a_pin_holds_the_middle_of_the_back_with_fine_edges_at_its_ends():
    pin = 1.2
    left, held, right = chains(pin)[:3]
    assert [one.name for one in (left, held, right)] == ["back", "bore", "back"]
    assert (held.vertices[0, 0], held.vertices[0, -1]) == pytest.approx((-0.5 * pin, 0.5 * pin))
    assert (left.vertices[0, 0], right.vertices[0, -1]) == (-0.5 * PITCH, 0.5 * PITCH)
    for one in (left, held, right):
        assert (one.vertices[1] == TOOTH.root_height - BODY).all()
    assert held.vertices[0] == pytest.approx(-held.vertices[0, ::-1], abs=1e-12)
    assert left.vertices[0] == pytest.approx(-right.vertices[0, ::-1], abs=1e-12)
    widest = min(SETTINGS.body_fraction * PITCH, SETTINGS.rim_fraction * BODY)
    for places in (right.vertices[0] - 0.5 * pin, held.vertices[0, : held.vertices.shape[1] // 2 + 1] + 0.5 * pin):
        edge = np.diff(places)
        middle = 0.5 * (places[1:] + places[:-1])
        wanted = np.minimum(0.1 * SETTINGS.root_edge_length + SETTINGS.growth * middle, widest)
        scale = edge / wanted
        assert scale == pytest.approx(scale.mean(), rel=0.12)
        assert scale.mean() == pytest.approx(1.0, abs=0.15)


def test_bodies_that_cannot_be_meshed_are_refused():
    for body in (0.99 * THINNEST_BODY, 1.01 * THICKEST_BODY, float("nan")):
        with pytest.raises(InputError, match=r"must be between 0\.25 and 50 modules"):
            rack_sector(TOOTH, body, SETTINGS)


def test_a_sector_has_the_pitch_of_its_rack_and_the_edges_that_others_ask_for():
    mesh = rack_sector(TOOTH, BODY, MeshSettings(order=2).scaled(2.0))
    assert mesh.pitch == pytest.approx(PITCH)
    assert mesh.points[1].min() == pytest.approx(TOOTH.root_height - BODY)
    assert "back" not in mesh.edges
    assert {"bore", "side_a", "side_b", "fillet", "flank"} <= set(mesh.edges)
