"""Tables that users name: refused where they do not cover what they are of, are in another unit or contradictory."""

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.case.reading import build_scene

HEAD = "x [mm],compliance [um/N]"


def rows(x, c, head=HEAD):
    return head + "\n" + "".join(f"{a},{b}\n" for a, b in zip(x, c, strict=True))


def compliance(x):
    """Some tooth of module 3 mm and face 20 mm [um/N]."""
    return 0.0025 + 0.00002 * (np.asarray(x) + 8.0) ** 2


def run(tmp_path, text, of="tooth", fit="cubic"):
    (tmp_path / "c.csv").write_text(text)
    case = {
        "results": ["transmission-error"],
        "gear": {"a": {"teeth": 28, "module": "3 mm", "face_width": "20 mm"}},
        "pair": {"I": {"driver": "a", "driven": "a", "load": "5 kN",
                       "compliance": {"source": "table", "file": str(tmp_path / "c.csv"), "of": of, "fit": fit}}},
    }  # fmt: skip
    return fegear.run(case, progress=False)


PATH = np.linspace(-7.5, 7.5, 16)


def refused(tmp_path, text, *words, key="pair.I.compliance.file", **more):
    with pytest.raises(InputError) as error:
        run(tmp_path, text, **more)
    assert error.value.key == key
    for word in words:
        assert word in str(error.value)


def test_a_table_over_the_path_is_taken(tmp_path):
    found = run(tmp_path, rows(PATH, compliance(PATH)))
    assert 5.0 < found.values["I.te_mean"].value < 30.0
    assert not any("extrapolated" in remark for remark in found.remarks)


def test_ends_of_the_path_that_are_left_out_are_said(tmp_path):
    short = PATH[np.abs(PATH) < 6.8]
    found = run(tmp_path, rows(short, compliance(short)))
    whole = run(tmp_path, rows(PATH, compliance(PATH)))
    assert sum("extrapolated" in remark for remark in found.remarks) == 1
    assert found.values["I.te_mean"].value == pytest.approx(whole.values["I.te_mean"].value, rel=1e-9)


@pytest.mark.parametrize("of", ["tooth", "pair"])
@pytest.mark.parametrize(
    "x",
    [np.linspace(42.0, 58.0, 17), np.linspace(-7.5, 0.0, 9), PATH * 1e-3, PATH * 0.6, np.linspace(-40.0, -30.0, 9)],
    ids=["from the centre", "half of it", "metres as mm", "six tenths", "elsewhere"],
)
def test_a_table_that_does_not_cover_the_path_is_refused(tmp_path, x, of):
    refused(tmp_path, rows(x, compliance(np.linspace(-7.5, 7.5, x.size))),
            "must cover the path of contact, -7.25", "check the unit", of=of)  # fmt: skip


@pytest.mark.parametrize(("factor", "unit"), [(1.0, "mm/N"), (1e-3, "um/N"), (1e300, "um/N"), (1.0, "m/N")])
def test_compliances_in_another_unit_are_refused(tmp_path, factor, unit):
    text = rows(PATH, factor * compliance(PATH), f"x [mm],compliance [{unit}]")
    refused(
        tmp_path,
        text,
        "beyond any machine; check the unit" if factor == 1e300 else "check the unit in the head of the column",
    )


def test_a_head_without_a_unit_is_refused(tmp_path):
    with pytest.raises(InputError, match="column compliance"):
        run(tmp_path, rows(PATH, compliance(PATH), "x [mm],compliance"))


def test_two_kinds_of_positions_or_of_compliances_are_refused(tmp_path):
    both = "x [mm],roll_angle [deg],compliance [um/N]\n" + "".join(f"{x},{20 + x},0.003\n" for x in PATH)
    refused(tmp_path, both, "only one of the columns x and roll_angle", "remove column roll_angle")
    both = "x [mm],compliance [um/N],load [N],deflection [um]\n" + "".join(f"{x},0.003,1000,3\n" for x in PATH)
    refused(tmp_path, both, "both compliance and deflection")
    refused(tmp_path, "compliance [um/N]\n0.003\n0.004\n", "requires a column x or roll_angle")


def test_a_fit_that_falls_below_zero_between_entries_is_refused(tmp_path):
    x = np.array([-7.5, -7.4, -7.3, 7.3, 7.4, 7.5])
    refused(tmp_path, rows(x, [0.02, 0.004, 0.002, 0.002, 0.004, 0.02]), 'set fit = "linear"',
            key="pair.I.compliance.fit")  # fmt: skip
    run(tmp_path, rows(x, [0.02, 0.004, 0.002, 0.002, 0.004, 0.02]), fit="linear")


def wide(tmp_path, text, key, **gear):
    (tmp_path / "t.csv").write_text(text)
    shared = {"teeth": 28, "module": "3 mm", "face_width": "20 mm"}
    case = {
        "results": ["load-distribution"],
        "gear": {"a": shared | gear, "b": shared},
        "pair": {"I": {"driver": "a", "driven": "b", "load": "5 kN", "width": "slices"} | ({} if gear else
                      {"line_error": {"file": str(tmp_path / "t.csv")}})},
        "effects": {"relief": True} if gear else {"misalignment": True},
    }  # fmt: skip
    with pytest.raises(InputError) as error:
        fegear.run(case, progress=False)
    assert error.value.key == key
    return str(error.value)


def test_lead_tables_and_topographies_cover_the_face(tmp_path):
    file = str(tmp_path / "t.csv")
    z = np.linspace(-10.0, 10.0, 5)
    lead = {"lead": {"file": file}}
    for off in (z * 1e-3, z + 15.0, z * 0.5):
        said = wide(tmp_path, rows(off, 0.1 * z**2, "z [mm],removal [um]"), "gear.a.lead.file", **lead)
        assert "must cover the face width, -10 to 10 mm" in said
    topography = {"topography": {"file": file}}
    grid = [(r, a) for r in (40.0, 41.0, 44.0) for a in z * 1e-3]
    text = "radius [mm],z [mm],removal [um]\n" + "".join(f"{r},{a},1.0\n" for r, a in grid)
    assert "must cover the face" in wide(tmp_path, text, "gear.a.topography.file", **topography)
    text = "radius [mm],roll_angle [deg],z [mm],removal [um]\n" + "".join(f"{r},{r},{a * 1e3},1.0\n" for r, a in grid)
    assert "only one of the columns" in wide(tmp_path, text, "gear.a.topography.file", **topography)
    text = "roll_angle [deg],z [mm],removal [um]\n" + "".join(f"{r + 100.0},{a * 1e3},1.0\n" for r, a in grid)
    assert "lies outside the active profile," in wide(tmp_path, text, "gear.a.topography", **topography)


def notes_of(tmp_path, text, **gear):
    """Notes on tables that end early, of a case whose flanks are loaded over the face."""
    from fegear.case.built.pair_spec import pair_spec
    from fegear.case.built.table_ends import table_end_notes

    (tmp_path / "t.csv").write_text(text)
    shared = {"teeth": 28, "module": "3 mm", "face_width": "20 mm"}
    case = {
        "results": ["load-distribution"],
        "gear": {"a": shared | gear, "b": shared},
        "pair": {"I": {"driver": "a", "driven": "b", "load": "5 kN", "width": "slices"}},
        "effects": {"relief": True},
    }
    return [note for note in table_end_notes(pair_spec(build_scene(case, "case", tmp_path), "I")) if "ends at" in note]


def test_tables_that_end_before_the_flank_does_say_where_and_what_is_held(tmp_path):
    """Tips relieved short of their ends touch under overload, and nobody who loads wide flanks was told."""
    file = str(tmp_path / "t.csv")
    relief = {"relief": {"table": {"file": file}}}
    head = "radius [mm],relief [um]"
    (said,) = notes_of(tmp_path, rows([39.9, 44.0], [0.0, 12.0], head), **relief)
    assert "Gear a: relief table ends at radius 44 mm, before the tip end of the active profile at 45 mm" in said
    assert "last value 12 um used" in said
    (said,) = notes_of(tmp_path, rows([42.0, 45.0], [3.0, 12.0], head), **relief)
    assert "ends at radius 42 mm, before the root end" in said
    assert notes_of(tmp_path, rows([39.9, 45.0], [3.0, 12.0], head), **relief) == []
    lead = {"lead": {"file": file}}
    (said,) = notes_of(tmp_path, rows([-10.0, 9.0], [0.0, 5.0], "z [mm],removal [um]"), **lead)
    assert "lead table ends at z = 9 mm, before end II of the face at 10 mm" in said
    grid = [(r, z) for r in (39.9, 44.0) for z in (-9.0, 10.0)]
    text = "radius [mm],z [mm],removal [um]\n" + "".join(f"{r},{z},{r - 39.9}\n" for r, z in grid)
    tip, end = notes_of(tmp_path, text, topography={"file": file})
    assert "topography ends at radius 44 mm, before the tip end" in tip
    assert "topography ends at z = -9 mm, before end I of the face at -10 mm" in end


def test_a_gap_in_millimetres_is_refused(tmp_path):
    text = rows([-10.0, 10.0], [0.0, 12.0], "z [mm],gap [mm]")
    assert "check the unit in the head" in wide(tmp_path, text, "pair.I.line_error.file")


def test_a_relief_table_has_radii_or_roll_angles(tmp_path):
    (tmp_path / "t.csv").write_text("radius [mm],roll_angle [deg],relief [um]\n42,20,0\n44,25,10\n")
    case = {
        "results": ["transmission-error"],
        "gear": {"a": {"teeth": 28, "module": "3 mm", "relief": {"table": {"file": str(tmp_path / "t.csv")}}}},
        "pair": {"I": {"driver": "a", "driven": "a", "load": "5 kN", "compliance": {"source": "weber-banaschek"}}},
        "effects": {"relief": True},
    }
    with pytest.raises(InputError, match="only one of the columns roll_angle and radius"):
        fegear.run(case, progress=False)
