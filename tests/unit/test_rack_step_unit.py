"""The solid of a rack: closed, as large as its section, with the relief of the case, and written by an export."""

from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.rack import drawn_rack
from fegear.case.reading import build_scene
from fegear.fem.solid.rack_step import write_rack_step
from fegear.geometry.rack_outline import rack_outline
from fegear.geometry.rack_relief import relieved_rack_outline
from fegear.output.export import export_gears

CASE = {
    "results": ["rack-geometry"],
    "gear": {"p": {"teeth": 20, "module": "2 mm", "bore_radius": "10 mm", "face_width": "12 mm"}},
    "rack": {
        "r": {
            "pinion": "p", "teeth": 4, "reference_height": "8 mm", "backlash": "40 um", "force": "1 kN",
            "tip_relief": {"amount": "20 um", "height": "0.5 mm"},
        }
    },
}  # fmt: skip


def scene():
    return build_scene(CASE, "rack", Path())


def area(points):
    x, y = points
    return 0.5 * float(x[:-1] @ y[1:] - x[1:] @ y[:-1])


def test_the_solid_is_closed_and_as_large_as_its_drawing(tmp_path):
    rack, relief = drawn_rack(scene(), "r")
    relieved = relieved_rack_outline(rack, relief)
    for pieces in (None, relieved):
        made = write_rack_step(tmp_path / "r.step", rack, pieces)
        assert made.volume == pytest.approx(made.expected, rel=1e-10)
        drawn = area(rack_outline(rack, 1e-7, pieces=pieces)) * rack.face_width
        assert made.volume == pytest.approx(drawn, rel=2e-7)
    ground = area(rack_outline(rack, 1e-7)) - area(rack_outline(rack, 1e-7, pieces=relieved))
    # a triangle of 20 um by 0.5 mm along the flank at each of eight flanks, and a little more where the tip falls off
    flank = 0.5e-3 / np.cos(np.deg2rad(20.0))
    assert ground == pytest.approx(8 * 0.5 * 20e-6 * flank, rel=0.05)


def test_an_export_writes_it_in_millimetres(tmp_path):
    made = export_gears(scene(), tmp_path, ["r"], "step")
    assert made.files == ("r_rack.step",)
    import gmsh

    from fegear.fem.plane.gmsh_session import gmsh_session

    with gmsh_session("read"):
        gmsh.model.occ.importShapes(str(tmp_path / "r_rack.step"))
        gmsh.model.occ.synchronize()
        low_x, low_y, low_z, high_x, _, high_z = gmsh.model.getBoundingBox(-1, -1)
        pitch = 2.0 * np.pi
        assert (low_x, high_x) == pytest.approx((-0.5 * pitch, 3.5 * pitch), abs=1e-5)
        assert (low_y, low_z, high_z) == pytest.approx((-8.0, -6.0, 6.0), abs=1e-5)


def exported(folder, formats, gear=None, **rack):
    given = {**CASE, "gear": {"p": CASE["gear"]["p"] | (gear or {})}, "rack": {"r": CASE["rack"]["r"] | rack}}
    given["gear"]["p"] = {key: value for key, value in given["gear"]["p"].items() if value is not None}
    return export_gears(build_scene(given | {"accuracy": {"tolerance": 0.3}}, "rack", Path()), folder, ["r"], formats)


HELICAL = {"module": None, "normal_module": "2 mm", "helix_angle": "20 deg", "hand": "left"}


@pytest.mark.dear
def test_meshes_of_racks_are_written_plane_and_3d(tmp_path):
    made = exported(tmp_path, "msh,vtu,inp,solid-inp,solid-vtu", teeth=2, support="pins", pin_every=2, first_pin=1)
    assert made.files == tuple(f"r_rack{end}" for end in (".msh", ".vtu", ".inp", "_solid.inp", "_solid.vtu"))
    assert made.remarks == (
        "Rack r, inp, msh, solid-inp, solid-vtu, vtu: flanks as generated, without the tip relief of the case.",
    )
    for name, fixed in (("r_rack.inp", "PINS, 1, 2"), ("r_rack_solid.inp", "PINS, 1, 3")):
        deck = (tmp_path / name).read_text().splitlines()
        assert deck[deck.index("*BOUNDARY") + 1] == fixed
        assert {"*NSET, NSET=PINS", "*NSET, NSET=FLANK_1", "*NSET, NSET=BACK"} <= set(deck)
        assert "ELSET=RACK" in next(line for line in deck if line.startswith("*ELEMENT"))


def test_helical_racks_have_3d_meshes_only(tmp_path):
    made = exported(tmp_path, "dxf,msh", HELICAL)
    assert made.remarks == ("Rack r is helical: no msh is written for it.",)
    with pytest.raises(InputError, match="wrote nothing: Rack r is helical: no msh is written for it"):
        exported(tmp_path, "msh", HELICAL)


@pytest.mark.parametrize("format_", ["msh", "solid-inp"])
def test_bodies_that_cannot_be_meshed_are_refused_by_their_key(tmp_path, format_):
    with pytest.raises(InputError, match=r"^rack\.r\.reference_height = 300 mm: must be between 3 and 102\.5 mm"):
        exported(tmp_path, format_, reference_height="300 mm", tip_relief=None)
