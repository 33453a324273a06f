"""Files that a case names, and the case file itself: encodings, tables that are none, tables that end early."""

from __future__ import annotations

import codecs
import os
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.pair_notes import pair_notes
from fegear.case.built.pair_spec import pair_spec
from fegear.case.csv_file import read_columns
from fegear.case.reading import read_scene
from fegear.case.text_file import read_file, write_file

CASE = """
title = "Zähne"
results = ["load-sharing"]
[gear.a]
teeth = 28
module = "3 mm"
face_width = "10 mm"
[gear.a.relief.table]
file = "relief.csv"
[pair.I]
driver = "a"
driven = "a"
load = "1 kN"
compliance = { source = "cornell" }
[effects]
relief = true
"""
DIMENSIONS = {"radius": "length", "relief": "length"}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    (tmp_path / "relief.csv").write_text("radius [mm],relief [um]\n39.5,0\n43,0\n45,20\n", encoding="utf-8")
    return tmp_path


def columns(folder, content: bytes):
    (folder / "table.csv").write_bytes(content)
    return read_columns(folder / "table.csv", "gear.a.relief.table[0].file", DIMENSIONS)


@pytest.mark.parametrize("mark", [b"", codecs.BOM_UTF8])
@pytest.mark.parametrize("end", [b"\n", b"\r\n"])
def test_a_case_file_is_read_with_and_without_a_byte_order_mark(folder, mark, end):
    (folder / "case.toml").write_bytes(mark + CASE.encode().replace(b"\n", end))
    scene = read_scene(folder / "case.toml")
    assert scene.case.title == "Zähne"
    assert scene.text == CASE


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (CASE.encode("utf-16"), "is in UTF-16, not in UTF-8; save it as UTF-8"),
        (CASE.encode("utf-32"), "is in UTF-16|is not a text"),
        (CASE.encode("latin-1"), "is not in UTF-8: line 2 has the byte 0xe4; save it as UTF-8"),
        (b"\x7fELF\0\0", "is not a text file"),
        (b"a = " + b"9" * 5000, "invalid TOML:"),
        (b"a = " + b"[" * 100000, "invalid TOML:"),
    ],
)
def test_other_encodings_and_impossible_toml_are_refused_in_a_sentence(folder, data, words):
    (folder / "case.toml").write_bytes(data)
    with pytest.raises(InputError, match=words) as refusal:
        read_scene(folder / "case.toml")
    assert "\n" not in str(refusal.value)


def test_tables_are_parted_by_what_parts_their_heads(folder):
    for parting in (b",", b";", b"\t"):
        content = b"# made by hand\nradius [mm],relief [um]\n\n31, 1e1\n33,2.5\n".replace(b",", parting)
        found = columns(folder, codecs.BOM_UTF8 + content)
        np.testing.assert_allclose(found["radius"], [0.031, 0.033], rtol=1e-15)
        np.testing.assert_allclose(found["relief"], [1e-5, 2.5e-6], rtol=1e-15)


def test_samples_without_a_value_are_left_out_of_traces(tmp_path):
    rows = "angle [deg];strain [um/m];note\n0,5;1,5;\n1;;x\n1,5;NaN;\n ;3,5;\n2;#N/A;\n2;#NV;\n2;Overflow;\n2,5;2;\n"
    (tmp_path / "trace.csv").write_text(rows)
    dimensions = {"angle": "angle", "strain": "strain"}
    found = read_columns(tmp_path / "trace.csv", "gauge.g.measured.file", dimensions, gaps=True)
    np.testing.assert_allclose(found["strain"], [1.5e-6, 2e-6])
    assert found.reading == "decimal commas, 6 samples without a value left out"
    with pytest.raises(InputError, match="not a number"):
        read_columns(tmp_path / "trace.csv", "gauge.g.measured.file", dimensions)
    (tmp_path / "trace.csv").write_text("angle [deg],strain [um/m]\n1,\n2,nan\n")
    with pytest.raises(InputError, match="has no line with all values"):
        read_columns(tmp_path / "trace.csv", "gauge.g.measured.file", dimensions, gaps=True)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("radius [mm],relief [um],relief [mm]\n31,1,2\n33,2,3\n", "two columns relief"),
        ("radius [mm],relief [um]\n31,1,5\n33,2\n", "3 entries in line 2 but 2 column heads; use decimal points"),
        ("radius [mm],relief [um]\n31\n33,2\n", "1 entries in line 2"),
        ("radius [mm],relief [um]\n31,5,1,5\n", "use decimal points, or part the entries by semicolons"),
        ("radius [mm];relief [um]\n31,500;1,250\n", 'contains "31,500" in line 2: decimal comma or comma of thousands'),
        (
            "radius [mm];relief [um]\n31,5;1\n32,5;1.5\n",
            r'a comma in "31,5" \(line 2\) and a point in "1.5" \(line 3\)',
        ),
        ("radius [mm];relief [um]\n1.031,5;1\n", r'contains "1.031,5" in line 2, radius: not a number'),
        ("radius [mm],relief [um]\n31,1_0\n", ": not a number"),
        ("radius [mm],relief [um]\n31,٣\n", ": not a number"),
        ("radius [mm],relief [um]\n31,0x10\n", ": not a number"),
        ("radius [mm],relief [um]\n31,\n33,2\n", ": not a number"),
        ("radius [mm],relief [um]\n31,nan\n", "which is not finite"),
        ("radius [mm],relief [um]\n31,1e400\n", "which is not finite"),
        ("radius [mm],relief [um]\n31,-1e300\n", 'has "-1e300" in line 2, relief, which is beyond any machine'),
        ("radius,relief [um]\n31,1\n", "column radius.*has no unit"),
        ("radius [N],relief [um]\n31,1\n", "column radius.*is not a length"),
        ("radius [mm],relief [um]\n", "must have column heads with numbers below"),
        ("", "must have column heads with numbers below"),
        ("radius [mm],relief [um]\n31,1\n" + "9" * 200000 + ",1\n", "not a readable table|not a number"),
        ('radius [mm],relief [um]\n31,"1\n', "not a readable table"),
        ("radius [mm],relief [µm]\n31,ä1\n", ": not a number"),
    ],
)
def test_what_is_no_table_is_refused_in_a_sentence(folder, content, words):
    with pytest.raises(InputError, match=words) as refusal:
        columns(folder, content.encode())
    assert str(refusal.value).startswith("gear.a.relief.table[0].file")
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 300


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16"])
@pytest.mark.parametrize(
    ("text", "reading"),
    [
        ("radius [mm];relief [µm]\r\n31,5;1\r\n0,25;-2,5e0\r\n", "decimal commas"),
        ("radius (mm)\trelief (µm)\n31,5\t1\n0,25\t-2,5\n", "decimal commas"),
        ('"radius [mm]","relief [µm]"\n"31,5","1"\n"0,25","-2,5"\n', "decimal commas"),
        ("Radius / mm;Relief in µm;\n31.5;1;\n.25;-2.5;\n", ""),
        ("radius;place, no.;relief\nmm;;µm\n31,5;3;1\n,25;4;-2,5\n",
         "decimal commas, units from the line below the heads"),
        ("Prüfstand: 3, links\n3. Mai;8:15\nradius [mm];relief [µm]\n31.5;1\n0.25;-2.5\n",
         "2 lines above the heads left out"),
        # a list of channels above the heads has one of their names
        ("Messung;12.05.2026\nKanal;relief;1\nradius;relief\n[mm];[µm]\n31,5;1\n0,25;-2,5\n",
         "decimal commas, units from the line below the heads, 2 lines above the heads left out"),
    ],
)  # fmt: skip
def test_what_measuring_programs_export_is_read_and_how_is_said(folder, text, reading, encoding):
    found = columns(folder, text.encode(encoding))
    np.testing.assert_allclose(found["radius"], [0.0315, 0.00025], rtol=1e-15)
    np.testing.assert_allclose(found["relief"], [1e-6, -2.5e-6], rtol=1e-15)
    assert found.reading == reading


def test_a_file_without_a_wanted_column_is_refused_with_the_heads_that_it_has(folder):
    found = columns(folder, "Prüfstand;3\nWinkel (°);Dehnung (µm/m)\n0,5;1\n".encode("cp1252"))
    with pytest.raises(
        InputError, match=r'column angle; it has "Winkel \(°\)", "Dehnung .*; add it or set angle_column'
    ):
        found.require("angle", "gauge.a.measured.file", "a.csv", "angle_column")


def notes_of(folder):
    scene = read_scene(folder / "case.toml")
    return pair_notes(scene, pair_spec(scene, "I"))


def test_a_relief_table_that_ends_early_is_held_and_the_result_says_so(folder):
    assert not any("used beyond it" in remark for remark in notes_of(folder))
    (folder / "relief.csv").write_text("radius [mm],relief [um]\n43,0\n44,5\n", encoding="utf-8")
    asked = pair_spec(read_scene(folder / "case.toml"), "I")
    remarks = [remark for remark in notes_of(folder) if "used beyond it" in remark]
    # toward the root nothing is removed any more, which needs no words
    assert len(remarks) == 1
    assert "ends at radius 44 mm, before the tip end of the active profile at 45" in remarks[0]
    assert "last value 5 um used beyond it" in remarks[0]
    table, tip = asked.driver.relief.tables[0], asked.pair.roll_angle(asked.pair.x_end, "driver")
    assert table.removal(float(tip)) == pytest.approx(5e-6, rel=1e-14)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
def test_a_pipe_or_a_device_is_refused_and_not_waited_for(folder):
    """`fegear plan pipe` waited for ever: a case is read twice, and nobody writes it a second time, or a first."""
    os.mkfifo(folder / "pipe")
    for path in (folder / "pipe", Path(os.devnull), Path("/dev/zero")):
        with pytest.raises(InputError, match="is a pipe or a device, not a file; save it as a file first"):
            read_scene(path)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("n" * 3000, "cannot be read .File name too long.$"),
        ("a\0b", 'case = "a b": is not a valid file name'),
        ("a\ud800b", 'case = "a b": is not a valid file name'),
        (".", "cannot be read .Is a directory.$"),
    ],
    ids=["3,000 characters", "NUL", "half a character", "a folder"],
)
def test_a_name_that_no_file_can_have_is_refused_in_a_sentence(name, words):
    with pytest.raises(InputError, match=words.replace("$", "")) as refused:
        read_scene(name)
    assert len(str(refused.value)) < 500


def test_a_file_keeps_its_link_its_line_ends_its_mark_and_its_rights(tmp_path):
    real, link = tmp_path / "real.toml", tmp_path / "link.toml"
    real.write_bytes(codecs.BOM_UTF8 + b"a = 1\r\nb = 2\r\n")
    real.chmod(0o640)
    link.symlink_to(real)
    found = read_file(link, "case")
    assert found.text == "a = 1\nb = 2\n"
    write_file(link, found.written("a = 3\nb = 2\n"), "case")
    assert link.is_symlink()
    assert real.read_bytes() == codecs.BOM_UTF8 + b"a = 3\r\nb = 2\r\n"
    assert real.stat().st_mode & 0o777 == 0o640
    assert len(list(tmp_path.iterdir())) == 2
    dangling = tmp_path / "dangling.toml"
    dangling.symlink_to(tmp_path / "new.toml")
    write_file(dangling, b"a = 1\n", "case")
    assert (tmp_path / "new.toml").read_bytes() == b"a = 1\n"


def test_no_file_is_written_in_the_place_of_a_folder_or_a_pipe(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    for name in ("pipe", "folder", "none/below", "n" * 3000, "a\0b"):
        with pytest.raises(InputError, match=r"not a file|cannot be written|is not a valid file name"):
            write_file(tmp_path / name, b"", "case")
    assert sorted(one.name for one in tmp_path.iterdir()) == ["folder", "pipe"]
