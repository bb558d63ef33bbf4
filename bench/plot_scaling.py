#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of what bench/scaling and bench/error_against_time wrote with --json (needs Matplotlib).

    plot_scaling.py -o FOLDER SCALING.json...    time and memory against the number of vertices: scaling.png
    plot_scaling.py -o FOLDER ERRORS.json...     error against time: error_against_time.png

Several files of one kind make one picture.
"""
import argparse
import json
import math
import pathlib
from statistics import linear_regression

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
from matplotlib.ticker import FuncFormatter  # noqa: E402

NAME = {"bem": "boundary elements", "fem": "tetrahedral FEM"}
COLOUR = {"bem": "#0072b2", "fem": "#d55e00"}  # distinct for colour-blind readers too
MARKER = {"bem": "o", "fem": "s"}
VARIANT = {"bem": "displacements", "fem": "quality"}
DASHES = ["-", "--", ":", "-."]


def finished(report, **wanted):
    """Runs with a result whose entries are as wanted, by rising number of vertices."""
    runs = [r for r in report["runs"] if "failure" not in r and all(r.get(k) == v for k, v in wanted.items())]
    return sorted(runs, key=lambda r: r["vertices"])


def values(report, key):
    return sorted({r[key] for r in report["runs"] if key in r})


def axes_of(axis, xlabel, ylabel):
    axis.set_xscale("log")
    axis.set_yscale("log")
    for scale in (axis.xaxis, axis.yaxis):
        scale.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    axis.set_xlabel(xlabel)
    axis.set_ylabel(ylabel)
    axis.grid(True, which="major", alpha=0.35)
    axis.spines[["top", "right"]].set_visible(False)


def exponent(runs, value, fewest=5000):
    """Slope over the runs of at least so many vertices, as text."""
    points = [(math.log(r["vertices"]), math.log(value(r))) for r in runs if r["vertices"] >= fewest]
    return f" $N^{{{linear_regression(*zip(*points)).slope:.2f}}}$" if len(points) > 1 else ""


def draw_quantity(axis, report, value):
    """One line a method and number of threads for the limb, hollow marks for the skins that were given."""
    for method in values(report, "method"):
        for dashes, threads in zip(DASHES, values(report, "threads")):
            label = f"{NAME[method]}, {threads} thread{'s' if threads > 1 else ''}"
            style = {"color": COLOUR[method], "marker": MARKER[method]}
            limb = finished(report, method=method, threads=threads, family="limb")
            label += exponent(limb, value)
            axis.plot([r["vertices"] for r in limb], [value(r) for r in limb], ls=dashes, label=label, **style)
            given = finished(report, method=method, threads=threads, family="given")
            axis.plot([r["vertices"] for r in given], [value(r) for r in given], ls="", mfc="none", **style)
    axis.legend(frameon=False, fontsize=8)


def draw_scaling(report, path):
    figure, (time, memory) = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
    axes_of(time, "vertices N", "mesh to response matrix, s")
    axes_of(memory, "vertices N", "peak memory, GB")
    draw_quantity(time, report, lambda r: r["seconds"]["total"])
    draw_quantity(memory, report, lambda r: r["peak_bytes"] / 1e9)
    figure.suptitle(f"six landmarks of radius {report['landmark_radius']:g} mm on a limb (hollow: other meshes of it); {report['processor']}", fontsize=9)
    figure.savefig(path, dpi=130)


def draw_errors_of(axis, report, experiment, poisson):
    """Error against time; the number at a mark is that of the vertices."""
    axes_of(axis, "mesh to displacements, s", "relative error (rms)")
    axis.set_title(f"{experiment}, $\\nu$ = {poisson:g}", fontsize=10)
    for method in values(report, "method"):
        key = VARIANT[method]
        variants = values({"runs": finished(report, method=method)}, key) or [None]
        for dashes, variant in zip(DASHES, variants):
            runs = finished(report, experiment=experiment, poisson=poisson, method=method, **{key: variant})
            if not runs:
                continue
            label = NAME[method] + (f" ({variant})" if len(variants) > 1 else "")
            time, error = [r["seconds"]["total"] for r in runs], [r["rms_error"] for r in runs]
            axis.plot(time, error, ls=dashes, color=COLOUR[method], marker=MARKER[method], label=label)
            for run, x, y in zip(runs, time, error):
                if dashes == "-":
                    axis.annotate(f"{run['vertices']:,}", (x, y), (4, 4), textcoords="offset points", fontsize=7,
                                  color=COLOUR[method])
    axis.legend(frameon=False, fontsize=8)


def draw_errors(report, path):
    experiments, ratios = values(report, "experiment"), values(report, "poisson")
    figure, axes = plt.subplots(len(experiments), len(ratios), figsize=(5.2 * len(ratios), 4 * len(experiments)),
                                layout="constrained", squeeze=False, sharex=True)
    for row, experiment in zip(axes, experiments):
        for axis, poisson in zip(row, ratios):
            draw_errors_of(axis, report, experiment, poisson)
    figure.suptitle(f"numbers: vertices of the skin; {report['processor']}", fontsize=9)
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reports", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("."), help="folder of the pictures")
    arguments = parser.parse_args()
    kinds = {"exponents": (draw_scaling, "scaling.png"), "truths": (draw_errors, "error_against_time.png")}
    reports = [json.loads(path.read_text()) for path in arguments.reports]
    for kind, (draw, name) in kinds.items():
        parts = [report for report in reports if kind in report]
        if parts:
            lists = {key: sum((part[key] for part in parts), []) for key in ("runs", kind)}
            draw(parts[0] | lists, arguments.output / name)


if __name__ == "__main__":
    main()
