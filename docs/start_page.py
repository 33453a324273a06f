"""Hook of mkdocs: the first page of the site has a pair of gears that turns, and numbers of this build's own run."""

from __future__ import annotations

import json
import tomllib
from typing import TYPE_CHECKING

import numpy as np
from gallery import CASES, MADE

import fegear

if TYPE_CHECKING:
    from fegear.geometry.involute_tooth import InvoluteTooth

#: The case whose numbers the page shows.
_CASE = "pinion_and_wheel"
#: Seconds of a turn of the driver, and points of each curve of an outline.
_TURN, _POINTS = 20.0, 9
#: What of the pair is drawn, about the pitch point [modules].
_LEFT, _RIGHT, _UP = 19.0, 23.0, 7.5


def _outline(tooth: InvoluteTooth, middle: complex) -> str:
    """The whole outline as a path of modules, y down; `middle` is where the middle of tooth 0 points."""
    half = [curve.points(np.linspace(curve.start, curve.end, _POINTS)) for curve in tooth.outline.values()]
    right = np.concatenate([x + 1j * y for x, y in half])
    one = np.concatenate([right, -np.conj(right[::-1])]) / 1j * middle
    around = np.exp(2j * np.pi * np.arange(tooth.teeth) / tooth.teeth)[:, None] * one
    return "M" + "L".join(f"{z.real:.3f} {-z.imag:.3f}" for z in around.ravel()) + "Z"


def moving_gears(pair: fegear.Pair) -> str:
    """Both gears about their pitch point as a picture that turns, or stands still for who wants no motion."""
    teeth = pair.geometry.driver.tooth, pair.geometry.driven.tooth
    distance = pair.geometry.centre_distance / pair.geometry.driver.module
    share = [tooth.teeth / (teeth[0].teeth + teeth[1].teeth) for tooth in teeth]
    centres = -share[0] * distance, share[1] * distance
    # A tooth of the driver and a space of the driven gear point at each other.
    middles = 1.0 + 0.0j, np.exp(1j * np.pi * (1.0 + 1.0 / teeth[1].teeth))
    drawn = [
        f'<g transform="translate({_LEFT + x:.4f} {_UP})"><path class="{name}" d="{_outline(tooth, middle)}"'
        f' style="animation-duration:{_TURN * tooth.teeth / teeth[0].teeth:.3f}s"/></g>'
        for name, tooth, middle, x in zip(("driver", "driven"), teeth, middles, centres, strict=True)
    ]
    return (
        f'<svg class="moving-gears" viewBox="0 0 {_LEFT + _RIGHT} {2 * _UP}" role="img"'
        f' aria-label="{teeth[0].teeth} and {teeth[1].teeth} teeth in mesh, turning">{"".join(drawn)}</svg>'
    )


def _numbers() -> str:
    """The three numbers; a shortened site without the case has none."""
    kept = MADE / _CASE / "summary.json"
    if not kept.is_file():
        return ""
    summary = json.loads(kept.read_text("utf-8"))
    mean = summary["results"]["I.te_mean"]
    share = f"{mean['error'] / mean['value']:.0e}".replace("e-0", "e-")
    stated = f"{mean['value']:.2f} ± {mean['error']:.4f} {mean['unit']}"
    seconds = f"{summary['timings']['total']:.1f} s"
    cards = {
        f"[{share}](numerics.md)": f"stated error of the mean transmission error of this pair, {stated}",
        f"[{seconds}](gallery/{_CASE}.md)": "from nothing to load sharing, transmission error and root stress of this "
        "pair, when this site was built",
        "[0.06 %](loaded-teeth.md#verification)": "largest difference of the load from two whole gears pressed "
        "together in CalculiX; root stress 0.3 %",
    }
    return "\n".join(f"-   **{number}**\n\n    {about}\n" for number, about in cards.items())


# ---- what mkdocs calls -------------------------------------------------------------------------------------------
def on_page_markdown(markdown, page, **_others):
    """Put gears, numbers and version into the page where a site starts."""
    if page.file.src_uri != "index.md":
        return markdown
    keys = tomllib.loads((CASES / f"{_CASE}.toml").read_text("utf-8"))["gear"]
    pair = fegear.Pair(*(fegear.Gear.of(name, keys[name]) for name in ("pinion", "wheel")))
    made = {"moving gears": moving_gears(pair), "numbers": _numbers(), "version": fegear.__version__}
    for name, part in made.items():
        markdown = markdown.replace(f"<!-- {name} -->", part)
    return markdown
