"""Meshes of whole racks: areas and volumes of the section, loads that add up, the row's own solution."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.fem.plane.rack.solved_rack import solve_rack_teeth
from fegear.fem.plane.rack.whole_rack import rack_field, rack_section, whole_rack
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.solid.extruded import extruded
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_outline import rack_outline
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.toothed_rack import Rack, RackPins
from fegear.output.solid_mesh_files import pressed_rack

SETTINGS = replace(MeshSettings().scaled(1.5), order=2)
PINS = RackPins(3, 1, 2e-3)


def rack_of(helix=0.0, teeth=5, pins=None):
    """Of module 2 mm."""
    beta = math.radians(helix)
    tooth = RackTooth(BasicRack(), helix_angle=beta)
    return Rack(tooth, 2e-3, teeth, 7e-3, 6e-3, pins=pins, hand="right" if helix else "spur")


def section_area(rack):
    """[modules^2]."""
    x, y = rack_outline(rack, 1e-7) / rack.module
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def area_of(points, edges):
    """Inside quadratic edges (vertex, vertex, middle), counterclockwise: Simpson's rule is exact."""
    first, second, middle = (points[:, e] for e in edges)
    slopes = 4 * middle - 3 * first - second, second - first, 3 * second - 4 * middle + first
    at = zip((first, middle, second), slopes, (1 / 6, 4 / 6, 1 / 6), strict=True)
    return 0.5 * sum(w * float((p[0] * d[1] - p[1] * d[0]).sum()) for p, d, w in at)


def names_of_all(whole):
    return [name for name in whole.boundaries if not name[-1].isdigit()]


@pytest.mark.parametrize("pins", [None, PINS])
def test_boundaries_of_the_plane_mesh_close_around_its_section(pins):
    rack = rack_of(pins=pins)
    whole, mesh = whole_rack(rack, SETTINGS)
    edges = np.hstack([whole.boundaries[name] for name in names_of_all(whole)])
    assert area_of(whole.points, edges) == pytest.approx(section_area(rack), rel=1e-5)
    assert sorted(edges[2]) == sorted(whole.outline[1])  # each edge of the outline has one name
    held = whole.points[:, whole.node_set("pins" if pins else "back")]
    assert held[1] == pytest.approx(-3.5)
    pitch = math.pi
    under = np.unique(np.round((held[0] if pins else held[0][[0]]) / pitch))
    assert list(under) == ([1.0, 4.0] if pins else [0.0])
    assert whole.points[0, whole.node_set("flank_3")].mean() == pytest.approx(2 * pitch + math.pi / 4, abs=0.2)
    assert set(mesh.edges) >= {"flank", "fillet", "bore"}


@pytest.mark.dear
@pytest.mark.parametrize("pins", [None, PINS])
def test_the_field_is_that_of_the_row(pins):
    """Work of the load, and what moves on the flank of the next tooth."""
    rack = rack_of(pins=pins)
    whole, mesh = whole_rack(rack, SETTINGS)
    field = rack_field(rack, mesh, 0.2)
    held = () if pins is None else tuple(pins.holds(i) for i in range(rack.teeth))
    row, _, _ = solve_rack_teeth(
        rack.tooth, rack.body / rack.module, rack.teeth, 0.3, "strain", SETTINGS, held=held,
        pin_width=1.0 if pins else 0.0,
    )  # fmt: skip
    one = row.loaded(2)
    load = one.flank.patches(one.flank.arc_of_radius(np.array([0.0])), np.array([0.2]))[:, 0]
    assert float((field.forces * field.displacement[0]).sum()) == pytest.approx(
        float(load @ one.compliance[0] @ load), rel=1e-9
    )
    ahead = whole.points + np.array([[math.pi], [0.0]])
    loaded = np.flatnonzero(np.any(field.forces, axis=0))
    beside = [int(np.argmin(np.hypot(*(whole.points - ahead[:, [n]])))) for n in loaded]
    moved = float((field.forces[:, loaded] * field.displacement[0][:, beside]).sum())
    assert moved == pytest.approx(float(load @ one.compliance[1] @ load), rel=1e-9)
    assert np.abs(field.displacement[0][:, np.unique(mesh.edges["bore"])]).max() == 0.0


@pytest.mark.parametrize(("helix", "pins", "teeth"), [(0.0, PINS, 5), (20.0, None, 2), (20.0, None, 1)])
def test_the_solid_is_the_section_times_the_width_and_its_band_presses_normally(helix, pins, teeth):
    rack = rack_of(helix, teeth, pins)
    mesh, bands = pressed_rack(rack, face_positions=(0.0, 3e-3), coarseness=2.0)
    section = mesh.section
    edges = np.hstack([section.edges(name) for name in section.names])
    assert area_of(section.points, edges) == pytest.approx(section_area(rack), rel=2e-4)
    low, high = (mesh.points[:, mesh.at_station(np.arange(section.points.shape[1]), i)] for i in (0, mesh.layers))
    assert high - low == pytest.approx(np.multiply.outer([3.0 * rack.slide, 0.0, 3.0], np.ones(low.shape[1])))
    alpha = rack.pressure_angle
    flank = set(mesh.nodes_of(section.boundaries["flank", (teeth - 1) // 2]))
    for forces in bands.values():
        assert forces.sum(axis=1) == pytest.approx(
            [-math.cos(alpha), -math.sin(alpha), rack.slide * math.cos(alpha)], abs=1e-12
        )
        assert set(np.flatnonzero(np.any(forces, axis=0))) <= flank
    # the force is normal to the surface: to its line up the flank and to that along its helix
    force = next(iter(bands.values())).sum(axis=1)
    assert force @ [-math.sin(alpha), math.cos(alpha), 0.0] == pytest.approx(0.0, abs=1e-12)
    assert force @ [rack.slide, 0.0, 1.0] == pytest.approx(0.0, abs=1e-12)


def test_a_section_slides_along_the_rack():
    section = rack_section(rack_of(20.0, 1), 2.0)
    slid, still = (extruded(section, [0.0, 1.0], 0.0, slide=way) for way in (0.3, 0.0))
    assert slid.points[0] - still.points[0] == pytest.approx(0.3 * still.points[2])
    assert (slid.points[1:] == still.points[1:]).all()
