"""The plane state of 2D teeth in headlines: of the gears that were taken as plane ones, and of no others."""

import fegear
from fegear.output.plane_state import plane_state
from fegear.output.report.run import run_page

PINION = fegear.Gear(21, "2 mm", bore_radius="10 mm", face_width="9 mm", name="pinion")
WHEEL = fegear.Gear(33, "2 mm", bore_radius="15 mm", face_width="9 mm", name="wheel")


def found(driven=WHEEL):
    pair = fegear.Pair(PINION, driven, compliance="potential-energy-simplified")
    return fegear.mesh_stiffness_revolution(pair, torque="30 N*m")


def test_both_states_are_said_with_their_gears():
    assert plane_state(found()) == "plane strain"
    mixed = found(WHEEL.changed(plane="auto"))
    assert plane_state(mixed) == "plane strain (pinion), plane stress (wheel)"
    assert "(2D, plane strain (pinion), plane stress (wheel)): " in repr(mixed).splitlines()[0]
    assert " 2D teeth: plane strain (gear.NAME.plane)." in run_page(found(), (), ()).note


def test_geometry_alone_has_none():
    data = fegear.Pair(PINION, WHEEL).data
    assert plane_state(data) == ""
    assert "2D" not in repr(data).splitlines()[0]
    assert "2D teeth" not in run_page(data, (), ()).note
