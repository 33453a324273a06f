"""Hook of mkdocs: runs every case and makes a page of each from the case file and what the run left behind.

Results are kept in ``results/gallery`` and made anew when the case or the program changes. ``FEGEAR_GALLERY`` restricts
the gallery to some cases (names separated by commas).
"""

from __future__ import annotations

import itertools
import json
import logging
import re
import shutil
import tomllib
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from case_run import run_case
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from pathspec.gitignore import GitIgnoreSpec
from shortened import chosen

from fegear.base.cache_keys import content_key
from fegear.base.code_version import code_version
from fegear.engine.citation import bibliography

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "cases"
MADE = ROOT / "results" / "gallery"
#: What mkdocs prints while it works; a gallery takes minutes, and says where it is.
log = logging.getLogger("mkdocs.plugins.gallery")
#: Rows of a table's beginning that a page shows.
_ROWS = 8
#: Characters of a case's comment after which no further sentence of it is on the gallery's first page.
_ABOUT = 200
#: Ten pictures, each from one command: case, picture, and what it shows.
TEN = (
    ("thin_rim", "deformed_rim", "A tooth on a thin rim under load, displacements magnified, with the stress inside."),
    ("calculix_pair", "load_sharing_I", "Load of one tooth pair over its engagement, at four loads."),
    (
        "pinion_and_wheel",
        "root_stress_history_I",
        "Root stress of both gears as a tooth passes: own load and neighbours'.",
    ),
    (
        "mark_minimum_excitation",
        "harris_map_I",
        "Transmission error at five loads: designed relief, ground reliefs, none.",
    ),
    ("helical_load", "flank_pressure_I", "Pressure on both flanks of a helical pair, solved as solids."),
    (
        "planetary_set",
        "planet_load_sharing_P",
        "Four planets, one of them late: who carries what, and the set's transmission error.",
    ),
    ("two_stage_shafts", "shaft_deflection_mid", "How the middle shaft of a gearbox bends on its bearings."),
    ("lin_dynamic_factor", "dynamic_factor_I", "Tooth force over speed, and the share of time with loss of contact."),
    ("four_square_dynamics", "mesh_force_waterfall_I", "Harmonics of the mesh force over speed."),
    ("rating_spur", "rating_I", "Safeties by ISO 6336, AGMA 2101 and with computed stresses."),
)
#: Pages outside docs/ that belong to the site, and where links to them are found.
_OUTSIDE = {
    "readme.md": ROOT / "README.md",
    "meshes.md": ROOT / "meshes" / "README.md",
    "packaging.md": ROOT / "packaging" / "README.md",
} | {f"{name.lower()}.md": ROOT / f"{name}.md" for name in ("CONTRIBUTING", "SECURITY", "CHANGELOG")}


def cases() -> list[Path]:
    """Case files of the gallery that are run for this site."""
    return [path for path in _all() if chosen(path.stem)]


def _all() -> list[Path]:
    return [*sorted(CASES.glob("*.toml")), *sorted((CASES / "sources").glob("*.toml"))]


def case_name(path: Path) -> str:
    """``thin_rim``, ``sources/mark_fig22``."""
    return path.relative_to(CASES).with_suffix("").as_posix()


def _title(path: Path) -> str:
    return str(tomllib.loads(path.read_text("utf-8")).get("title") or path.stem)


def _run(path: Path) -> None:
    """Run a case unless its results are there, made by the same program from the same files."""
    out, stamp = MADE / case_name(path), MADE / f"{case_name(path)}.key"
    beside = {p.name: p.read_text("utf-8", "replace") for p in sorted(CASES.rglob("*")) if p.is_file() and p != path}
    named = {name: text for name, text in beside.items() if name in path.read_text("utf-8")}
    key = content_key(code_version(), path.read_text("utf-8"), named)
    if stamp.is_file() and stamp.read_text() == key and (out / "summary.json").is_file():
        return
    log.info("Running cases/%s.toml", case_name(path))
    stamp.parent.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(out, ignore_errors=True)
    if fault := run_case(path, out):
        raise PluginError(f"the case {path.name} does not run: {fault}")
    stamp.write_text(key)


def _numbers(results: dict[str, dict[str, object]]) -> str:
    rows = ["| quantity | value | unit | estimated error |", "|---|---|---|---|"]
    for name, found in results.items():
        value = "none" if found["value"] is None else f"{found['value']:.6g}"
        error = {None: "not estimated", 0: "exact"}.get(found["error"]) or f"{found['error']:.1e}"
        rows.append(f"| `{name}` | {value} | {found['unit']} | {error} |")
    return "\n".join(rows)


def _table(path: Path) -> str:
    head, *rows = [line.split(",") for line in path.read_text("utf-8").splitlines()[: _ROWS + 1]]

    def short(text: str) -> str:
        try:
            return f"{float(text):.5g}"
        except ValueError:
            return text

    lines = [head, ["---"] * len(head), *([short(cell) for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _comment(path: Path) -> str:
    """What a case file says of itself before its first key."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), path.read_text("utf-8").splitlines())
    return " ".join(line.lstrip("# ") for line in lines)


def _card(path: Path) -> str:
    """A case on the gallery's first page: its title, what it is about, and its first picture, smaller."""
    summary = json.loads((MADE / path.stem / "summary.json").read_text("utf-8"))
    pictures = [name for name in summary["files"] if name.endswith(".png")]
    sentences = re.split(r"(?<=[a-z)\d][.:]) (?=[A-Z])", _comment(path))
    reach = itertools.accumulate(len(sentence) for sentence in sentences)
    about = " ".join(sentence for sentence, end in zip(sentences, reach, strict=True) if end - len(sentence) < _ABOUT)
    shown = f"[![{_title(path)}]({path.stem}/{pictures[0]})]({path.stem}.md)" if pictures else ""
    return f"## [{_title(path)}]({path.stem}.md)\n\n{shown}\n\n{about}"


def ten() -> list[str]:
    """The ten pictures with their commands, as far as their cases are run for this site."""
    names = {path.stem for path in cases()}
    made = []
    for case, picture, words in TEN:
        if case in names:
            shown = f"{case}/plots/{picture}.png"
            if not (MADE / shown).is_file():
                raise PluginError(f"the gallery shows {shown}, which the case does not draw")
            made.append(f"-   [![{words}]({shown})]({case}.md)\n\n    {words}\n\n    `./run.sh cases/{case}.toml`")
    listed = "\n\n".join(made)
    return (
        ["## Ten pictures, each by one command", f'<div class="cards ten" markdown>\n\n{listed}\n\n</div>']
        if made
        else []
    )


def page(path: Path) -> str:
    """Text of a case's page."""
    out, text = MADE / case_name(path), path.read_text("utf-8")
    summary = json.loads((out / "summary.json").read_text("utf-8"))
    pictures = [name for name in summary["files"] if name.endswith(".png")]
    parts = [
        f"[Gallery]({'../' * case_name(path).count('/')}index.md)",
        f"# {_title(path)}",
        _comment(path),
        f"```sh\nfegear run cases/{case_name(path)}.toml\n```",
        (
            f"Computed in {summary['timings']['total']:.2f} s. [The whole report]({path.stem}/report.html), "
            f"[all numbers as a dataset]({path.stem}/results.nc)."
        ),
        "## Warnings\n\n" + "\n".join(f"- {remark}" for remark in summary["remarks"]) if summary["remarks"] else "",
        "## Numbers\n\n" + _numbers(summary["results"]) if summary["results"] else "",
        "## Pictures\n\n" + "\n\n".join(f"![{Path(name).stem}]({path.stem}/{name})" for name in pictures)
        if pictures
        else "",
        "## Tables\n\n"
        + "\n\n".join(
            f"### [{Path(name).name}]({path.stem}/{name})\n\n{_table(out / name)}"
            for name in summary["files"]
            if name.endswith(".csv")
        ),
        f"## The case file\n\n```toml\n{text}```",
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def references() -> str:
    """Text of the page of references, from the bibliography that reports cite."""
    works = sorted(bibliography().values(), key=lambda work: (work.authors.split(". ")[-1], work.year))
    lines = [f"- {work.full}" for work in works]
    return "\n".join(
        ["# References", "", "What fegear's results rest on. A report names those that its case used.", "", *lines, ""]
    )


def jobs() -> list[Callable[[], None]]:
    """What is to be run before the pages can be made."""
    return [partial(_run, path) for path in cases()]


# ---- what mkdocs calls -------------------------------------------------------------------------------------------
def on_config(config):
    """Put the gallery into the menu: its first page leads to the pages of the cases, and their name leads back."""
    config.nav.append({"Gallery": "gallery/index.md"})
    config.not_in_nav = GitIgnoreSpec.from_lines(["gallery/*", "!gallery/index.md"])
    return config


def on_files(files, config):
    """Add the pages of the cases, which docs/made.py has run, with all that these show."""
    files.append(File.generated(config, "references.md", content=references()))
    for name, source in _OUTSIDE.items():
        files.append(File.generated(config, name, content=source.read_text("utf-8")))
    files.append(File.generated(config, "CITATION.cff", content=(ROOT / "CITATION.cff").read_text("utf-8")))
    index = ["# Gallery", "", "Each page is one file of `cases/` and what `fegear run` makes of it.", "", *ten(), ""]
    of_papers = [path for path in cases() if path.parent != CASES]
    for path in cases():
        if path not in of_papers:
            index.append(_card(path))
        files.append(File.generated(config, f"gallery/{case_name(path)}.md", content=page(path)))
        for made in sorted((MADE / case_name(path)).rglob("*")):
            relative = made.relative_to(MADE).as_posix()
            if made.is_file() and made.suffix in (".png", ".csv", ".html", ".nc"):
                files.append(File.generated(config, f"gallery/{relative}", abs_src_path=str(made)))
    if of_papers:
        listed = [f"- [{_title(path)}]({case_name(path)}.md)" for path in of_papers]
        index += ["## Figures of the papers", "\n".join(listed)]
    for path in (one for one in _all() if not chosen(one.stem)):
        left_out = f"# {_title(path)}\n\nThis case was not run for this shortened site.\n"
        files.append(File.generated(config, f"gallery/{case_name(path)}.md", content=left_out))
    files.append(File.generated(config, "gallery/index.md", content="\n\n".join(index) + "\n"))
    return files


def on_page_markdown(markdown, page, **_others):
    """Let links that hold in the repository hold in the site."""
    if page.file.src_uri in _OUTSIDE and page.file.src_uri != "meshes.md":  # they stand at the top of the tree
        markdown = re.sub(r"\]\(([A-Z]+)\.md", lambda m: f"]({m[1].lower()}.md", markdown.replace("](docs/", "]("))
    top = "../" * page.file.src_uri.count("/")
    markdown = re.sub(r"\]\((?:\.\./)*(?:cases/)?(meshes|packaging)/README\.md\)", rf"]({top}\1.md)", markdown)
    return re.sub(r"\]\((?:\.\./)*cases/((?:sources/)?\w+)\.toml\)", rf"]({top}gallery/\1.md)", markdown)


def on_post_build(config):
    """Say where the site is."""
    log.info("The site starts at %s", Path(config.site_dir) / "index.html")
