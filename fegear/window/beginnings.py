"""What a case may begin with, by the job that it is for: templates, and the cases of the gallery."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.case.drafts.kinds import KINDS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


class Job(NamedTuple):
    """What somebody comes to do.

    Attributes
    ----------
    title, about : str
    templates : tuple of str
        Kinds of drafts for it.
    """

    title: str
    about: str
    templates: tuple[str, ...]


#: Jobs by name; pictures of them have these names, too.
JOBS = {
    "pair": Job(
        "Gear pair under load", "Load sharing, transmission error, mesh stiffness, strength; racks", ("pair", "rack")
    ),
    "relief": Job(
        "Profile relief", "Relief to be ground, for one torque or a range, within its tolerances", ("relief",)
    ),
    "stiffness": Job(
        "Tooth stiffness and root stress", "Tables over the flank, thin rims, cracks, formulas compared with FE",
        ("gear", "ring", "study"),
    ),
    "face": Job(
        "Helical and wide gears", "Load over the face width, K_Hbeta, misalignment, lead modifications", ("helical",)
    ),
    "gearbox": Job(
        "Gearboxes", "Shafts, bearings and their meshes together",
        ("gearbox", "two-stage-gearbox", "three-stage-gearbox"),
    ),
    "train": Job("Vibration of drive trains", "Natural frequencies, resonances, dynamic factor", ("train",)),
    "planetary": Job("Planetary sets", "Planet load sharing, phases, modes, vibration", ("planetary",)),
}  # fmt: skip
#: Beginnings of the names of results by which a case is of a job, the first that fits.
_BY_RESULT = (
    ("relief", ("relief", "design-chart", "flank-design", "fillet-design", "robustness", "sizing")),
    ("train", ("natural-modes", "gear-train", "dynamic", "mesh-force", "torque-ripple", "transmissibility")),
    ("face", ("load-distribution", "tooth-contact", "measured-flanks")),
    ("pair", ("load-sharing", "rating", "flank-surface", "gear-mesh-power-loss", "transmission-error", "rack-")),
)  # fmt: skip


def gallery() -> dict[str, Path]:
    """The cases that come with the source tree, by name; none where fegear is installed without it."""
    folder = Path(__file__).parents[2] / "cases"
    return (
        {path.stem: path for path in sorted(folder.glob("*.toml"))}
        if (folder.parent / "pyproject.toml").is_file()
        else {}
    )


def job_of(document: Mapping[str, Any]) -> str:
    """The job that a case is for, by its tables and the results that it asks for.

    Parameters
    ----------
    document : mapping
        The case as plain tables.
    """
    if "planetary" in document or "compound" in document:
        return "planetary"
    results = document.get("results", ())
    asked = [one for one in results if isinstance(one, str)] if isinstance(results, list) else []
    for job, names in _BY_RESULT[:2]:
        if any(one.startswith(names) for one in asked):
            return job
    if "shaft" in document:
        return "gearbox"
    return next((job for job, names in _BY_RESULT[2:] if any(one.startswith(names) for one in asked)), "stiffness")


@cache
def _titles(_known: tuple[Path, ...]) -> dict[str, tuple[tuple[str, str], ...]]:
    found: dict[str, list[tuple[str, str]]] = {name: [] for name in JOBS}
    for path in _known:
        try:
            document = tomllib.loads(path.read_text("utf-8"))
        except (OSError, ValueError):  # somebody is changing it
            continue
        found[job_of(document)].append((path.stem, str(document.get("title", path.stem))))
    return {name: tuple(rows) for name, rows in found.items()}


def examples() -> dict[str, tuple[tuple[str, str], ...]]:
    """Name and title of the cases of the gallery, by job."""
    return _titles(tuple(gallery().values()))


def templates_of(job: str) -> tuple[tuple[str, str], ...]:
    """Kinds of drafts for a job, each with what it is for."""
    return tuple((name, KINDS[name].about) for name in JOBS[job].templates)


#: Templates that no job names would never be offered.
assert {kind for job in JOBS.values() for kind in job.templates} == set(KINDS)  # noqa: S101  (where it fails, no window opens)


def picture(job: str) -> str:
    """The picture of a job, as SVG in the colours of the page."""
    from fegear.window.pictures import PICTURES_OF_JOBS

    draw: Callable[[], str] = PICTURES_OF_JOBS[job]
    return draw()
