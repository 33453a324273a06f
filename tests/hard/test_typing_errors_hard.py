"""Typing errors in case files and command lines: refused in a sentence, or read as what stands there, never otherwise.

What stands there is told by a second, strict reader: TOML as it is, quantities as a number and a unit of the list
below. An accepted slip may stand only where the case means the same as before, or where it left another valid value
of the same kind in the same place: other digits, another unit of the same dimension, another word of a title, another
name of a gear, pair or body, in all places at once. A line that went to another table may stand if that table knows its
key and nothing else is amiss. What takes a line out (a #, or a comment that swallows the next line) is no slip here.
"""

from __future__ import annotations

import copy
import math
import random
import re
import tomllib
from functools import cache
from pathlib import Path

import pytest

from fegear.__main__ import main
from fegear.base.errors import FegearError
from fegear.case.reading import build_scene, read_scene, set_key
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES
from fegear.studies.sweep import read_axis

CASES = Path(__file__).parents[2] / "cases"
#: Every text of a unit that the strict reader takes, by dimension, with its size in SI.
STRICT = {
    "length": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "cm": 1e-2, "inch": 0.0254, "in": 0.0254, "ft": 0.3048},
    "per length": {"/ inch": 1 / 0.0254, "/ in": 1 / 0.0254, "/ mm": 1e3, "/ m": 1.0},
    "angle": {"rad": 1.0, "deg": math.pi / 180, "arcmin": math.pi / 10800, "arcsec": math.pi / 648000},
    "force": {"N": 1.0, "kN": 1e3, "MN": 1e6},
    "torque or torsional stiffness": {"N*m": 1.0, "N m": 1.0, "Nm": 1.0, "kN*m": 1e3, "N*m/rad": 1.0, "N*mm": 1e-3},
    "torsional damping": {"N*m*s": 1.0, "N*m*s/rad": 1.0, "N*mm*s": 1e-3, "N*cm*s": 1e-2},
    "pressure": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm^2": 1e6},
    "density": {"kg/m^3": 1.0, "g/m^3": 1e-3},
    "line load or stiffness": {"N/mm": 1e3, "N/m": 1.0, "kN/m": 1e3, "N/um": 1e6},
    "speed": {"rpm": math.pi / 30, "rad/s": 1.0, "Hz": 2 * math.pi, "kHz": 2e3 * math.pi},
    "frequency": {"Hz": 1.0, "kHz": 1e3, "rad/s": 0.5 / math.pi, "rpm": 1 / 60},
    "inertia": {"kg*m^2": 1.0, "g*m^2": 1e-3, "kg*mm^2": 1e-6, "kg*cm^2": 1e-4},
    "mass": {"kg": 1.0, "g": 1e-3},
    "damping": {"N*s/m": 1.0},
    "viscosity": {"Pa*s": 1.0},
    "kinematic viscosity": {"mm^2/s": 1e-6, "m^2/s": 1.0},
    "temperature": {"degC": 1.0},
    "time": {"h": 3600.0, "min": 60.0, "s": 1.0},
}
_QUANTITY = re.compile(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?) *(.*?) *")
_ROCKWELL = re.compile(r"\d+(?:\.\d+)? HRC")
_KEYBOARD = "abcdefghijklmnopqrstuvwxyzABCGHIKLMNPRSTUZ0123456789.,;:/*^-+_=' \"[]{}()µ°²"


def strictly(text: object) -> dict[str, float]:
    """SI values of a quantity by dimension; none for what is no quantity to the strict reader."""
    match = _QUANTITY.fullmatch(text.strip()) if isinstance(text, str) else None
    if match is None:
        return {}
    unit = re.sub(r"^/ *", "/ ", match[2])
    return {dimension: float(match[1]) * units[unit] for dimension, units in STRICT.items() if unit in units}


# ---- slips ---------------------------------------------------------------------------------------------------------
def _ends_a_comment(text: str, at: int) -> bool:
    start = text.rfind("\n", 0, at) + 1
    return text[at] == "#" or (text[at] == "\n" and "#" in text[start:at])


def slip(text: str, dice: random.Random) -> str:
    """One typing error somewhere in a text; never a #, which is how a line is taken out on purpose."""
    at = dice.choice([i for i in range(len(text)) if not _ends_a_comment(text, i)])
    kind = dice.choice(
        ("drop", "drop", "double", "swap", "replace", "insert", "comma", "thousands", "unit", "section", "case")
    )
    if kind == "drop":
        return text[:at] + text[at + 1 :]
    if kind == "double":
        return text[: at + 1] + text[at:]
    if kind == "swap":
        return text[:at] + text[at + 1 : at + 2] + text[at] + text[at + 2 :]
    if kind == "replace":
        return text[:at] + dice.choice(_KEYBOARD) + text[at + 1 :]
    if kind == "insert":
        return text[:at] + dice.choice(_KEYBOARD) + text[at:]
    if kind == "case":
        return text[:at] + text[at].swapcase() + text[at + 1 :]
    found = {
        "comma": list(re.finditer(r"(?<=\d)\.(?=\d)", text)),
        "thousands": list(re.finditer(r"(?<=\d)(?=\d\d\d\b)", text)),
        "unit": list(re.finditer(r'(?<=\d )([^"\n]+)(?=")', text)),
        "section": list(re.finditer(r"^[^\[\n#].*\n", text, re.MULTILINE)),
    }[kind]
    if not found:
        return slip(text, dice)
    place = dice.choice(found)
    if kind == "section":  # a line that went to another table
        rest = text[: place.start()] + text[place.end() :]
        heads = [m.end() for m in re.finditer(r"^\[.*\]\n", rest, re.MULTILINE)]
        to = dice.choice(heads) if heads else len(rest)
        return rest[:to] + place[0] + rest[to:]
    new = {
        "comma": ",", "thousands": dice.choice((" ", ",", "'", "_")),
        "unit": dice.choice([unit for units in STRICT.values() for unit in units]),
    }[kind]  # fmt: skip
    return text[: place.start()] + new + text[place.end() :]


# ---- what an accepted slip may be ----------------------------------------------------------------------------------
def leaves(value: object, path: tuple[str, ...] = ()):
    """Every value of a document with the keys that lead to it."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, (*path, key))
    elif isinstance(value, list):
        yield (*path, "#"), len(value)
        for index, inner in enumerate(value):
            yield from leaves(inner, (*path, str(index)))
    else:
        yield path, value


def anonymous(document: dict) -> dict[tuple[str, ...], object]:
    """The leaves, with names of the user's choice told by their place in the file, wherever they stand."""
    train = document.get("train", {})
    tables = {kind: document.get(kind, {}) for kind in ("gear", "pair", "transmissibility")}
    tables |= {kind: train.get(kind, {}) for kind in ("body", "shaft", "mesh", "damper")}
    places = {
        (kind, name): f"<{kind} {i}>" for kind, table in tables.items() for i, name in enumerate(table)
    }  # fmt: skip

    def step(path: tuple[str, ...], i: int) -> str:
        kind = "body" if path[:i] == ("train", "torque") else path[i - 1] if i else ""
        return places.get((kind, path[i]), path[i])

    def word(path: tuple[str, ...], value: object) -> object:
        found = [place for (_, name), place in places.items() if name == value]
        return " ".join(found) if found and isinstance(value, str) and path[0] != "title" else value

    return {tuple(step(path, i) for i in range(len(path))): word(path, value) for path, value in leaves(document)}


def told_otherwise(before: str, after: str) -> str:
    """What is wrong with reading `after` where `before` was meant: empty if it may stand."""
    first, second = (anonymous(tomllib.loads(text)) for text in (before, after))
    moved = set(first) ^ set(second)
    if moved and not _one_line_moved(before, after):
        return f"keys differ: {sorted(moved)}"
    for path in set(first) & set(second):
        old, new = first[path], second[path]
        if type(old) is type(new) and (old == new or path[0] == "title"):
            continue
        if {type(old), type(new)} <= {int, float}:
            continue
        if str(old).startswith("<") and str(new).startswith("<"):
            continue
        if path[-1] == "rack" and str(old).replace(" ", "") == str(new).replace(" ", ""):
            continue
        if _ROCKWELL.fullmatch(str(old)) and _ROCKWELL.fullmatch(
            str(new)
        ):  # no factor of SI: the strict reader has none
            continue
        if not set(strictly(old)) & set(strictly(new)):
            return f"{path}: {new!r} for {old!r}"
    return ""


def _one_line_moved(before: str, after: str) -> bool:
    return sorted(before.splitlines()) == sorted(after.splitlines())


def si_values(scene) -> list[float]:
    return sorted(v for _, v in leaves(scene.case.model_dump(exclude_unset=True)) if isinstance(v, float))


@cache
def original(name: str):
    text = (CASES / f"{name}.toml").read_text("utf-8")
    return text, read_scene(CASES / f"{name}.toml")


def outcome(name: str, text: str, folder: Path) -> str:
    """Empty if a slip was refused in a sentence or may stand; else what was wrong."""
    before, meant = original(name)
    if not (folder / "cases").exists():
        (folder / "cases").mkdir()
        (folder / "cases" / "data").symlink_to(CASES / "data")
        (folder / "meshes").symlink_to(CASES.parent / "meshes")
    path = folder / "cases" / f"{name}.toml"
    path.write_text(text, "utf-8")
    try:
        scene = read_scene(path)
        make_plan(scene, STAGES)
    except FegearError as refusal:
        said = str(refusal)
        # The list of all results, which the refusal of an unknown one ends with, takes 600 letters by itself.
        return "" if said and "\n" not in said and len(said) < 900 else f"no sentence: {said!r}"
    if scene.case == meant.case:
        return ""
    wrong = told_otherwise(before, text)
    if wrong:
        return f"accepted: {wrong}"
    for key, value in anonymous(tomllib.loads(text)).items():
        meanings = strictly(value) if key[0] != "title" else {}
        if meanings and not any(math.isclose(m, v, rel_tol=1e-12) for m in meanings.values() for v in si_values(scene)):
            return f"{key}: {value!r} was not read as one of {meanings}"
    return ""


NAMES = sorted(path.stem for path in CASES.glob("*.toml"))


def run_slips(seed: int, count: int, folder: Path) -> list[str]:
    folder = folder / "cases"  # meshes stand beside it
    folder.mkdir()
    dice, wrong = random.Random(seed), []  # noqa: S311  (nobody guesses it)
    for _ in range(count):
        name = dice.choice(NAMES)
        text = slip(original(name)[0], dice)
        found = outcome(name, text, folder)
        if found:
            wrong.append(f"{name}: {found}")
    return wrong


def test_no_typing_error_in_a_case_file_is_read_as_something_else(tmp_path):
    assert run_slips(1, 100, tmp_path) == []


#: Options with a key of the case and a value, and what their value is to the strict reader.
OPTIONS = (
    "gear.a.teeth=30", "gear.a.profile_shift=0.25", "gear.a.module=3.175 mm", 'gear.a.face_width="25.4 mm"',
    "gear.a.pressure_angle=22.5 deg", "gear.a.rack.tip_radius=0.38", "gear.a.material.young_modulus=206.8 GPa",
    'gear.a.relief.tip={amount="12.5 um", length="1.25 mm"}', "pair.I.load=1500 N", "pair.I.speed=3000 rpm",
    'pair.I.loads=["1500 N", "2.5 kN"]', "stiffness.positions=1200", "accuracy.tolerance=1.5e-3",
    "effects.neighbour_coupling=true",
)  # fmt: skip
BASE = """
results = ["load-sharing", "stiffness"]
[gear.a]
teeth = 28
module = "3 mm"
bore_radius = "20 mm"
[pair.I]
driver = "a"
driven = "a"
load = "1 kN"
[effects]
relief = false
"""


def of_option(option: str) -> tuple[str, object]:
    """Key and value of an option to the strict reader: TOML, else a text."""
    key, _, text = option.partition("=")
    try:
        return key.strip(), tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return key.strip(), text.strip()


def may_stand(old: object, new: object) -> bool:
    """Whether an option's value is another one of the same kind."""
    if isinstance(old, dict) and isinstance(new, dict):
        return set(old) == set(new) and all(may_stand(old[key], new[key]) for key in old)
    if isinstance(old, list) and isinstance(new, list):
        return len(old) == len(new) and all(map(may_stand, old, new))
    if isinstance(old, bool) or isinstance(new, bool):
        return old is new
    if isinstance(old, (int, float)) and isinstance(new, (int, float)):
        return True
    return bool(set(strictly(old)) & set(strictly(new)))


def run_option_slips(seed: int, count: int, folder: Path) -> list[str]:
    dice, wrong = random.Random(seed), []  # noqa: S311  (nobody guesses it)
    path = folder / "case.toml"
    path.write_text(BASE, "utf-8")
    for _ in range(count):
        option = dice.choice(OPTIONS)
        slipped = slip(option, dice)
        try:
            scene = read_scene(path, [slipped])
        except FegearError as refusal:
            if "\n" in str(refusal):
                wrong.append(f"no sentence: {refusal}")
            continue
        (key, old), (other, new) = of_option(option), of_option(slipped)
        same = scene.case == read_scene(path, [option]).case
        if not same and not (key == other and may_stand(old, new)):
            wrong.append(f"{slipped!r} was taken for {option!r}")
    return wrong


def test_no_typing_error_in_an_option_is_read_as_something_else(tmp_path):
    assert run_option_slips(1, 150, tmp_path) == []


AXES = (
    "gear.a.profile_shift=-0.4:0.8:25", "gear.a.face_width=10:20:6:mm", "gear.a.module=2.5 mm:3.5 mm:5",
    "gear.a.profile_shift=0.1,0.2,0.5", "pair.I.load=100:10000:4:N:log", 'gear.a.bore_radius="10 mm","12.5 mm"',
    "gear.a.bore_radius=10 mm,12.5 mm", "gear.a.teeth=20,25,30",
)  # fmt: skip
_NUMBERS = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")


def shape(axis: str) -> str:
    """An axis without its digits: what is left when every number stands for any other."""
    return re.sub(r"[\s\"]", "", _NUMBERS.sub("0", axis))


def run_axis_slips(seed: int, count: int) -> list[str]:
    dice, wrong = random.Random(seed), []  # noqa: S311  (nobody guesses it)
    document = tomllib.loads(BASE)
    for _ in range(count):
        axis = dice.choice(AXES)
        slipped = slip(axis, dice)
        try:
            read = read_axis(slipped)
            if len(read) > 100:
                continue  # another count
            for value in read.values:
                tried = copy.deepcopy(document)
                set_key(tried, read.key, value, "--over")
                build_scene(tried, "case", Path())
        except FegearError:
            continue
        if (read.key, read.values) != (read_axis(axis).key, read_axis(axis).values) and shape(slipped) != shape(axis):
            known = {unit for units in STRICT.values() for unit in units}
            letters = re.sub(r"[\W\d_]+", " ", slipped.partition("=")[2]).split()
            if slipped.partition("=")[0] != axis.partition("=")[0] or not set(letters) <= known | {"log"}:
                wrong.append(f"{slipped!r} was taken for {axis!r}: {read.values}")
    return wrong


def test_no_typing_error_in_an_axis_is_read_as_something_else():
    assert run_axis_slips(1, 150) == []


def test_slips_in_commands_and_names_of_options_and_files_end_with_code_2(tmp_path, monkeypatch, capsys):
    path = tmp_path / "case.toml"
    path.write_text(BASE, "utf-8")
    monkeypatch.chdir(tmp_path)
    dice = random.Random(4)  # noqa: S311  (nobody guesses it)
    for _ in range(30):
        words = ["fegear", "plan", "case.toml", "--set", "gear.a.teeth=30"]
        at = dice.randrange(1, 4)
        words[at] = slip(words[at], dice)
        if words[at] in ("plan", "case.toml", "--set"):
            continue
        monkeypatch.setattr("sys.argv", words)
        with pytest.raises(SystemExit) as left:
            main()
        said = capsys.readouterr()
        assert left.value.code == 2, words
        assert said.out == "", words
        assert said.err.strip(), words


@pytest.mark.long
def test_no_typing_error_of_thousands_is_read_as_something_else(tmp_path):
    assert run_slips(2, 5000, tmp_path) == []
    assert run_option_slips(2, 3000, tmp_path) == []
    assert run_axis_slips(2, 3000) == []
