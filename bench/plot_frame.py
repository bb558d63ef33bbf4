#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_frame.py FOLDER FRAME.json [COMPRESSION.json ...]: pictures of what bench/frame and bench/compression measured.

Writes FOLDER/frame_speed.png, and FOLDER/frame_singular_values.png where there are results of bench/compression; prints
the tables of docs/frame.md. Needs Debian's python3-matplotlib.
"""
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STORAGE = {
    "float64": ("#7f7f7f", "float64 (files)"),
    "float32": ("#1f77b4", "float32"),
    "int16": ("#d62728", "int16"),
    "compressed": ("#2ca02c", "compressed"),
}


def plot_times(rows, file):
    """Speed of a frame over vertices, a panel for each number of landmarks, one thread."""
    rows = [row for row in rows if row["threads"] == 1]
    counts = [n for n in (6, 40, 100, 300) if sum(row["landmarks"] == n for row in rows) > 3]
    figure, axes = plt.subplots(1, len(counts), figsize=(3.6 * len(counts), 4), sharey=True, squeeze=False)

    def speed(row, key="p50_us", share=1.0):
        """What R in single precision, rest, output and its fetch would be, in GB/s: the same measure for all."""
        return 12e-3 * row["vertices"] * (3 * row["landmarks"] + 3) / (row[key] * share)

    for axis, count in zip(axes[0], counts):
        here = [row for row in rows if row["landmarks"] == count]
        for storage, (colour, label) in STORAGE.items():
            line = [(row["vertices"], speed(row)) for row in here if row["storage"] == storage]
            if line:
                axis.plot(*zip(*line), "o-", color=colour, label=label, linewidth=1.8, markersize=4)
        single = [row for row in here if row["storage"] == "float32"]
        vertices = [row["vertices"] for row in single]
        axis.plot(vertices, [speed(row, "openblas_us") for row in single], "k--", linewidth=1, label="OpenBLAS sgemv")
        axis.plot(vertices, [speed(row, "eigen_us") for row in single], "k:", linewidth=1, label="Eigen gemv")
        axis.plot(vertices, [speed(row, share=row["bandwidth_fraction"]) for row in single], color="0.75", linewidth=6,
                  label="reading the bytes of float32", zorder=0)
        axis.set(xscale="log", xlabel="vertices", title=f"{count} landmarks")
        axis.set_xticks(vertices, [f"{v // 1000}k" if v >= 1000 else str(v) for v in vertices])
        axis.minorticks_off()
        axis.grid(True, which="major", alpha=0.3)
    axes[0][0].set_ylim(bottom=0)
    axes[0][0].set_ylabel("bytes of the frame in float32 / its time, GB/s")
    handles = {label: handle for axis in axes[0] for handle, label in zip(*axis.get_legend_handles_labels())}
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=len(handles), frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.07, 1, 1))
    figure.savefig(file, dpi=110)


def print_tables(rows):
    """Microseconds and ratios as Markdown, for one thread and for two."""
    case = {(row["threads"], row["vertices"], row["landmarks"], row["storage"]): row for row in rows}

    def number(value):
        return f"{value:.0f}" if value >= 100 else f"{value:#.3g}"

    def spread(row):
        return f"{row['p99_us'] / row['p50_us']:.2f} ({row['read_p99_us'] / row['read_us']:.2f})"

    for threads in (1, 2):
        print("| vertices | landmarks | float32 | int16 | compressed | Eigen | OpenBLAS | float32: read "
              "| float32 / best of the two | int16 gains | float32: p99 / p50 (read's) |")
        print("|---:|" + "---:|" * 10)
        for (t, vertices, landmarks, storage), row in case.items():
            if t != threads or storage != "float32":
                continue
            other = [case.get((t, vertices, landmarks, name)) for name in ("int16", "compressed")]
            times = [row["p50_us"]] + [o and o["p50_us"] for o in other] + [row["eigen_us"], row["openblas_us"]]
            cells = [f"{vertices:,}", str(landmarks)] + [number(time) if time else "" for time in times]
            cells += [f"{row['bandwidth_fraction']:.2f}", f"{row['p50_us'] / min(times[3:]):.2f}"]
            cells += [f"{other[0]['float32_us'] / other[0]['p50_us']:.2f}" if other[0] else "", spread(row)]
            print("| " + " | ".join(cells) + " |")
        print()


def plot_singular_values(results, file):
    """Singular values of R, and what the three forms of it take."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    for result in results:
        left.plot(range(1, len(result["singular_values"]) + 1), result["singular_values"], linewidth=1.8,
                  label=f"{result['vertices']:,} vertices")
    left.axhline(1e-4, color="k", linestyle="--", linewidth=1)
    left.text(5, 1.2e-4, "1e-3 mm at 10 mm of motion", fontsize=9)
    left.set(yscale="log", ylim=(3e-5, 40), xlabel="number", ylabel="singular value of R",
             title=f"{results[0]['landmarks']} landmarks: no value can be left out")
    left.grid(True, alpha=0.3)
    left.legend(frameon=False, loc="center right")
    width = 0.28
    for s, storage in enumerate(("float32", "int16", "compressed")):
        heights = [result["p50_us"][0] / result["p50_us"][s] for result in results]
        bars = right.bar([i + (s - 1) * width for i in range(len(results))], heights, width, color=STORAGE[storage][0],
                         label=storage)
        for bar, result in zip(bars, results):
            right.annotate(f"{result['megabytes'][s]:.1f} MB", (bar.get_x() + width / 2, bar.get_height()),
                           ha="center", va="bottom", fontsize=7.5)
    right.set_xticks(range(len(results)), [f"{result['vertices']:,}" for result in results])
    right.set(xlabel="vertices", ylabel="times as fast as float32", title="error at most 1e-3 mm")
    right.legend(frameon=False, loc="upper left")
    figure.tight_layout()
    figure.savefig(file, dpi=110)


def main():
    folder, times, *compression = sys.argv[1:]
    rows = json.loads(Path(times).read_text())
    plot_times(rows, Path(folder) / "frame_speed.png")
    print_tables(rows)
    if compression:
        results = sorted((json.loads(Path(name).read_text()) for name in compression), key=lambda r: r["vertices"])
        plot_singular_values(results, Path(folder) / "frame_singular_values.png")


if __name__ == "__main__":
    main()
