#!/usr/bin/python3
"""Fits OpenCV's ellipses to the arcs of bench_real. Prints markdown.

    build/strict/tests/bench/real/bench_real --ellipse-part FILE --semi-axes A,B --tip-radius R --arcs ARCS.csv
    tests/bench/real/opencv_arcs.py ARCS.csv --semi-axes A,B --tip-radius R

OpenCV does not know a tip: it fits the tip's centres, and R is subtracted from both axes, which is exact at the vertices
only (the offset curve of an ellipse is not an ellipse). Each arc is given relative to its mean, in units of its spread,
because OpenCV works in float32. If fitEllipseAMS and fitEllipseDirect fail, they return fitEllipse's answer without a
notice. Such arcs, recognised by equal answers, are counted, and the second median leaves them out. Needs the Debian
packages python3-numpy and python3-opencv.
"""
import argparse
import collections
import csv
import math
import statistics
import sys

import numpy as np

try:
    import cv2
except ImportError:
    sys.exit("opencv_arcs.py: OpenCV is missing (Debian: python3-opencv)")

FITS = ("fitEllipse", "fitEllipseAMS", "fitEllipseDirect")


def two_axes(text):
    axes = sorted((float(part) for part in text.split(",")), reverse=True)
    if len(axes) != 2 or axes[1] <= 0:
        raise argparse.ArgumentTypeError("two positive lengths, A,B")
    return axes


def arcs_of(path):
    """arc [deg] -> one array of points for every start"""
    points = collections.defaultdict(list)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            points[int(row["arc_deg"]), int(row["start_deg"])].append((float(row["x_m"]), float(row["y_m"])))
    arcs = collections.defaultdict(list)
    for (degrees, _), arc in points.items():
        arcs[degrees].append(np.array(arc))
    return arcs


def fitted_axes(fit, points):
    """Semi-axes, the larger first [m]."""
    about = points - points.mean(axis=0)
    spread = math.sqrt((about ** 2).mean())
    size = fit((about / spread).astype(np.float32))[1]
    return spread * max(size) / 2, spread * min(size) / 2


def worse_axis(fitted, true, tip_radius):
    errors = [abs((f - tip_radius) / t - 1) for f, t in zip(fitted, true)]
    return max(errors) if all(map(math.isfinite, errors)) else math.inf


def percent(errors):
    return f"{100 * statistics.median(errors):.3g}" if errors else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("arcs", help="what bench_real --arcs wrote")
    parser.add_argument("--semi-axes", type=two_axes, required=True, metavar="A,B", help="of the part [m]")
    parser.add_argument("--tip-radius", type=float, default=0.0, metavar="R", help="of the probe [m] (0)")
    options = parser.parse_args()
    print(f"OpenCV {cv2.__version__}; error of the worse axis, median over the arcs.\n")
    print("| arc [deg] | fit | median error [%] | arcs | fallen back to fitEllipse | "
          "median error of the others [%] |\n|---|---|---|---|---|---|")
    for degrees, arcs in sorted(arcs_of(options.arcs).items()):
        plain = [fitted_axes(cv2.fitEllipse, arc) for arc in arcs]
        for name in FITS:
            fitted = [fitted_axes(getattr(cv2, name), arc) for arc in arcs]
            errors = [worse_axis(f, options.semi_axes, options.tip_radius) for f in fitted]
            fallen = [name != "fitEllipse" and f == p for f, p in zip(fitted, plain)]
            own = [e for e, fell in zip(errors, fallen) if not fell]
            print(f"| {degrees} | {name} | {percent(errors)} | {len(arcs)} | {sum(fallen)} | {percent(own)} |")


if __name__ == "__main__":
    main()
