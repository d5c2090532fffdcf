#!/usr/bin/python3
"""Fits of a given class: `palpate fit --class` compared with geometric fits of scipy and OpenCV on the same points.

    tests/bench/peers/given_class.py build/strict/node/tool/palpate

Prints a table in markdown: time of one fit, root mean square orthogonal distance, and difference of the shape from
palpate's. scipy.optimize.least_squares minimises the same distances, from a start a few percent off the solution that
palpate has to find. OpenCV's fitEllipse is algebraic and takes float32. Needs the Debian packages python3-numpy and
python3-scipy; python3-opencv is optional.
"""
import json
import math
import subprocess
import sys
import time

import numpy as np
import scipy.optimize
import scipy.sparse

try:
    import cv2
except ImportError:
    cv2 = None

COUNTS = (12, 100, 500)
REPEATS = 5


def points_of(kind, count, rng):
    a, b = (0.03, 0.03) if kind == "circle" else (0.03, 0.02)
    t = rng.uniform(0.0, 4.0, count)
    noise = rng.normal(0.0, 2e-5, count)
    normal = np.stack([b * np.cos(t), a * np.sin(t)]) / np.hypot(b * np.cos(t), a * np.sin(t))
    p = np.stack([a * np.cos(t), b * np.sin(t)]) + noise * normal
    c, s = math.cos(0.4), math.sin(0.4)
    return (np.array([[c, -s], [s, c]]) @ p).T + [0.2, -0.1]


def palpate(tool, kind, points):
    rows = "probe,patch,x_m,y_m\n" + "".join(f"p,{i},{x!r},{y!r}\n" for i, (x, y) in
                                             enumerate(points.tolist()))
    best = math.inf
    for _ in range(REPEATS):
        done = subprocess.run([tool, "fit", "--class", kind, "--format", "json", "-"], input=rows, text=True,
                              capture_output=True, check=True)
        answer = json.loads(done.stdout)
        best = min(best, int(answer["recognition"]["compute_ns"]) * 1e-9)
    shape = answer["recognition"]["parameters"]
    return best, answer["rms_m"], [shape["a"]] + ([shape["b"]] if kind == "ellipse" else [])


def circle_residuals(q, p):
    return np.hypot(p[:, 0] - q[0], p[:, 1] - q[1]) - q[2]


def ellipse_residuals(q, p):
    """Orthogonal distances: one parameter per point in addition to the five of the ellipse."""
    c, s = math.cos(q[4]), math.sin(q[4])
    t = q[5:]
    x, y = q[2] * np.cos(t), q[3] * np.sin(t)
    return np.concatenate([p[:, 0] - q[0] - c * x + s * y, p[:, 1] - q[1] - s * x - c * y])


def ellipse_sparsity(n):
    pattern = scipy.sparse.lil_matrix((2 * n, 5 + n), dtype=int)
    pattern[:, :5] = 1
    for i in range(n):
        pattern[i, 5 + i] = pattern[n + i, 5 + i] = 1
    return pattern


def scipy_fit(kind, p):
    if kind == "circle":
        start, residuals, extra = [0.205, -0.095, 0.031], circle_residuals, {}
    else:
        d = p - [0.2, -0.1]
        c, s = math.cos(0.4), math.sin(0.4)
        t = np.arctan2((-s * d[:, 0] + c * d[:, 1]) / 0.02, (c * d[:, 0] + s * d[:, 1]) / 0.03)
        start = np.concatenate([[0.2005, -0.1005, 0.031, 0.0195, 0.42], t])
        residuals, extra = ellipse_residuals, {"jac_sparsity": ellipse_sparsity(len(p))}
    best = math.inf
    for _ in range(REPEATS):
        begin = time.perf_counter()
        fit = scipy.optimize.least_squares(residuals, start, args=(p,), x_scale="jac", xtol=1e-15, ftol=1e-15,
                                           gtol=1e-15, **extra)
        best = min(best, time.perf_counter() - begin)
    shape = [fit.x[2]] if kind == "circle" else sorted(fit.x[2:4], reverse=True)
    return best, math.sqrt(2.0 * fit.cost / len(p)), shape


def opencv_fit(p):
    middle = p.mean(axis=0)
    local = (p - middle).astype(np.float32)
    best = math.inf
    for _ in range(REPEATS):
        begin = time.perf_counter()
        (_, axes, _) = cv2.fitEllipse(local)
        best = min(best, time.perf_counter() - begin)
    return best, math.nan, sorted((0.5 * axes[0], 0.5 * axes[1]), reverse=True)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    rng = np.random.default_rng(1)
    print("| class | points | program | time, ms | rms, um | shape from palpate's |\n|---|---|---|---|---|---|")
    for kind in ("circle", "ellipse"):
        for count in COUNTS:
            p = points_of(kind, count, rng)
            answers = {"palpate": palpate(sys.argv[1], kind, p), "scipy": scipy_fit(kind, p)}
            if cv2 is not None and kind == "ellipse":
                answers["OpenCV fitEllipse"] = opencv_fit(p)
            ours = answers["palpate"][2]
            for name, (seconds, rms, shape) in answers.items():
                off = max(abs(u - v) / v for u, v in zip(shape, ours))
                print(f"| {kind} | {count} | {name} | {1e3 * seconds:.3g} | {1e6 * rms:.6g} | {off:.1e} |")


if __name__ == "__main__":
    main()
