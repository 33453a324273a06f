"""Gear trains in motion: Campbell diagram, dynamic increments, spectra, tooth forces, dynamic factor, design chart."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import (
    BLACK,
    BLUE,
    DASHES,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    Picture,
    figure,
    in_house_style,
    legend_above,
    save,
)

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.engine.outcome import Table
    from fegear.results.design_chart import DesignChartData
    from fegear.results.dynamic_factor import DynamicFactorData
    from fegear.results.dynamic_root_stress import DynamicRootStress
    from fegear.results.mesh_force_spectrum import SpectrumData
    from fegear.results.tooth_force import ToothForceData
    from fegear.results.train_response import IncrementsData, ModesData

_COLOURS = (BLUE, ORANGE, GREEN, RED, PURPLE, SKY, BLACK)
_RPM = 30.0 / math.pi
#: Lines weaker than this share of the strongest are not drawn in a spectrum.
_WEAKEST = 1e-5


@in_house_style
def draw_campbell(data: ModesData, path: Path) -> Picture:
    """Draw natural frequencies and mesh harmonics over speed."""
    diagram = data.campbell
    if diagram is None:
        raise ValueError("a Campbell diagram needs speeds")
    made, axes = figure()
    speed = diagram.speeds * data.train.speed_ratio * _RPM
    top, labelled = 1.25 * float(diagram.natural.max()), -math.inf
    for m, name in enumerate(data.train.names):
        for h in range(diagram.lines.shape[1]):
            label = f"mesh {name}, harmonics 1 to {diagram.lines.shape[1]}" if h == 0 else None
            axes.plot(
                speed, diagram.lines[m, h] * 1e-3, DASHES[m % len(DASHES)], color=_COLOURS[m % 7], label=label, lw=1.4
            )
    for k, natural in enumerate(diagram.natural):
        axes.axhline(natural * 1e-3, color="0.4", lw=1.0)
        if natural - labelled < 0.04 * top:
            continue
        labelled = float(natural)
        axes.annotate(
            f"mode {k + 1}: {natural:.0f} Hz", (1.0, natural * 1e-3), xycoords=("axes fraction", "data"),
            xytext=(-2, 2), textcoords="offset points", ha="right", fontsize=8, color="0.3",
        )  # fmt: skip
    axes.set_ylim(0.0, top * 1e-3)
    axes.set_xlim(float(speed.min()), float(speed.max()))
    axes.set_xlabel(f"speed of {data.train.speed_of} [rpm]")
    axes.set_ylabel("frequency [kHz]")
    made.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=9)
    caption = "Where harmonics of the mesh frequencies (sloping) meet undamped natural frequencies (level)."
    return save(made, path, "Campbell diagram", caption)


@in_house_style
def draw_increments(data: IncrementsData, path: Path) -> Picture:
    """Draw |Q_ij| over frequency, one panel for each mesh that is excited by its own and the others' error."""
    count = len(data.train.names)
    made, panels = figure(count, 1, size=(7.2, 1.4 + 2.5 * count), sharex=True, squeeze=False)
    for i, first in enumerate(data.train.names):
        axes = panels[i][0]
        for j, second in enumerate(data.train.names):
            axes.loglog(
                data.frequencies, np.abs(data.increments[i, j]), DASHES[j % len(DASHES)], color=_COLOURS[j % 7],
                label=f"error of mesh {second}",
            )  # fmt: skip
        axes.set_ylabel(f"$|Q|$ of mesh {first}")
        axes.legend(fontsize=9)
    panels[-1][0].set_xlabel("frequency [Hz]")
    caption = (
        "Dynamic increment functions: how much the force of one mesh, over its stiffness, differs from the "
        "quasi-static one for a static transmission error of its own or of another mesh."
    )
    return save(made, path, "Dynamic increment functions", caption)


@in_house_style
def draw_spectrum(data: SpectrumData, path: Path) -> Picture:
    """Draw the line spectrum of the force in one mesh."""
    made, axes = figure()
    found, names = data.spectrum, data.train.names
    largest = float(found.amplitudes[data.mesh].max())
    floor = max(_WEAKEST * largest, 1e-12)
    for j, other in enumerate(names):
        size = found.amplitudes[data.mesh, j, :, 0]
        shown = size > floor
        frequency = found.frequencies[j, :, 0][shown] * 1e-3
        colour = _COLOURS[j % 7]
        axes.vlines(frequency, floor, size[shown], color=colour, lw=1.0)
        axes.plot(frequency, size[shown], "os^D"[j % 4], color=colour, ms=4, label=f"from mesh {other}")
    axes.set_yscale("log")
    axes.set_ylim(bottom=floor)
    axes.set_xlabel("frequency [kHz]")
    axes.set_ylabel("mesh force, 0-peak [N]")
    axes.legend(fontsize=9)
    name = names[data.mesh]
    rpm = float(found.speeds[0]) * data.train.speed_ratio * _RPM
    caption = f"Mesh {name} at {rpm:.6g} rpm of {data.train.speed_of}: harmonics by the mesh that excites them."
    return save(made, path, f"Spectrum of the force in mesh {name}", caption)


@in_house_style
def draw_waterfall(data: SpectrumData, path: Path) -> Picture:
    """Draw the lines of the mesh force over speed and frequency."""
    found, name = data.waterfall, data.train.names[data.mesh]
    if found is None:
        raise ValueError("a waterfall needs speeds")
    made, axes = figure(size=(7.2, 4.6))
    size = found.amplitudes[data.mesh]
    largest = float(size.max())
    speed = np.broadcast_to(found.speeds * data.train.speed_ratio * _RPM, size.shape)
    strong = size > 1e-2 * largest
    level = np.log10(size[strong] / largest)
    order = np.argsort(level)
    drawn = axes.scatter(
        found.frequencies[strong][order] * 1e-3, speed[strong][order], c=size[strong][order],
        s=4.0 + 40.0 * (1.0 + level[order] / 2.0) ** 3, cmap="viridis", norm="log", linewidths=0.0,
    )  # fmt: skip
    made.colorbar(drawn, ax=axes, label="mesh force, 0-peak [N]")
    axes.set_xlabel("frequency [kHz]")
    axes.set_ylabel(f"speed of {data.train.speed_of} [rpm]")
    caption = f"Mesh {name}: lines of the mesh force over speed, down to a hundredth of the strongest."
    return save(made, path, f"Waterfall of the force in mesh {name}", caption)


@in_house_style
def draw_tooth_force(data: ToothForceData, path: Path) -> Picture:
    """Draw the force on one tooth pair and its parts over the line of action."""
    force, name = data.force, data.train.names[data.mesh]
    others = force.cross.sum(axis=0)
    several = len(data.train.names) > 1
    made, (top, bottom) = figure(2, 1, size=(7.2, 5.6), sharex=True, height_ratios=(3, 2))
    x = force.x * 1e3
    top.plot(x, force.static, "--", color="0.45", label="static")
    top.plot(x, force.total, color=BLUE, label="static and own increment")
    if several:
        top.plot(x, force.total + others, ":", color=RED, label="with the other meshes")
    top.axhline(float(data.train.forces[data.mesh]), color=BLACK, lw=0.8)
    top.set_ylim(bottom=min(0.0, 1.05 * float((force.total + others).min())))
    top.set_ylabel("tooth force [N]")
    legend_above(top, 3 if several else 2)
    bottom.plot(x, force.own, color=BLUE, label=f"from mesh {name}")
    for j, other in enumerate(data.train.names):
        if j != data.mesh:
            bottom.plot(x, force.cross[j], DASHES[(j + 1) % 4], color=_COLOURS[(j + 1) % 7], label=f"from mesh {other}")
    bottom.set_ylabel("increment [N]")
    bottom.set_xlabel("place of the tooth pair on the line of action [mm]")
    bottom.legend(fontsize=9)
    caption = (
        f"Mesh {name}: force on one tooth pair from first to last contact; the level line is the mean mesh force. "
        "Below: what the vibration adds, by the mesh that excites it."
    )
    return save(made, path, f"Force on one tooth pair of mesh {name}", caption)


@in_house_style
def draw_root_stress(data: DynamicRootStress, path: Path) -> Picture:
    """Draw the root stress of one tooth of either gear."""
    name = data.force.train.names[data.force.mesh]
    made, axes = figure()
    x = data.force.force.x * 1e3
    for (member, stress), colour in zip(data.stress.items(), (BLUE, RED), strict=True):
        axes.plot(x, stress.total * 1e-6, color=colour, label=f"{member}, dynamic")
        axes.plot(x, stress.static * 1e-6, "--", color=colour, lw=1.2, label=f"{member}, quasi-static")
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    axes.set_xlabel("place of the tooth pair on the line of action [mm]")
    axes.set_ylabel("largest root tension [MPa]")
    axes.legend(fontsize=9)
    caption = (
        f"Mesh {name}: root stress of one tooth of either gear through its engagement, with and without vibration."
    )
    return save(made, path, f"Dynamic root stress of mesh {name}", caption)


@in_house_style
def draw_dynamic_factor(data: DynamicFactorData, path: Path, name: str) -> Picture:
    """Draw the dynamic factor over speed, and the share of the time without contact where there is any."""
    chart, speed = data.chart, data.chart.speeds * _RPM
    lost = bool(chart.apart.any() or chart.behind.any())
    made, panels = figure(
        1 + lost, 1, size=(7.2, 5.2 if lost else 4.0), sharex=True, squeeze=False,
        height_ratios=(3, 1) if lost else (1,),
    )  # fmt: skip
    top = panels[0][0]
    top.plot(speed, chart.dynamic_factor, color=BLUE, label="tooth force")
    top.plot(speed, chart.mesh_force_factor, "--", color=GREEN, lw=1.2, label="mesh force")
    odd = chart.periods == 0
    if odd.any():
        top.plot(speed[odd], chart.dynamic_factor[odd], "o", mfc="none", color=RED, label="motion that does not repeat")
    lowest = float(min(np.nanmin(chart.mesh_force_factor), np.nanmin(chart.dynamic_factor)))
    top.set_ylim(bottom=min(1.0, 0.97 * lowest))
    top.set_ylabel("largest over mean force")
    top.legend(fontsize=9)
    if lost:
        axes = panels[1][0]
        axes.plot(speed, 100.0 * chart.apart, color=ORANGE, label="no contact")
        if chart.behind.any():
            axes.plot(speed, 100.0 * chart.behind, "--", color=PURPLE, label="on the back flanks")
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel("time [%]")
        axes.legend(fontsize=9)
    panels[-1][0].set_xlabel(f"speed of {data.speed_of} [rpm]")
    worst, where = chart.worst
    caption = (
        f"Mesh {name}: largest force on one tooth pair (dynamic factor) and largest mesh force, both over the mean "
        f"mesh force. Largest dynamic factor {worst:.4g} at {where * _RPM:.6g} rpm."
    )
    return save(made, path, f"Dynamic factor of mesh {name}", caption)


@in_house_style
def draw_design_chart(data: DesignChartData, path: Path) -> Picture:
    """Draw the largest dynamic factor over the length of relief for every amount, and A_e beside it."""
    made, (left, right) = figure(1, 2, size=(9.6, 4.6), sharex=True)
    curves = (f"${amount:.4g}\\,\\Delta$" for amount in data.amounts)
    for k, label in enumerate(curves):
        style = {"color": _COLOURS[k % 7], "marker": "os^Dv<>"[k % 7], "ms": 3.5, "lw": 1.5}
        left.plot(data.lengths, data.dynamic_factor[k], DASHES[k // 7 % 4], label=label, **style)
        right.plot(data.lengths, data.effective_error[k] * 1e6, DASHES[k // 7 % 4], **style)
    left.axhline(data.unmodified, color=BLACK, lw=1.0, label="unmodified")
    left.set_ylabel("largest dynamic factor")
    right.set_ylabel("effective error $A_e$ [µm]")
    right.set_ylim(bottom=0.0)
    for axes in (left, right):
        axes.set_xlabel("length of relief $L_n$")
    made.legend(
        *left.get_legend_handles_labels(), loc="outside lower center", ncols=min(7, data.amounts.size + 1), fontsize=9
    )
    caption = (
        "Left: largest dynamic factor over the speeds against the length of tip relief (1 from the tip to the highest "
        f"point of single contact), by amount over $\\Delta$ = {data.delta * 1e6:.4g} µm. Right: effective error."
    )
    return save(made, path, "Design chart of tip relief", caption)


@in_house_style
def draw_modes(table: Table, path: Path) -> Picture:
    """Draw which share of its strain energy each mode has in each mesh."""
    frequency = np.asarray(table["frequency"], dtype=float)[1:]
    energies = [column for column in table.columns if column.name.startswith("energy_")]
    made, axes = figure(size=(7.2, 3.6))
    place, below = np.arange(frequency.size), np.zeros(frequency.size)
    for m, column in enumerate(energies):
        share = np.asarray(column.values, dtype=float)[1:]
        axes.bar(place, share, 0.6, below, color=_COLOURS[m % 7], label=f"mesh {column.name.removeprefix('energy_')}")
        below = below + share
    if (1.0 - below).max() > 1e-6:
        axes.bar(place, 1.0 - below, 0.6, below, color="0.8", label="shafts")
    axes.set_xticks(place, [f"{k + 1}\n{f:.5g} Hz" for k, f in enumerate(frequency)])
    axes.set_ylim(0.0, 1.0)
    axes.set_xlabel("mode and its natural frequency")
    axes.set_ylabel("share of strain energy")
    made.legend(*axes.get_legend_handles_labels(), loc="outside right upper", fontsize=9)
    return save(made, path, "Natural modes", "Where each mode of the train deforms: in its meshes or in its shafts.")
