"""Figures of a run: a notebook shows them, a script writes or opens them.

Gears and pairs as a notebook shows them: the drawing, and the data that it carries.
"""

from __future__ import annotations

import math
import tempfile
import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import PATH, InputError, shown
from fegear.engine.figure.figure import Axis, DeferredFigure, Figure, Panel
from fegear.engine.figure.items import outline
from fegear.geometry.outline import gear_outline
from fegear.output.draw_plotly.notebook import page_html, still_html
from fegear.workbench.given import folder_of

if TYPE_CHECKING:
    import os

    from fegear.base.arrays import Array
    from fegear.geometry import gear as geometry
    from fegear.workbench.gear import Gear
    from fegear.workbench.pair import Pair
    from fegear.workbench.results import Results


@dataclass(frozen=True, repr=False)
class Plots:
    """Some figures of a run.

    Parameters
    ----------
    figures : tuple of Figure or DeferredFigure
    """

    figures: tuple[Figure | DeferredFigure, ...]

    def __repr__(self) -> str:
        """What they are, and how a script sees them."""
        names = "\n".join(f"  {figure!r}" for figure in self.figures)
        count = f"{len(self.figures)} figure{'' if len(self.figures) == 1 else 's'}"
        return f"{count}; .show() opens them, .save(folder) writes them\n{names}"

    def _repr_html_(self) -> str:
        """Show them as pictures."""
        return "".join(still_html(figure.made()) for figure in self.figures)

    def _ipython_display_(self) -> None:
        """Show them in a notebook, each as it shows itself."""
        from IPython.display import display

        for figure in self.figures:
            display(figure.made())

    def show(self) -> None:
        """Open them in the browser, as one page."""
        shown, library = [], True
        for figure in self.figures:
            made = figure.made()
            shown.append(page_html(made, library=library))
            library = library and not made.drawable_in_page
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", suffix=".html", delete=False) as file:
            file.write(f"<!doctype html><meta charset='utf-8'><title>fegear</title>{''.join(shown)}")
        webbrowser.open(Path(file.name).as_uri())

    def save(self, folder: str | os.PathLike[str], kind: str = "png") -> list[Path]:
        """Draw them into a folder as ``<name>.png`` or ``.svg``.

        Parameters
        ----------
        folder : path
            Made if needed.
        kind : {"png", "svg"}

        Returns
        -------
        list of Path
            The pictures.

        Raises
        ------
        InputError
            If the kind is another.
        """
        from fegear.output.draw_png import draw_pictures

        if not isinstance(kind, str) or kind not in ("png", "svg"):
            raise InputError("kind", shown(kind), "is no kind of picture that fegear draws", 'choose "png" or "svg"')
        target = folder_of(folder)
        try:
            target.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError("folder", shown(str(target), PATH), f"cannot be made ({error.strerror})") from None
        return [picture.path for figure in self.figures for picture in draw_pictures(figure.made(), target, kind)]


#: Chords of a drawn outline stay this close to it [modules].
_CHORD = 1e-3


def _circle(radius: float) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, 361)
    return radius * np.stack([np.cos(angle), np.sin(angle)])


def gear_figure(name: str, gear: geometry.Gear) -> Figure:
    """The whole gear: outline, pitch circle, and where the body is held."""
    points = gear_outline(gear, _CHORD) * 1e3
    lines = (
        outline(np.hstack([points, points[:, :1]]), name, width=1.4),
        outline(_circle(gear.pitch_radius * 1e3), "pitch circle", "grey", dash="dashdot", width=0.8),
        outline(_circle(gear.bore_radius * 1e3), "held", "grey", width=0.8),
    )
    return Figure(
        f"gear_{name}", f"Gear {name}",
        f"{gear.teeth} teeth, module {gear.module * 1e3:.6g} mm, profile shift {gear.tooth.profile_shift:.4g}"
        + (f"; the section across the axis, {gear.hand} hand." if gear.helix_angle else "."),
        (Panel(Axis("x", "mm"), Axis("y", "mm"), lines, equal=True, height=1.5),),
    )  # fmt: skip


def _data_html(data: Results) -> str:
    values = data._repr_html_() if data.values else ""
    return values + "".join(table._repr_html_() for table in data.tables)


def gear_html(gear: Gear) -> str:
    """Drawing and data of a gear."""
    return still_html(gear_figure(gear.name, gear.geometry)) + _data_html(gear.data)


def pair_html(pair: Pair) -> str:
    """Drawing and data of a pair."""
    return "".join(still_html(figure.made()) for figure in pair.data.figures) + _data_html(pair.data)
