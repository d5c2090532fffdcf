"""Reads the rows of the benchmarks' CSV files and makes plots of them."""
import collections
import csv
import math

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "palpate"  # the same data give the same file
matplotlib.rcParams["svg.fonttype"] = "none"  # text stays text
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402

COLOURS = {"finite-difference": "tab:red", "circle": "tab:orange", "two-round": "tab:purple", "jet": "tab:blue",
           "sliding window": "tab:blue", "tree on default contacts": "tab:brown", "refined": "tab:green", "refined (class known)": "tab:olive"}


def rows_of(path):
    """A list of dictionaries, with numbers converted. Skips the lines of Google Benchmark before the header."""
    with open(path, newline="") as file:
        lines = file.readlines()
    start = next((i for i, line in enumerate(lines) if line.startswith("name,")), 0)
    rows = []
    for row in csv.DictReader(lines[start:]):
        for key, value in row.items():
            try:
                row[key] = float(value)
            except (TypeError, ValueError):
                pass
        rows.append(row)
    return rows


def group_by(rows, *keys):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[tuple(row[key] for key in keys)].append(row)
    return groups


def median(values):
    values = sorted(v for v in values if isinstance(v, float) and math.isfinite(v))
    return values[len(values) // 2] if values else math.nan


def save(figure, folder, name):
    if figure.get_layout_engine() is None:
        figure.tight_layout()
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    figure.savefig(folder / f"{name}.png", dpi=110)
    plt.close(figure)


def mean_over_classes(rows, column, over=None):
    """Geometric mean over the classes that have a finite value, of `column` or of its ratio to column `over`; NaN unless
    most have one."""
    values = [row[column] / (row[over] if over else 1.0) for row in rows
              if isinstance(row[column], float) and 0.0 < row[column] < math.inf]
    if 2 * len(values) <= len(rows):
        return math.nan
    return math.exp(sum(map(math.log, values)) / len(values))


def pareto(rows, folder):
    """Error of the shape over the bound against time, one panel for each noise. Of exact data the bound is 0: that panel
    has the error itself."""
    noises = sorted({row["noise_over_size"] for row in rows})
    figure, axes = plt.subplots(2, 3, figsize=(12, 7.5), sharex=True)
    for axis, noise in zip(axes.flat, noises):
        here = [row for row in rows if row["noise_over_size"] == noise]
        for (pipeline,), group in group_by(here, "pipeline").items():
            points = []
            for _, cell in group_by(group, "window", "shift").items():
                error = mean_over_classes(cell, "shape_error", over="shape_bound" if noise > 0 else None)
                if math.isfinite(error):
                    points.append((mean_over_classes(cell, "us_per_recognition"), max(error, 1e-15)))
            if points:
                refined = pipeline.startswith("refined")
                axis.plot(*zip(*points), "*" if refined else "o", color=COLOURS[pipeline], label=pipeline,
                          markersize=13 if refined else 5, alpha=0.85)
        if noise > 0:
            axis.axhline(1.0, color="black", linestyle="--", linewidth=1, label="Kanatani-Cramer-Rao bound")
        axis.set(xscale="log", yscale="log", title=f"noise / size {noise:g}" if noise > 0 else "exact data: error itself")
        axis.set_xticks([200, 500, 1000, 2000, 5000], ["200", "500", "1000", "2000", "5000"])
        axis.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
        axis.grid(alpha=0.3, which="both")
    for axis in axes[1]:
        axis.set_xlabel("time of a recognition [us]")
    for axis in axes[:, 0]:
        axis.set_ylabel("median error of the shape over the bound")
    handles = {}
    for axis in axes.flat:
        handles.update(dict(zip(*reversed(axis.get_legend_handles_labels()))))
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=len(handles), fontsize=9)
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    figure.savefig(folder / "pareto.svg", metadata={"Date": None})
    figure.savefig(folder / "pareto.png", dpi=110)
    plt.close(figure)


def local_errors(rows, folder):
    """Error of kappa and of kappa_s over the number of samples of an estimate, one line per estimator, at two noise levels."""
    shift = 4.0
    further = {"two-round": 9 * shift}  # its ten windows begin a shift apart
    figure, axes = plt.subplots(2, 2, figsize=(10, 7), sharex=True)
    for column, noise in enumerate((1e-5, 1e-3)):
        for line, quantity in enumerate(("kappa", "kappa_s")):
            axis = axes[line][column]
            here = [r for r in rows if r["noise_over_size"] == noise and r["shift"] == shift]
            for (pipeline,), group in group_by(here, "pipeline").items():
                windows = sorted({row["window"] for row in group})
                errors = [mean_over_classes([r for r in group if r["window"] == w], f"{quantity}_error")
                          for w in windows]
                axis.plot([w + further.get(pipeline, 0) for w in windows], errors, "o-", color=COLOURS[pipeline],
                          label=pipeline)
            axis.set(yscale="log", title=f"{quantity}, noise / size {noise:g}", xlabel="samples of an estimate",
                     ylabel="relative error, median")
            axis.grid(alpha=0.3, which="both")
    axes[0][0].legend(fontsize=8)
    save(figure, folder, "local_estimators")


def sweeps(rows, folder):
    """Error compared with the bound, and the kinds of answers, towards each degeneracy."""
    groups = group_by(rows, "sweep")
    columns = 5
    lines = math.ceil(len(groups) / columns)
    figure = plt.figure(figsize=(18, 4.2 * lines), layout="constrained")
    cells = figure.subfigures(lines, columns, squeeze=False).flat
    for number, (cell, ((name,), group)) in enumerate(zip(cells, groups.items())):
        above, below = cell.subplots(2, 1, height_ratios=[2, 1], sharex=True)
        places = range(len(group))
        above.semilogy(places, [r["shape_error_median"] for r in group], "o-", label="error, median")
        above.semilogy(places, [r["shape_bound"] for r in group], "k--", label="bound (1 sd)")
        above.set_title(name, fontsize=10)
        above.grid(alpha=0.3)
        n = [r["scenes"] for r in group]
        for column, colour in (("right_class", "tab:blue"), ("limit_class", "tab:gray"), ("recognized", "tab:green"),
                               ("recognized_wrongly", "tab:red")):
            below.plot(places, [r[column] / m for r, m in zip(group, n)], ".-", color=colour,
                       label=column.replace("_", " "))
        below.set_ylim(-0.05, 1.05)
        below.set_xticks(list(places), [f"{r['value']:.3g}" for r in group], rotation=70, fontsize=7)
        below.grid(alpha=0.3)
        if number == 0:
            above.legend(fontsize=7)
            below.legend(fontsize=6)
    save(figure, folder, "hard_cases")


def calibration(rows, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.5))
    left.plot([0, 1], [0, 1], "k--", linewidth=1)
    for stated, label in ((1.0, "noise stated"), (0.0, "noise unknown")):
        own = [r for r in rows if r["kind"] == "probability" and r["noise_stated"] == stated and r["count"] >= 10]
        left.plot([r["expected"] for r in own], [r["observed"] for r in own], "o-", label=label)
        own = [r for r in rows if r["kind"] == "squared_error" and r["noise_stated"] == stated]
        right.plot([r["upper"] - 0.05 for r in own], [r["observed"] for r in own], "o-", label=label)
    left.set(xlabel="published probability of the best class", ylabel="how often it is the class", xlim=(0.3, 1.02),
             ylim=(0, 1.05))
    right.axhline(0.1, color="black", linestyle="--", linewidth=1)
    right.set(xlabel="chi-square quantile of the squared error", ylabel="share of answers", ylim=(0, 0.2), xlim=(0, 1))
    for axis in (left, right):
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8)
    save(figure, folder, "calibration")


def signatures(rows, folder):
    """Like figure 10: estimates and the signature curve, one panel per class."""
    figure, axes = plt.subplots(2, 3, figsize=(12, 7))
    own_rows = [r for r in rows if r["figure"] == 10.0]
    for axis, ((name,), group) in zip(axes.flat, group_by(own_rows, "label").items()):
        kinds = group_by(group, "kind")
        curve = kinds[("curve",)]
        kappas = [r["kappa"] for r in curve]
        slopes = [r["kappa_s"] for r in curve]
        for kind, marker in (("circle", "x"), ("two-round", "+"), ("sliding window", "o")):
            own = kinds.get((kind,), [])
            axis.plot([r["kappa"] for r in own], [r["kappa_s"] for r in own], marker, color=COLOURS[kind], label=kind,
                      markersize=4)
        axis.plot(kappas, slopes, "k-", linewidth=1, label="signature curve")
        wide = 0.25 * (max(slopes) - min(slopes)) or 1.0
        deep = 0.15 * (max(kappas) - min(kappas)) or 1.0
        axis.set(title=name.replace("_", " "), xlabel="kappa", ylabel="kappa_s",
                 ylim=(min(slopes) - wide, max(slopes) + wide), xlim=(min(kappas) - deep, max(kappas) + deep))
        axis.grid(alpha=0.3)
    axes.flat[0].legend(fontsize=8)
    save(figure, folder, "signatures")


def semi_signature(rows, folder):
    """Figures 2 and 3: a cubical parabola, its signature and its semi-signature curve."""
    own = [r for r in rows if r["figure"] == 3.0]
    figure = plt.figure(figsize=(13, 4.2))
    for place, (x, y) in enumerate((("x", "y"), ("kappa", "kappa_s")), start=1):
        axis = figure.add_subplot(1, 3, place)
        axis.plot([r[x] for r in own], [r[y] for r in own], "k-", linewidth=1.2)
        axis.set(xlabel=x, ylabel=y, title=own[0]["label"] if place == 1 else "signature curve")
        axis.grid(alpha=0.3)
    axis = figure.add_subplot(1, 3, 3, projection="3d")
    axis.plot([r["lambda"] for r in own], [r["kappa"] for r in own], [r["kappa_s"] for r in own], "k-", linewidth=1.2)
    axis.set(xlabel="lambda", ylabel="kappa", title="semi-signature curve")
    axis.set_zlabel("kappa_s")
    axis.set_box_aspect(None, zoom=0.85)  # the labels are part of the picture
    save(figure, folder, "semi_signature")


def conic_figures(rows, folder):
    """Figures 4 and 5: curves, their signature curves, and the values of the invariants."""
    figure, axes = plt.subplots(2, 2, figsize=(11, 8))
    for line, number in enumerate((4.0, 5.0)):
        own = [r for r in rows if r["figure"] == number]
        for place, ((label,), group) in enumerate(group_by(own, "label").items()):
            axes[line][0].plot([r["x"] for r in group], [r["y"] for r in group], color=f"C{place}",
                               label=label.replace(";", ","))
            marker = "o" if group[0]["kappa"] == group[-1]["kappa"] == group[len(group) // 3]["kappa"] else ""
            axes[line][1].plot([r["kappa"] for r in group], [r["kappa_s"] for r in group], marker=marker, linestyle="-",
                               color=f"C{place}")
        axes[line][0].set(xlabel="x", ylabel="y", aspect="equal", title="parabolas" if number == 4.0 else "ellipses")
        axes[line][0].legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.15))
        axes[line][1].set(xlabel="kappa", ylabel="kappa_s", title="signature curves")
        for axis in axes[line]:
            axis.grid(alpha=0.3)
    save(figure, folder, "conic_signatures")


def processes(latency, load, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2))
    quantiles = ("p50_us", "p90_us", "p99_us")
    whats = [w for w in dict.fromkeys(r["what"] for r in latency) if w != "publish to recognition"]
    for number, (transport, what) in enumerate((t, w) for t in ("ipc", "tcp") for w in whats):
        row = next(r for r in latency if r["transport"] == transport and r["what"] == what)
        left.plot(range(3), [row[q] for q in quantiles], "o", label=f"{transport}: {what}",
                  linestyle="-" if transport == "ipc" else "--", color=f"C{number % len(whats)}")
    left.set_xticks(range(3), ["p50", "p90", "p99"])
    left.set(ylabel="us", yscale="log", title="Publish to answer, less the computation")
    left.legend(fontsize=8)
    one = [r for r in load if r["probes"] == 1.0 and r["nodes"] == 1.0]
    right.loglog([r["sent_samples_per_s"] for r in one], [r["cpu_ms_per_1000_samples"] for r in one], "o-",
                 label="CPU per 1000 samples [ms]")
    right.loglog([r["sent_samples_per_s"] for r in one], [r["recognitions"] / r["messages_sent"] for r in one], "s-",
                 label="answers per batch of 50")
    right.set(xlabel="samples / s of one probe", title="Load makes answers rarer, not later")
    right.legend(fontsize=8)
    for axis in (left, right):
        axis.grid(alpha=0.3, which="both")
    save(figure, folder, "processes")


def cost(recognition, local, folder):
    """Time of a recognition over the number of samples; time of the local estimators per sample of a stream over the window."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2))
    rows = [r for r in recognition if str(r["name"]).startswith("cold_by_samples/")]
    rows = [r for r in rows if str(r["name"]).split("/")[1].isdigit()]
    samples = [int(r["name"].split("/")[1]) for r in rows]
    times = [r["cpu_time"] for r in rows]
    left.loglog(samples, times, "o-", label="cold recognition, all classes")
    left.loglog(samples, [times[-1] * n / samples[-1] for n in samples], "k--", linewidth=1, label="linear")
    left.set(xlabel="samples", ylabel="us")
    streams = [r for r in local if str(r["name"]).startswith("fixed_window_per_sample/")]
    for (pipeline,), group in group_by(streams, "label").items():
        windows = [int(r["name"].split("/")[2]) for r in group]
        right.semilogy(windows, [r["cpu_time"] / 1e3 for r in group], "o-", color=COLOURS[pipeline], label=pipeline)
    sliding = [r for r in local if str(r["name"]).startswith("sliding_window_per_sample/")]
    right.semilogy([int(r["label"].split()[0]) for r in sliding], [r["cpu_time"] / 1e3 for r in sliding], "s--",
                   color="black", label="sliding window")
    right.set(xlabel="window [samples]", ylabel="us per sample, an estimate every fourth")
    for axis in (left, right):
        axis.grid(alpha=0.3, which="both")
        axis.legend(fontsize=8)
    save(figure, folder, "cost")
