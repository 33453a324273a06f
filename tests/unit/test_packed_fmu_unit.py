"""The file of an FMU: what is packed, by which names, always of one date, and which compiler makes its library."""

import sys
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.output import fmu


def test_the_same_pair_gives_the_same_file_whenever_it_is_written(monkeypatch, tmp_path):
    monkeypatch.setattr(fmu, "_tables", lambda model: f"tables of {model.name}\n")
    monkeypatch.setattr(fmu, "_description", lambda model, identifier, token: f"{model.name} {identifier} {token}")
    monkeypatch.setattr(fmu, "_machine", lambda: ("machine-system", ".so"))
    monkeypatch.setattr(fmu, "_library", lambda parts, ending: b"library " + parts["sources/mesh_tables.h"][:13])
    model = SimpleNamespace(name="a b")
    target = fmu.write_fmu(tmp_path, model)
    assert (target.parent, target.name) == (tmp_path, "mesh_a_b.fmu")
    with zipfile.ZipFile(target) as packed:
        assert packed.namelist() == [
            "modelDescription.xml", "sources/buildDescription.xml", "sources/mesh.c", "sources/mesh_tables.h",
            "binaries/machine-system/mesh_a_b.so",
        ]  # fmt: skip
        # The first date that the format has; nothing of the clock.
        assert {one.date_time for one in packed.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {one.compress_type for one in packed.infolist()} == {zipfile.ZIP_DEFLATED}
        name, identifier, token = packed.read("modelDescription.xml").decode().rsplit(" ", 2)
        assert (name, identifier) == ("a b", "mesh_a_b")
        tables = packed.read("sources/mesh_tables.h").decode()
        assert tables == f'#define TOKEN "{token}"\ntables of a b\n'
        assert packed.read("binaries/machine-system/mesh_a_b.so") == b"library #define TOKEN"
        assert b'modelIdentifier="mesh_a_b"' in packed.read("sources/buildDescription.xml")
    before = target.read_bytes()
    assert fmu.write_fmu(tmp_path, model).read_bytes() == before
    other = SimpleNamespace(name="other")
    with zipfile.ZipFile(fmu.write_fmu(tmp_path, other)) as packed:
        assert token not in packed.read("modelDescription.xml").decode()  # other tables, another token


@pytest.mark.parametrize(
    ("system", "machine", "named", "ending"),
    [("linux", "x86_64", "x86_64-linux", ".so"), ("win32", "AMD64", "x86_64-windows", ".dll"),
     ("darwin", "arm64", "aarch64-darwin", ".dylib"), ("linux", "riscv64", "riscv64-linux", ".so")],
)  # fmt: skip
def test_platforms_have_the_names_of_the_standard(monkeypatch, system, machine, named, ending):
    monkeypatch.setattr(sys, "platform", system)
    monkeypatch.setattr(fmu.platform, "machine", lambda: machine)
    assert fmu._machine() == (named, ending)


def test_the_compiler_is_that_of_the_environment_or_the_first_that_there_is(monkeypatch):
    there = {"gcc": "/bin/gcc", "clang": "/bin/clang", "mine": "/opt/mine"}
    monkeypatch.setattr(fmu.shutil, "which", there.get)
    monkeypatch.setenv("CC", "mine")
    assert fmu.c_compiler() == "/opt/mine"
    for given in ("lost", ""):
        monkeypatch.setenv("CC", given)
        assert fmu.c_compiler() == "/bin/gcc"
    there.clear()
    with pytest.raises(InputError, match="requires a C compiler"):
        fmu.c_compiler()


@pytest.mark.parametrize(("complaint", "said"), [("first\nlast line\n", "last line"), ("", "no message")])
def test_a_compiler_that_fails_is_quoted_with_its_last_line(monkeypatch, complaint, said):
    ran = []

    def run(words, *, cwd, **more):
        ran.append((words, {path.name: path.read_bytes() for path in Path(cwd).iterdir()}))
        return SimpleNamespace(returncode=1, stderr=complaint)

    monkeypatch.setattr(fmu, "c_compiler", lambda: "/bin/cc")
    monkeypatch.setattr(fmu.subprocess, "run", run)
    with pytest.raises(InputError, match=f"could not be compiled by /bin/cc: {said}"):
        fmu._library({"sources/mesh.c": b"code", "sources/mesh_tables.h": b"tables"}, ".so")
    ((words, files),) = ran
    assert files == {"mesh.c": b"code", "mesh_tables.h": b"tables"}
    assert (words[0], words[-2:]) == ("/bin/cc", ["mesh.c", "-lm"])
    assert words[words.index("-o") + 1] == "mesh.so"
