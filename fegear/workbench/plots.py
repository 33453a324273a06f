"""Figures of a run: a notebook shows them, a script writes or opens them."""

from __future__ import annotations

import tempfile
import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fegear.base.errors import PATH, InputError, shown
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.output.draw_plotly.notebook import page_html, still_html
from fegear.workbench.given import folder_of

if TYPE_CHECKING:
    import os


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
        """Draw them into a folder as ``<name>.png``, ``.svg`` or ``.pdf``.

        Parameters
        ----------
        folder : path
            Made if needed.
        kind : {"png", "svg", "pdf"}

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

        if not isinstance(kind, str) or kind not in ("png", "svg", "pdf"):
            raise InputError("kind", shown(kind), "is not a supported figure format", 'choose "png", "svg" or "pdf"')
        target = folder_of(folder)
        try:
            target.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError("folder", shown(str(target), PATH), f"cannot be created ({error.strerror})") from None
        return [picture.path for figure in self.figures for picture in draw_pictures(figure.made(), target, kind)]
