#!/usr/bin/python3
"""Writes report.md, a short summary.md and their plots next to the CSV files that tests/bench/run.sh has made.

    tests/bench/report/report.py FOLDER [--scale quick|full]
"""
import argparse
import collections
import datetime
import math
import pathlib
import platform
import subprocess

import figures
from figures import group_by, mean_over_classes, median, rows_of

OVER_ALL = """Errors and bounds are medians over all scenes. A scene whose class is not named right counts as an infinite error, so
that a class named right in half of the scenes or fewer has no error here ("inf")."""
CLASSES = ("ellipse", "parabola", "hyperbola", "cubical_parabola", "semi_cubical_parabola", "cubic_spline")


def said_by(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "not known"


def machine():
    model = "not known"
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    versions = ", ".join(f"{name} {said_by('dpkg-query', '-W', '-f=${Version}', package)}" for name, package in
                         (("g++", "g++"), ("Eigen", "libeigen3-dev"), ("Ceres", "libceres-dev"),
                          ("ZeroMQ", "libzmq3-dev"), ("protobuf", "libprotobuf-dev")))
    return f"{model}, {said_by('nproc')} cores, Linux {platform.release().split('-')[0]}; {versions}"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value, digits=3):
    if not isinstance(value, float) or not math.isfinite(value):
        return ""
    return f"{value:.{digits}g}"


def best_pipelines(rows):
    """For each pipeline and noise: the window and shift with the least shape error, of those that name most classes right."""
    lines = []
    for noise in sorted({r["noise_over_size"] for r in rows}):
        for pipeline in dict.fromkeys(r["pipeline"] for r in rows):
            cells = group_by([r for r in rows if r["noise_over_size"] == noise and r["pipeline"] == pipeline],
                             "window", "shift")
            right = {key: sum(r["right_class"] for r in cell) / len(cell) for key, cell in cells.items()}
            if not right:
                continue
            key = max(right, key=lambda k: (right[k], -mean_over_classes(cells[k], "us_per_recognition")))
            cell = cells[key]
            wrong = sum(r["wrong"] for r in cell) / len(cell)
            lines.append((f"{noise:g}", pipeline, f"{key[0]:.0f} / {key[1]:.0f}" if key[0] else "",
                          number(mean_over_classes(cell, "us_per_recognition")), f"{100 * right[key]:.0f}",
                          f"{100 * wrong:.0f}", number(mean_over_classes(cell, "kappa_error"), 2),
                          number(mean_over_classes(cell, "kappa_s_error"), 2),
                          number(mean_over_classes(cell, "shape_error", over="shape_bound") if noise > 0
                                 else mean_over_classes(cell, "shape_error"), 2)))
    return table(("noise / size", "pipeline", "window / shift", "us a recognition", "class right [%]",
                  "named another [%]", "kappa error", "kappa_s error", "shape error / bound (of exact data: error)"), lines)


def by_class(rows, noise=1e-3):
    lines = []
    for name in CLASSES:
        row = next(r for r in rows if r["class"] == name and r["pipeline"] == "refined"
                   and r["noise_over_size"] == noise)
        given = next(r for r in rows if r["class"] == name and r["pipeline"] == "refined (class known)"
                     and r["noise_over_size"] == noise)
        lines.append((name.replace("_", " "), number(row["us_per_recognition"]), number(given["us_per_recognition"]),
                      f"{100 * row['right_class']:.0f}", f"{100 * row['wrong']:.1f}", number(row["shape_error"], 2),
                      number(row["shape_bound"], 2), number(row["pose_error"], 2), number(row["pose_bound"], 2)))
    return table(("class", "us, all classes", "us, class known", "class right [%]", "recognised as another [%]",
                  "shape error", "bound", "pose error", "bound"), lines)


def sweep_table(rows):
    lines = []
    for row in rows:
        n = row["scenes"]
        lines.append((row["sweep"], f"{row['value']:g}", row["class"].replace("_", " "),
                      f"{100 * row['right_class'] / n:.0f}", f"{100 * row['limit_class'] / n:.0f}",
                      f"{100 * row['recognized'] / n:.0f}", f"{100 * row['recognized_wrongly'] / n:.0f}",
                      number(row["shape_error_median"], 2), number(row["shape_bound"], 2),
                      number(row["rmse_over_bound"], 3), number(row["condition"], 2), f"{row['us']:.0f}"))
    return table(("sweep", "value", "class", "right [%]", "limit class [%]", "recognised [%]",
                  "recognised wrongly [%]", "shape error", "bound", "RMSE / bound", "condition", "us"), lines)


def latency_table(rows):
    lines = [(r["transport"], r["what"], *(number(r[q]) for q in ("p50_us", "p90_us", "p99_us", "max_us")))
             for r in rows]
    text = table(("transport", "what", "p50 [us]", "p90", "p99", "max"), lines)
    for transport in ("ipc", "tcp"):
        own = {r["what"]: r for r in rows if r["transport"] == transport}
        ours = own["less its computation"]
        ratios = ", ".join(f"{ours['p50_us'] / own[w]['p50_us']:.2f} (p50) and {ours['p99_us'] / own[w]['p99_us']:.2f} "
                           f"(p99) times the {w.split(' (')[0]}" for w in ("bare relay", "relay as busy (less that)"))
        text += f"\n{transport}: less its computation, the node takes {ratios}.\n"
    return text


def load_table(rows):
    return table(("samples / s", "probes", "nodes", "batches sent", "missing", "recognitions", "cores used",
                  "CPU ms / 1000 samples", "memory [MB]"),
                 [(f"{r['sent_samples_per_s']:.0f}", f"{r['probes']:.0f}", f"{r['nodes']:.0f}",
                   f"{r['messages_sent']:.0f}", f"{r['messages_missing']:.0f}", f"{r['recognitions']:.0f}",
                   number(r["cores_used"], 2), number(r["cpu_ms_per_1000_samples"]), number(r["resident_mb"]))
                  for r in rows])


def view_table(rows):
    return table(("what", "measured", "unit", "at most", "holds"),
                 [(r["what"], number(r["value"], 4), r["unit"] if isinstance(r["unit"], str) else "",
                   number(r["at_most"], 4), "" if not isinstance(r["at_most"], float) or math.isnan(r["at_most"])
                   else "yes" if r["value"] <= r["at_most"] else "NO") for r in rows])


def time_table(rows, names):
    return table(("what", "which", "us"),
                 [(r["name"].split("/")[0], r["label"] if isinstance(r["label"], str) else "",
                   number(r["cpu_time"] * {"ns": 1e-3, "us": 1.0, "ms": 1e3}[r["time_unit"]]))
                  for r in rows if str(r["name"]).split("/")[0] in names and r["time_unit"] in ("ns", "us", "ms")])


def section(text, title):
    """A section of a markdown text, without its title."""
    after = text.split(title, 1)[1].split("\n", 1)[1]
    return after.split("\n#", 1)[0].strip()


def speed_table(recognition):
    times = collections.defaultdict(dict)
    for row in recognition:
        what = str(row["name"]).split("/")[0]
        if what in ("cold", "warm", "stream"):
            # Only the timed part counts for a warm answer.
            time = row["real_time" if what == "warm" else "cpu_time"]
            times[row["label"]][what] = time * {"ns": 1e-3, "us": 1.0, "ms": 1e3}[row["time_unit"]]
    return table(("class touched", "cold [us]", "warm [us]", "stream, every ten samples [us]"),
                 [(label.replace("_", " "), *(number(own[w]) for w in ("cold", "warm", "stream")))
                  for label, own in times.items()])


def write_summary(folder, scale, pareto, latency, load, recognition, paper):
    ours = {r["transport"]: r for r in latency if r["what"] == "less its computation"}
    bare = {r["transport"]: r for r in latency if r["what"] == "bare relay"}
    relays = "; ".join(
        f"{t}: {ours[t]['p50_us']:.0f} us at the median and {ours[t]['p99_us']:.0f} at p99, the bare relay "
        f"{bare[t]['p50_us']:.0f} and {bare[t]['p99_us']:.0f}" for t in ours)
    whole = [r["sent_samples_per_s"] for r in load if r["probes"] == 1.0 and r["nodes"] == 1.0
             and r["messages_missing"] == 0]
    text = f"""# palpate in figures

{datetime.date.today().isoformat()}, {scale} run of `tests/bench/run.sh`, which prints all of this and more. Machine: {machine()}.

![Error over time](pareto.svg)

Two patches of 200 samples, noise 1e-3 of the part's half extent, median relative errors. {OVER_ALL}

{by_class(pareto)}
Section 6 of the paper with a simulated sensor. {section(paper, "## Table 4")}

![Hard cases](hard_cases.svg)

![Calibration](calibration.svg)

Two patches of 111 samples, all classes considered, one core:

{speed_table(recognition)}
From publishing a batch to the answer that contains it, less the computation: {relays}. Without a lost message up to
{max(whole, default=0):.0f} samples/s in batches of 50 from one probe.
"""
    (folder / "summary.md").write_text(text)


def write(folder, scale):
    pareto = rows_of(folder / "pareto.csv")
    sweeps = rows_of(folder / "sweeps.csv")
    calibration = rows_of(folder / "calibration.csv")
    latency = rows_of(folder / "latency.csv")
    load = rows_of(folder / "load.csv")
    recognition = rows_of(folder / "recognition.csv")
    local = rows_of(folder / "local.csv")
    view = rows_of(folder / "view.csv")
    figures.pareto(pareto, folder)
    figures.local_errors(pareto, folder)
    figures.sweeps(sweeps, folder)
    figures.calibration(calibration, folder)
    signatures = rows_of(folder / "signatures.csv")
    figures.signatures(signatures, folder)
    figures.semi_signature(signatures, folder)
    figures.conic_figures(signatures, folder)
    figures.processes(latency, load, folder)
    figures.cost(recognition, local, folder)
    peers = folder / "peers.md"
    paper = (folder / "paper.md").read_text().replace("\n## ", "\n### ").replace("# The paper", "### The paper", 1)
    relay = median([r["p50_us"] for r in latency if r["what"] == "bare relay"])
    text = f"""# Speed against error

{datetime.date.today().isoformat()}, {scale} run of `tests/bench/run.sh`. Machine: {machine()}.
Every figure is in the CSV files beside this one; seeds are fixed; times are medians of repetitions.

## Speed against error

Two patches of 200 samples on random shapes of six classes. Each estimator with the recognition tree alone, as in the
paper, over windows and shifts; and the default: all classes refined on all points. The error of a class is its median over all
scenes, where one that is not named right counts as infinite, over the median of the Kanatani-Cramer-Rao bound. Shown is the
geometric mean over the classes whose error is finite, if these are most; otherwise nothing. Finite differences and circles bring no covariance, so that their tree has the paper's plain
tolerance, and names next to nothing beyond exact data.

![Error over time](pareto.svg)

The best window of each (class right most often):

{best_pipelines(pareto)}
**Why the defaults are what they are.** The refinement sits on the bound at every noise and names the class where the
estimators alone cannot: that is why it is the default, and the tree an option. Of the local estimators the jet has the
least bias and brings the joint covariance of angle, kappa and kappa_s; the two-round fit's stiffer parabolas do better
where noise outweighs bias. The tree's contacts are fits of the sliding window, which choose by the data between the two.

By class at noise / size 1e-3. {OVER_ALL}

{by_class(pareto)}
![Local estimators](local_estimators.svg)

The sliding window's rms error of kappa, kappa_s over that of the best jet of one degree and length, both chosen in hindsight for each
cell and for kappa and kappa_s apart; columns: noise over the part's size; 0.00: no such window has an estimate, or it is exact.

{(folder / "hindsight.md").read_text()}

## The paper side by side

Printed values, the paper's method in our hands, and the defaults.

{paper}
The same tables by the whole pipeline, `palpate fit` with its options:

{(folder / "pipeline.md").read_text().replace("## ", "#### ")}
Figures 2 and 3: a cubical parabola, its signature and its semi-signature curve, lambda the slope in its own frame.

![Semi-signature curve](semi_signature.svg)

Figures 4 and 5: parabolas told apart by Ip, ellipses and a circle by Ic1 and Ic2, from one and from two points of each.

![Signature curves of conics](conic_signatures.svg)

Signature curves with estimates on them, at a noise of 1e-4 of the size: circles through three of 87 samples (its figure 9), its
two-round fit, four windows of 75 samples each 4 apart, 87 samples in all (its figure 10), and the sliding window, which chooses
its length itself:

![Signature curves](signatures.svg)

## Peers on the same points

{peers.read_text() if peers.exists() else "Not measured: neither OpenCV nor SciPy is there."}

## Hard cases

One-parameter sweeps towards each degeneracy; noise 1e-3 of the half extent, two patches of 22 mm and 111 samples unless
swept. "Limit class" is the class that the shape turns into, the right answer where the difference drowns in the noise.
RMSE / bound is over all answers of the right class, whether recognised or not: where the bound itself is beyond about
10 % it means little.

![Hard cases](hard_cases.svg)

{sweep_table(sweeps)}
## Real recordings

{(folder / "real.md").read_text()}
## Noise honesty

![Calibration](calibration.svg)

Left: the published probability of the best class, over answers of any status: it is lower than it says where the data leave
much to the prior, which is not that of the scenes. Right: squared errors of recognised answers in units of
the published covariance, which are chi-square where each tenth holds a tenth.

## Processes

{latency_table(latency)}
{load_table(load)}
![Processes](processes.svg)

## The live picture

`palpate view` in headless Chromium, its server under load, and the node beside it (`tests/view/bench_view.py`). "Without" and "with" are
turns of one run on one node.

{view_table(view)}
## Time

{speed_table(recognition)}
![Cost](cost.svg)

{time_table(local, ("per_estimate", "window_fit", "noise_of_a_patch", "spikes_of_a_patch"))}
"""
    (folder / "report.md").write_text(text)
    write_summary(folder, scale, pareto, latency, load, recognition, (folder / "paper.md").read_text())
    print(f"bare relay {relay:.0f} us; {len(pareto) + len(sweeps)} rows")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--scale", default="full", choices=("quick", "full"))
    options = parser.parse_args()
    write(options.folder, options.scale)


if __name__ == "__main__":
    main()
