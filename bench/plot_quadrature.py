#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_quadrature.py SWEEP.csv FOLDER: the pictures of docs/quadrature.md, from what quadrature_accuracy --sweep wrote.

Needs python3-matplotlib.
"""
import csv
import sys
from collections import defaultdict
from math import floor, log10
from pathlib import Path
from statistics import median

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

FLOOR = 1e-17  # smaller errors are drawn here
LAYERS = (("U", "single layer $U$"), ("T", "double layer $T$"))
TOLERANCES = (1e-4, 1e-8, 1e-12)
RED, BLUE, GREEN = "#b8321f", "#1f5fa8", "#2e7d4f"
GAUSS_SHOWN = (2, 5, 8, 14)
LADDER_SHOWN = (2, 4, 6, 8, 10, 12, 14, 18)
SHIFT, CLOSEST = 0.3, 1.6  # of the error model, lib/operator/rule_ladder.hpp
plt.rcParams.update({
    "font.family": "serif", "mathtext.fontset": "dejavuserif", "font.size": 9, "axes.labelsize": 9,
    "axes.titlesize": 10, "legend.fontsize": 8, "legend.frameon": False, "axes.spines.top": False,
    "axes.spines.right": False, "axes.linewidth": 0.7, "xtick.direction": "in", "ytick.direction": "in",
    "savefig.dpi": 140,
})


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for key, value in row.items():
            if key not in ("shape", "position", "rule") and value != "":
                row[key] = float(value)
    return rows


def degree(row):
    return int(row["rule"][5:])


def is_gauss(row):
    return row["rule"].startswith("gauss")


def panels(ylabel):
    picture, axes = plt.subplots(1, 2, figsize=(9, 3.9), sharey=True)
    for axis, (_, name) in zip(axes, LAYERS):
        axis.set(xscale="log", yscale="log", title=name)
    axes[0].set_ylabel(ylabel)
    return picture, axes


def save(picture, path, handles=()):
    picture.tight_layout()
    if handles:
        picture.legend(handles=handles, loc="upper center", ncol=len(handles), bbox_to_anchor=(0.5, 0.02),
                       columnspacing=1.2, handlelength=1.6)
    picture.savefig(path, bbox_inches="tight")
    plt.close(picture)


def worst_by(rows, key, value):
    worst = defaultdict(float)
    for row in rows:
        worst[row[key]] = max(worst[row[key]], row[value])
    x = sorted(worst)
    return x, [max(FLOOR, worst[k]) for k in x]


def error_against_distance(rows, path):
    """What each rule does by itself, and what the operator makes of them."""
    picture, axes = panels("largest error / largest entry of the block")
    for axis, (layer, _) in zip(axes, LAYERS):
        error = "error_" + layer
        for d in GAUSS_SHOWN:
            x, y = worst_by([r for r in rows if is_gauss(r) and degree(r) == d], "distance", error)
            axis.plot(x, y, color="0.6", lw=0.9)
            level = {2: 1e-5, 5: 2e-9, 8: 1e-12, 14: 2e-14}[d]
            crossing = next((k for k, e in enumerate(y) if x[k] > 1e-3 and e < level), len(x) - 1)
            axis.annotate(f"{d}", (x[crossing], y[crossing]), xytext=(3, 4), textcoords="offset points", color="0.4",
                          fontsize=8)
        x, y = worst_by([r for r in rows if r["rule"] == "closed"], "distance", error)
        axis.plot(x, y, color=GREEN, lw=1.1)
        for tolerance, line in zip(TOLERANCES, (":", "--", "-")):
            x, y = worst_by([r for r in rows if r["rule"] == "auto" and r["tolerance"] == tolerance], "distance", error)
            axis.plot(x, y, color=RED, lw=1.5, ls=line)
            axis.axhline(tolerance, color=RED, lw=0.4)
        axis.set(xlabel="distance / longest edge", xlim=(1e-8, 60), ylim=(FLOOR, 30))
    handles = [Line2D([], [], color="0.6", lw=0.9, label="Gauss rules of degree 2, 5, 8, 14"),
               Line2D([], [], color=GREEN, lw=1.1, label="closed form in double")]
    handles += [Line2D([], [], color=RED, lw=1.5, ls=line, label=f"operator, tolerance $10^{{{e}}}$")
                for e, line in ((-4, ":"), (-8, "--"), (-12, "-"))]
    save(picture, path, handles)


def error_against_cost(rows, path):
    """Distances up to one edge, shapes that meshes have: each rule at each order or tolerance is a point."""
    shapes = ("equilateral", "right", "obtuse")
    picture, axes = panels("largest error / largest entry of the block")
    for axis, (layer, _) in zip(axes, LAYERS):
        for far, fill, low, high in ((False, True, 0, 1), (True, False, 2, 6)):
            near = [r for r in rows if low <= r["distance"] <= high and r["shape"] in shapes]
            groups = defaultdict(list)
            for row in near:
                groups[row["rule"], row["tolerance"]].append(row)
            lines = defaultdict(list)
            for (rule, tolerance), group in groups.items():
                family = "gauss" if rule.startswith("gauss") else rule
                error = max(max(r["error_" + layer] for r in group), FLOOR)
                lines[family].append((median(r["ns_" + layer] for r in group), error))
            for family, points in lines.items():
                color, marker = {"gauss": ("0.5", "o"), "near": (BLUE, "s"), "closed": (GREEN, "D"),
                                 "auto": (RED, "^")}[family]
                points.sort(key=lambda p: -p[1])
                x, y = zip(*points)
                line = "none" if family == "gauss" and fill else "-" if fill else ":"
                axis.plot(x, y, color=color, lw=0.7, ls=line, marker=marker, ms=5, mfc=color if fill else "white", mew=0.9)
        axis.set(xlabel="ns for the three hat functions of a triangle, scalar code", ylim=(1e-16, 30))
    handles = [Line2D([], [], color=c, marker=m, lw=0.7, label=name)
               for c, m, name in (("0.5", "o", "Gauss, degree 2 to 18"), (BLUE, "s", "near-singular rule"),
                                  (GREEN, "D", "closed form"), (RED, "^", "operator"))]
    handles += [Line2D([], [], color="0.3", marker="o", lw=0.7, label="up to 1 edge away"),
                Line2D([], [], color="0.3", marker="o", mfc="white", lw=0.7, ls=":", label="2 to 6 edges")]
    save(picture, path, handles)


def ladder_model(rows, path):
    """The errors that the choice of a Gauss rule rests on, and the model."""
    picture, axes = panels("largest error / largest entry of the block")
    colors = [plt.get_cmap("viridis")(0.88 * k / (len(LADDER_SHOWN) - 1)) for k in range(len(LADDER_SHOWN))]
    handles = {}
    for axis, (layer, _) in zip(axes, LAYERS):
        for d, color in zip(LADDER_SHOWN, colors):
            group = [r for r in rows if is_gauss(r) and degree(r) == d and 1 <= r["radius_ratio"] <= 60]
            for row in group:
                row["bin"] = 10 ** (floor(20 * log10(row["radius_ratio"])) / 20)
            x, y = worst_by(group, "bin", "error_" + layer)
            seen = [(r, e) for r, e in zip(x, y) if e > 3e-15]
            axis.plot(*zip(*seen), ".", color=color, ms=4)
            far = group[-1]
            constant = far["model_" + layer] * (far["radius_ratio"] - SHIFT) ** d
            ratios = [CLOSEST * (60 / CLOSEST) ** (k / 50) for k in range(51)]
            axis.plot(ratios, [constant * (r - SHIFT) ** -d for r in ratios], color=color, lw=1)
            handles[d] = Line2D([], [], color=color, marker=".", lw=1, label=f"degree {d}")
        axis.axvline(CLOSEST, color="0.4", lw=0.7, ls=":")
        axis.set(xlabel="distance from the centroid / radius of the triangle", xlim=(1, 60), ylim=(1e-16, 3))
        axis.set_xticks([1, 2, 5, 10, 20, 50], ["1", "2", "5", "10", "20", "50"])
        axis.minorticks_off()
    save(picture, path, list(handles.values()))


def rounding_model(rows, path):
    """The errors of the closed form in double against what the choice of long double rests on."""
    picture, axes = panels("error of the closed form in double")
    shapes = list(dict.fromkeys(r["shape"] for r in rows))
    names = {"cap200": "cap 1:200", "needle20": "needle 1:20", "needle1000": "needle 1:1000"}
    for axis, (layer, _) in zip(axes, LAYERS):
        for k, shape in enumerate(shapes):
            group = [r for r in rows if r["rule"] == "closed" and r["shape"] == shape and r["distance"] <= 2]
            axis.plot([r["model_" + layer] for r in group], [max(FLOOR, r["error_" + layer]) for r in group], ".",
                      color=plt.get_cmap("plasma")(0.9 * k / (len(shapes) - 1)), ms=2.5, label=names.get(shape, shape))
        axis.plot([1e-15, 1e-7], [1e-15, 1e-7], color="0.3", lw=0.8)
        axis.set(xlabel="rounding model", xlim=(3e-15, 1e-7), ylim=(FLOOR, 1e-7))
    axes[0].legend(markerscale=2.5, loc="upper left")
    save(picture, path)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rows, folder = read(sys.argv[1]), Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    error_against_distance(rows, folder / "quadrature_distance.png")
    error_against_cost(rows, folder / "quadrature_cost.png")
    ladder_model(rows, folder / "quadrature_ladder.png")
    rounding_model(rows, folder / "quadrature_rounding.png")


if __name__ == "__main__":
    main()
