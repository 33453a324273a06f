"""How figures are drawn, on paper and in pages, kept in ``drawn_figures.json``: places, widths, sizes, texts, colours.

    python tests/golden/drawn_figures.py [--accept]

A few figures with every kind of item, axis, mark and menu. Of paper (matplotlib) the artists of the sheet are kept, of
pages (plotly) data and layout, each part by a sum of its numbers in which every one has a weight of its own, and by a
checksum of its words. After a change that is meant to be seen, look at pictures and accept.
"""

import argparse
import base64
import json
import zlib
from pathlib import Path

import numpy as np

KEPT = Path(__file__).with_suffix(".json")


def figures():
    """Figures of every kind of panel, by name."""
    from fegear.engine.figure.axis import Axis, Scale
    from fegear.engine.figure.figure import Figure, View
    from fegear.engine.figure.items import Bars, Curve, HeatMap, Mark, Points, Stems, TriangleField, Zone
    from fegear.engine.figure.panel import Panel

    x = np.linspace(1.0, 5.0, 30)
    few = np.array([1.0, 2.0, 4.0, 5.0])
    tiles = np.array([[1.0, 2.0, np.nan], [4.0, 5.0, 6.0]])
    corners = np.array([[0.0, 2.0, 2.0, 0.0, 1.0, 2.0], [0.0, 0.0, 1.0, 1.0, 0.0, 0.5]])
    triangle = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 2]]).T
    along, force = Axis("x", "mm", second=Scale("radius", "mm", x, 2.0 * x)), Axis("c_{0}", "um.mm/N")
    words, log = Axis("mode", categories=("a", "b\nc", "d")), Axis("t", "s", log=True)
    curves = Panel(along, force, (
        Curve(x, np.sin(x), "curve", "tension", 0.1 + 0.0 * x), Curve(few, few, "few", "compression", fill=True),
        Curve(x, x**0.5, "stepped", "series:1", dash="steps", markers=False), Curve(x, -x, "", "grey", dash="dot"),
        Curve(few, -few, "told", "blue", notes=("p", "q", "r", "s")),
    ), (
        Mark("x", 2.0, "here"), Mark("y", 0.5, "there"), Mark("x", 2.01, "too near"), Zone("y", -0.1, 0.1),
    ), "A title")  # fmt: skip
    bars = (Bars([0, 1, 2], [0.2, 0.4, 0.1], "first", "series:0", error=[0.1, 0.1, 0.2]),
            Bars([0, 1, 2], [0.5, 0.1, 0.3], "second", "series:1"))  # fmt: skip
    shaded = Points(few, few**2, "shaded", "ink", shade=few * 10.0, shade_label="load [N]", size=7.0)
    noted = Points(few, few**3, "noted", "red", "x", 8.0, error=0.1 * few, notes=("one", "two", "three", "four"),
                   written=True)  # fmt: skip
    lettered = Points(few, few, "lettered", "orange", "triangle-up", notes=("A", "B", "C", "D"), written=True)
    stems = Stems(
        few, [10.0, 1e-3, 2.0, 5.0], "lines", "series:2", notes=("n1", "n2", "n3", "n4"), numbers=tuple("1234")
    )
    ticked = Axis("place", ticks=((1.0, "start"), (5.0, "end")), limits=(0.5, 6.0))
    views = tuple(
        View(name, (Panel(Axis("n", whole=True), Axis(unit, unit, zero=True), (Curve(few, scale * few, name),)),))
        for name, unit, scale in (("te", "um", 1.0), ("k", "N", 50.0), ("S", "", 3.0))
    )
    return {
        "curves": Figure("curves", "Curves", "C.", (curves,)),
        "bars": Figure("bars", "Bars", "C.", (
            Panel(words, Axis("share", zero=True), bars, stacked=True), Panel(words, Axis("other"), bars, height=1.4),
        )),
        "logs": Figure("logs", "Logarithms", "C.", (
            Panel(log, Axis("e", log=True), (noted, Curve(few, 1.0 / few, "", "ink", dash="steps"))),
            Panel(Axis("f", "Hz"), Axis("F", "N", log=True), (stems,)),
            Panel(Axis("wide", log=True), Axis("plain", log=True), (Curve(10.0 ** few, few, "wide"),)),
        )),
        "maps": Figure("maps", "Maps with a long title that does not fit into a line of its own", "C.", (
            Panel(Axis("x"), Axis("y"), (HeatMap([1, 2, 3], [1, 2], tiles, "z", "um", numbers=True),)),
            Panel(Axis("x"), Axis("y"), (HeatMap([1, 2, 3], [1, 2], tiles, "z", "um", (3.0, 2.0), numbers=True),)),
            Panel(Axis("x"), Axis("q"), (HeatMap([1, 2, 3], [1, 2], tiles, "w", "N", limits=(0.0, 9.0)),)),
        ), columns=2),
        "points": Figure("points", "Points", "C.", (
            Panel(ticked, Axis("y"), (shaded,)), Panel(ticked, Axis("y"), (lettered,), title="below"),
            Panel(Axis(categories=("p", "q")), Axis(hidden=True, limits=(-0.05, 1.05)), (Curve([0, 1], [0, 1], "l"),)),
        )),
        "beside": Figure("beside", "Beside", "C.", (
            Panel(Axis("x", "mm"), force, (Curve(few, few, "plain"),), title="One\nof two lines"),
            Panel(along, force, (Curve(x, x, "scaled"),)),
            Panel(along, Axis("y"), (Curve(x, -x, "below"),)),
        ), columns=2),
        "views": Figure("views", "Views", "C.", views=views),
        "field": Figure("field", "Field", "C.", (
            Panel(Axis("x", "mm"), Axis("y", "mm"), (
                TriangleField(corners, triangle, np.arange(6.0), 4.0, "s", "MPa"),
            ), equal=True),
        )),
    }  # fmt: skip


def told(numbers, texts=()):
    """What is kept of a part: how many numbers, their weighted sum over the largest, and the words."""
    flat = np.concatenate([np.empty(0), *(np.ravel(np.asarray(one, dtype=float)) for one in numbers)])
    known = np.where(np.isfinite(flat), flat, -1.2345)
    weights = np.cos(1.0 + 2.399963 * np.arange(flat.size))
    words = zlib.crc32("\n".join(map(str, texts)).encode())
    return [int(flat.size), float(f"{np.dot(weights, known):.7g}") + 0.0, words]


def on_paper(figure):
    """Parts of a sheet as matplotlib would draw it."""
    from matplotlib import rc_context
    from matplotlib.colors import to_rgba
    from matplotlib.figure import Figure as Canvas

    from fegear.output import draw_png
    from fegear.output.draw_png.sheet import Sheet

    views = figure.views
    panels = [(panel, panel.title or view.label * (len(views) > 1)) for view in views for panel in view.panels]
    with rc_context(draw_png.SETTINGS):
        made = Canvas()
        Sheet(made, panels, min(figure.columns if len(views) == 1 else 3, len(panels)), (figure.title, "case")).draw()
        kept = {"size": told([made.get_size_inches(), [len(made.axes)]])}
        kept["head"] = told(
            [[*t.get_position(), t.get_fontsize()] for t in made.texts],
            [(t.get_text(), t.get_color(), t.get_weight(), t.get_ha(), t.get_va()) for t in made.texts],
        )
        for legend in made.legends:
            box = legend.get_bbox_to_anchor().transformed(made.transFigure.inverted())
            kept["legend"] = told(
                [[box.x0, box.y0, legend._ncols, legend.columnspacing, legend.borderaxespad, legend._fontsize]],
                [t.get_text() for t in legend.get_texts()],
            )
        for number, axes in enumerate(made.axes):
            lines = axes.get_lines()
            kept[f"axes {number}"] = told(
                [axes.get_position().bounds, axes.get_xlim(), axes.get_ylim(), axes.yaxis.label.get_position(),
                 [axes.title.get_position()[1], axes.xaxis.get_visible(), axes.yaxis.get_visible()],
                 axes.titleOffsetTrans.get_matrix()[1, 2:],
                 [one.get_visible() for one in axes.spines.values()],
                 [line.get_visible() for line in (*axes.get_xgridlines(), *axes.get_ygridlines())[:1]],
                 to_rgba(axes.get_facecolor())],
                [axes.get_title(loc="left"), axes.get_xlabel(), axes.get_ylabel(), axes.get_xscale(), axes.get_yscale(),
                 axes.get_aspect(), *(t.get_text() for t in axes.get_xticklabels())],
            )  # fmt: skip
            kept[f"lines {number}"] = told(
                [np.concatenate([np.ravel(line.get_xdata()), np.ravel(line.get_ydata()), to_rgba(line.get_color()),
                                 [line.get_linewidth(), line.get_markersize(), line.get_markeredgewidth()]])
                 for line in lines],
                [(line.get_linestyle(), line.get_marker(), line.get_drawstyle()) for line in lines],
            )  # fmt: skip
            kept[f"texts {number}"] = told(
                [[*t.get_position(), *getattr(t, "xy", (0.0, 0.0)), t.get_fontsize(), *to_rgba(t.get_color()),
                  t.get_zorder(), t.get_bbox_patch().get_alpha() or 0.0 if t.get_bbox_patch() else -1.0]
                 for t in axes.texts],
                [(t.get_text(), t.get_ha(), t.get_va(), t.get_weight()) for t in axes.texts],
            )  # fmt: skip
            shapes = [*axes.patches, *axes.collections]
            kept[f"shapes {number}"] = told(
                [np.concatenate([np.ravel(one.get_path().vertices) if hasattr(one, "get_path") else np.empty(0),
                                 *(np.ravel(path.vertices) for path in
                                   (one.get_paths() if hasattr(one, "get_paths") else ())[:40]),
                                 np.ravel(one.get_facecolor())[:8], np.ravel(one.get_linewidth()),
                                 [one.get_zorder(), float(np.max(one.get_alpha() or 1.0))]])
                 for one in shapes],
                [type(one).__name__ for one in shapes],
            )  # fmt: skip
            scaled = [one for one in axes.collections if getattr(one, "get_array", lambda: None)() is not None]
            kept[f"scales {number}"] = told(
                [np.concatenate([np.ravel(np.ma.filled(one.get_array().astype(float), -1.0)), one.get_clim()])
                 for one in scaled],
                [one.get_cmap().name for one in scaled],
            )  # fmt: skip
    return {name: one for name, one in kept.items() if one[0]}


def in_pages(figure):
    """Parts of what plotly draws."""
    from fegear.output.draw_plotly.layout import plotly_json

    def split(thing, numbers, texts, path=""):
        if isinstance(thing, dict) and "bdata" in thing:
            found = np.frombuffer(base64.b64decode(thing["bdata"]), dtype="<f8")
            numbers.append(found)
            texts.append((path, thing.get("shape", "")))
        elif isinstance(thing, dict):
            for key, one in thing.items():
                split(one, numbers, texts, f"{path}.{key}")
        elif isinstance(thing, (list, tuple)):
            for one in thing:
                split(one, numbers, texts, path)
        elif isinstance(thing, (int, float)) and not isinstance(thing, bool):
            numbers.append([float(thing)])
            texts.append(path)
        else:
            texts.append((path, thing))

    spec, kept = plotly_json(figure), {}
    parts = {f"trace {number}": one for number, one in enumerate(spec["data"])}
    parts |= {f"layout {key}": one for key, one in spec["layout"].items()}
    for name, one in parts.items():
        numbers, texts = [], []
        split(one, numbers, texts)
        kept[name] = told(numbers, texts)
    return kept


def drawn():
    """All that is kept, as it is now."""
    from fegear.output.draw_plotly.layout import template

    found = {f"{name} on paper": on_paper(one) for name, one in figures().items()}
    found |= {f"{name} in pages": in_pages(one) for name, one in figures().items() if one.drawable_in_page}
    return found | {"template": {"all": [0, 0.0, zlib.crc32(json.dumps(template(), sort_keys=True).encode())]}}


def differences(old, new):
    """Parts that differ, in words."""
    said = [f"{name}: {part}" for name in old for part in old[name] if part not in new.get(name, {})]
    for name, parts in new.items():
        for part, (count, size, words) in parts.items():
            before = old.get(name, {}).get(part)
            if before is None or before[0] != count or before[2] != words or abs(before[1] - size) > 1e-5 * max(
                1.0, abs(size)
            ):  # fmt: skip
                said.append(f"{name}: {part} {before} -> {[count, size, words]}")
    return said


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    new = drawn()
    if wishes.parse_args().accept:
        figures_ = []
        for name in sorted(new):
            lines = [f"  {json.dumps(part)}: {json.dumps(one)}" for part, one in new[name].items()]
            figures_.append(f" {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n }")
        KEPT.write_text("{\n" + ",\n".join(figures_) + "\n}\n", encoding="utf-8")
    else:
        print(*differences(json.loads(KEPT.read_text("utf-8")), new), sep="\n")


if __name__ == "__main__":
    main()
