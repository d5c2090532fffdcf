#!/usr/bin/python3
"""Fits of a given class: `palpate fit --class`, scipy and OpenCV compared with least squares in 50 digits.

    tests/bench/peers/given_reference.py build/strict/node/tool/palpate [tests/data/reference/given.txt]

Prints a table in markdown, one row per class and program: time of one fit, and difference of the shape (for a line: its
direction) from the 50-digit one relative to its largest parameter, median and worst over the file's cases. Leaves out
cases with fewer points than the unknowns plus one, and those where a lower sum of squares than the reference's is found.

scipy.optimize.least_squares (orthogonal distances: one parameter per point in addition to those of the class) and
scipy.odr (the implicit equation) start one percent off the truth, with the points' mean subtracted; palpate has to find
it by itself. OpenCV's fitEllipse, fitEllipseAMS and fitEllipseDirect are algebraic; these and fitLine take float32.
Uses the Debian packages python3-numpy, python3-scipy and python3-opencv, and says which is absent.
"""
import json
import math
import pathlib
import subprocess
import sys
import time

import numpy as np

try:
    import scipy.odr
    import scipy.optimize
    import scipy.sparse
    HAVE_SCIPY = True
except ImportError:
    HAVE_SCIPY = False
try:
    import cv2
except ImportError:
    cv2 = None

REPEATS = 3
LETTERS = {"line": "", "circle": "a", "ellipse": "ab", "parabola": "a", "hyperbola": "ab", "cubical_parabola": "ac",
           "semi_cubical_parabola": "ab", "cubic_spline": "abc"}
UNKNOWNS = {"line": 2, "circle": 3, "ellipse": 5, "parabola": 4, "hyperbola": 5, "cubical_parabola": 5,
            "semi_cubical_parabola": 5, "cubic_spline": 6}


def read_cases(path):
    cases = []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if not words or words[0] == "#":
            continue
        if words[0] == "case":
            cases.append({"name": words[1], "class": words[2], "points": []})
        elif words[0] == "value":
            cases[-1]["value"] = [float(w) for w in words[1:]]
        elif words[0] == "squares":
            cases[-1]["squares"] = float(words[1])
        elif words[0] != "rounding":
            cases[-1]["points"].append([float(w) for w in words])
    for case in cases:
        case["points"] = np.array(case["points"])
    return [case for case in cases if len(case["points"]) > UNKNOWNS[case["class"]]]


def curve(name, s, t):
    """Points of the canonical curve."""
    if name == "line":
        return t, 0.0 * t
    if name in ("circle", "ellipse"):
        return s[0] * np.cos(t), s[-1] * np.sin(t)
    if name == "parabola":
        return s[0] * t * t, 2.0 * s[0] * t
    if name == "hyperbola":
        return s[0] * np.cosh(t), s[1] * np.sinh(t)
    if name == "cubical_parabola":
        return t, s[0] * t**3 + s[1] * t
    c = s[2] if name == "cubic_spline" else 0.0
    return t * t, s[0] * t**3 + s[1] * t * t + c * t


def implicit(name, s, x, y):
    """An implicit function: zero on the canonical curve, near it about the distance where that is simple."""
    if name == "line":
        return y
    if name in ("circle", "ellipse"):
        return (x / s[0])**2 + (y / s[-1])**2 - 1.0
    if name == "parabola":
        return y * y - 4.0 * s[0] * x
    if name == "hyperbola":
        return (x / s[0])**2 - (y / s[1])**2 - 1.0
    if name == "cubical_parabola":
        return y - s[0] * x**3 - s[1] * x
    c = s[2] if name == "cubic_spline" else 0.0
    return (y - s[1] * x)**2 - x * (s[0] * x + c)**2


def placed(pose, x, y):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return pose[0] + c * x - s * y, pose[1] + s * x + c * y


def local(pose, p):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    dx, dy = p[:, 0] - pose[0], p[:, 1] - pose[1]
    return c * dx + s * dy, c * dy - s * dx


def feet(name, s, pose, p):
    """Parameters of the nearest points, by dense sampling."""
    x, y = local(pose, p)
    reach = np.max(np.hypot(x, y))
    if name in ("circle", "ellipse"):
        t = np.linspace(-math.pi, math.pi, 4001)
    elif name == "hyperbola":
        most = math.acosh(1.0 + 2.0 * reach / s[0])
        t = np.linspace(-most, most, 4001)
    elif name in ("line", "cubical_parabola"):
        t = np.linspace(-reach, reach, 4001)
    else:
        most = math.sqrt(reach / s[0]) if name == "parabola" else math.sqrt(reach)
        t = np.linspace(-1.2 * most, 1.2 * most, 4001)
    cx, cy = curve(name, s, t)
    return np.array([t[np.argmin((cx - u)**2 + (cy - v)**2)] for u, v in zip(x, y)])


def start_of(case):
    """Returns (shape, pose, points): a start one percent off the truth, and the points. Pose and points are relative to
    the points' mean."""
    n = len(LETTERS[case["class"]])
    middle = case["points"].mean(axis=0)
    p = case["points"] - middle
    shape = 1.01 * np.array(case["value"][:n])
    extent = 0.5 * np.max(np.ptp(p, axis=0))
    x, y, theta = case["value"][n:]
    return shape, [x - middle[0] + 0.01 * extent, y - middle[1] - 0.01 * extent, theta + 0.01], p


def timed(fit):
    best, answer = math.inf, None
    for _ in range(REPEATS):
        begin = time.perf_counter()
        answer = fit()
        best = min(best, time.perf_counter() - begin)
    return best, answer


def by_least_squares(case):
    name, n = case["class"], len(LETTERS[case["class"]])
    shape, pose, p = start_of(case)
    t = feet(name, shape, pose, p)
    start = np.concatenate([shape, pose, t])
    pattern = scipy.sparse.lil_matrix((2 * len(p), n + 3 + len(p)), dtype=int)
    pattern[:, :n + 3] = 1
    for i in range(len(p)):
        pattern[i, n + 3 + i] = pattern[len(p) + i, n + 3 + i] = 1

    def residuals(q):
        x, y = placed(q[n:n + 3], *curve(name, q[:n], q[n + 3:]))
        return np.concatenate([p[:, 0] - x, p[:, 1] - y])

    seconds, fit = timed(lambda: scipy.optimize.least_squares(
        residuals, start, x_scale="jac", xtol=1e-15, ftol=1e-15, gtol=1e-15, jac_sparsity=pattern, max_nfev=500))
    return seconds, fit.x[:n], fit.x[n + 2]


def by_odr(case):
    name, n = case["class"], len(LETTERS[case["class"]])
    shape, pose, p = start_of(case)
    # A line's origin and a circle's angle are free: they stay.
    fixed = [1] * (n + 3)
    if name == "circle":
        fixed[n + 2] = 0
    if name == "line":
        fixed[0 if abs(math.cos(pose[2])) > 0.7 else 1] = 0

    def equation(q, x):
        return implicit(name, q[:n], *local(q[n:], x.T))

    model = scipy.odr.Model(equation, implicit=True)
    seconds, fit = timed(lambda: scipy.odr.ODR(scipy.odr.Data(p.T, 1), model, beta0=np.concatenate([shape, pose]),
                                               ifixb=fixed, maxit=500, sstol=1e-15, partol=1e-15).run())
    return seconds, fit.beta[:n], fit.beta[n + 2]


def by_opencv(case, fit):
    p = (case["points"] - case["points"].mean(axis=0)).astype(np.float32)
    if case["class"] == "line":
        seconds, line = timed(lambda: cv2.fitLine(p, cv2.DIST_L2, 0, 1e-12, 1e-12))
        return seconds, [], math.atan2(line[1, 0], line[0, 0])
    seconds, (_, axes, angle) = timed(lambda: fit(p))
    return seconds, sorted((0.5 * axes[0], 0.5 * axes[1]), reverse=True), math.radians(angle)


def by_palpate(tool, case):
    rows = "probe,patch,x_m,y_m\n" + "".join(f"p,{i},{x!r},{y!r}\n"
                                             for i, (x, y) in enumerate(case["points"].tolist()))
    best = math.inf
    for _ in range(REPEATS):
        done = subprocess.run([tool, "fit", "--class", case["class"], "--format", "json", "-"], input=rows, text=True,
                              capture_output=True, check=False)
        if not done.stdout:
            raise RuntimeError(done.stderr)
        told = json.loads(done.stdout)
        answer = told["recognition"]
        case["rms"] = told["rms_m"]
        best = min(best, int(answer["compute_ns"]) * 1e-9)
    return best, [answer["parameters"][letter] for letter in LETTERS[case["class"]]], answer["pose"]["theta_rad"]


def error_of(case, shape, theta):
    n = len(LETTERS[case["class"]])
    if n == 0:
        return abs(math.remainder(theta - case["value"][2], math.pi))
    truth = np.array(case["value"][:n])
    return float(np.max(np.abs(np.array(shape) - truth)) / np.max(np.abs(truth)))


def is_least(tool, case):
    """True if the 50-digit reference is the least squares solution. The reference follows each foot point along its arm;
    next to a cusp a nearer one may be on the other arm."""
    by_palpate(tool, case)
    if case["rms"] < math.sqrt(case["squares"] / len(case["points"])) * (1.0 - 1e-9):
        print(f"{case['name']}: palpate leaves less than the reference; not asked about", file=sys.stderr)
        return False
    return True


def programs(tool):
    fits = {"palpate": (lambda case: by_palpate(tool, case), LETTERS)}
    if HAVE_SCIPY:
        fits["scipy least_squares"] = (by_least_squares, LETTERS)
        fits["scipy odr"] = (by_odr, LETTERS)
    else:
        print("scipy is not there: its fits are left out", file=sys.stderr)
    if cv2 is not None:
        for name in ("fitEllipse", "fitEllipseAMS", "fitEllipseDirect"):
            fits["OpenCV " + name] = (lambda case, fit=getattr(cv2, name): by_opencv(case, fit), {"ellipse"})
        fits["OpenCV fitLine"] = (lambda case: by_opencv(case, None), {"line"})
    else:
        print("OpenCV is not there: its fits are left out", file=sys.stderr)
    return fits


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    default = pathlib.Path(__file__).resolve().parents[2] / "data/reference/given.txt"
    cases = read_cases(sys.argv[2] if len(sys.argv) == 3 else default)
    print("| class | program | cases | no answer | time, ms: median | worst | off the 50 digits: median | worst |")
    print("|---|---|---|---|---|---|---|---|")
    for name in LETTERS:
        of_class = [case for case in cases if case["class"] == name and is_least(sys.argv[1], case)]
        for program, (fit, classes) in programs(sys.argv[1]).items():
            if name not in classes:
                continue
            times, errors, none = [], [], 0
            for case in of_class:
                try:
                    seconds, shape, theta = fit(case)
                except (RuntimeError, KeyError, ValueError, ArithmeticError, np.linalg.LinAlgError) as failure:
                    print(f"{program}, {case['name']}: {type(failure).__name__} {failure}", file=sys.stderr)
                    none += 1
                    continue
                times.append(1e3 * seconds)
                errors.append(error_of(case, shape, theta))
            if times:
                print(f"| {name} | {program} | {len(of_class)} | {none} | {np.median(times):.3g} | {max(times):.3g} | "
                      f"{np.median(errors):.1e} | {max(errors):.1e} |", flush=True)


if __name__ == "__main__":
    main()
