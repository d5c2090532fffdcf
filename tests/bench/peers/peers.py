#!/usr/bin/python3
"""palpate compared with other programs that fit these curves, on the same points.

    build/strict/tests/bench/peers/peer_scenes FOLDER
    tests/bench/peers/peers.py FOLDER

Reads points.csv, truth.csv and palpate.csv of FOLDER, writes peers.csv (all results) there and prints tables in
markdown. To compare times, run both programs on the same machine, one after the other, with nothing else running. Needs
the Debian package python3-numpy; python3-opencv and python3-scipy are optional.

Each peer gets the points relative to their mean, in units of their spread. OpenCV needs that because it takes float32
only (rounding 6e-8 of the value): coordinates are up to ten sizes from the origin, so unshifted points would be rounded
by 6e-7 of the size, more than half of the smallest noise here. No peer gets more information than palpate; scipy.odr and
palpate "class given" know the class.
"""
import argparse
import collections
import csv
import math
import pathlib
import statistics
import sys
import time

import numpy as np

try:
    import cv2
except ImportError:
    cv2 = None
try:
    import scipy.odr
except ImportError:
    scipy = None

CONICS = ("ellipse", "parabola", "hyperbola")
Answer = collections.namedtuple("Answer", "curve_class shape")  # shape: {letter: value}; {} = none
NO_ANSWER = Answer("", {})


# --- conics A x^2 + B x y + C y^2 + D x + E y + F = 0

def design(x, y):
    return np.column_stack((x * x, x * y, y * y, x, y, np.ones_like(x)))


def algebraic_conic(x, y):
    return np.linalg.svd(design(x, y), full_matrices=False)[2][-1]


def discriminant_class(conic, tolerance):
    """The class by B^2 - 4 A C relative to its natural size; a fit is never exactly a parabola."""
    a, b, c = conic[:3]
    d = (b * b - 4 * a * c) / (a * a + b * b + c * c)
    return "parabola" if abs(d) <= tolerance else "ellipse" if d < 0 else "hyperbola"


def specific_conic(x, y, wanted):
    """The algebraic fit with the constraint 4 A C - B^2 = 1 (Fitzgibbon) or -1: always of the given class."""
    d = design(x, y)
    d1, d2 = d[:, :3], d[:, 3:]
    t = -np.linalg.solve(d2.T @ d2, d2.T @ d1)
    m = d1.T @ d1 + (d1.T @ d2) @ t
    values, vectors = np.linalg.eig(np.array([m[2] / 2, -m[1], m[0] / 2]))
    vectors = np.real(vectors[:, np.abs(np.imag(values)) <= 1e-9 * np.abs(values).max()])
    sign = 4 * vectors[0] * vectors[2] - vectors[1] ** 2
    if wanted == "hyperbola":
        sign = -sign
    found = [i for i in range(vectors.shape[1]) if sign[i] > 0]
    if not found:
        return None
    best = min(found, key=lambda i: vectors[:, i] @ m @ vectors[:, i] / sign[i])
    head = vectors[:, best]
    return np.concatenate((head, t @ head))


def central_parameters(conic, wanted):
    """(a, b, x, y, theta) of an ellipse (a >= b) or hyperbola (a along the transverse axis); None if the conic is not of
    that class."""
    a, b, c, d, e, f = conic
    quadratic = np.array([[a, b / 2], [b / 2, c]])
    if (np.linalg.det(quadratic) > 0) != (wanted == "ellipse"):
        return None
    centre = np.linalg.solve(2 * quadratic, [-d, -e])
    level = -(f + (d * centre[0] + e * centre[1]) / 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        values, axes = np.linalg.eigh(quadratic)
        squares = level / values
    order = np.argsort(-squares)
    squares, axes = squares[order], axes[:, order]
    if not np.all(np.isfinite(squares)) or squares[0] <= 0 or (
            (squares[1] > 0) != (wanted == "ellipse")):
        return None
    return np.array([math.sqrt(squares[0]), math.sqrt(abs(squares[1])), *centre,
                     math.atan2(axes[1, 0], axes[0, 0])])


def parabola_parameters(conic, x, y):
    """(a, x, y, theta) of the parabola y^2 = 4 a x along the axis of a conic."""
    a, b, c = conic[:3]
    values, axes = np.linalg.eigh(np.array([[a, b / 2], [b / 2, c]]))
    axis = axes[:, np.argmin(np.abs(values))]
    theta = math.atan2(axis[1], axis[0])
    u, v = turned_back(x, y, theta)
    p = np.polyfit(v, u, 2)  # u = p0 v^2 + ...
    if p[0] < 0:
        theta += math.pi
        u, v = -u, -v
        p = np.polyfit(v, u, 2)
    v0 = -p[1] / (2 * p[0])
    u0 = np.polyval(p, v0)
    cosine, sine = math.cos(theta), math.sin(theta)
    return np.array([1 / (4 * p[0]), cosine * u0 - sine * v0, sine * u0 + cosine * v0, theta])


def turned_back(x, y, theta):
    cosine, sine = math.cos(theta), math.sin(theta)
    return cosine * x + sine * y, cosine * y - sine * x


def algebraic(x, y, _, options):
    """A simple implementation, as one might write in an afternoon."""
    conic = algebraic_conic(x, y)
    found = discriminant_class(conic, options.parabola_tolerance)
    if found == "parabola":
        return Answer(found, {"a": parabola_parameters(conic, x, y)[0]})
    central = central_parameters(conic, found)
    return NO_ANSWER if central is None else Answer(found, {"a": central[0], "b": central[1]})


# --- OpenCV: always an ellipse

def opencv(fit):
    def run(x, y, _, options):
        (_, size, _) = fit(np.column_stack((x, y)).astype(np.float32))
        return Answer("ellipse", {"a": max(size) / 2, "b": min(size) / 2})
    return run


# --- ODRPACK: orthogonal distances to the implicit curve of the true class

def implicit_ellipse(s, u, v):
    a, b = s
    return ((u / a) ** 2 + (v / b) ** 2 - 1, 2 * u / a ** 2, 2 * v / b ** 2,
            [-2 * u ** 2 / a ** 3, -2 * v ** 2 / b ** 3])


def implicit_hyperbola(s, u, v):
    a, b = s
    return ((u / a) ** 2 - (v / b) ** 2 - 1, 2 * u / a ** 2, -2 * v / b ** 2,
            [-2 * u ** 2 / a ** 3, 2 * v ** 2 / b ** 3])


def implicit_parabola(s, u, v):
    return v * v - 4 * s[0] * u, np.full_like(u, -4 * s[0]), 2 * v, [-4 * u]


def implicit_cubical_parabola(s, u, v):
    a, c = s
    return (a * u ** 3 + c * u - v, 3 * a * u * u + c, np.full_like(u, -1.0), [u ** 3, u])


IMPLICIT = {"ellipse": (implicit_ellipse, "ab"), "hyperbola": (implicit_hyperbola, "ab"),
            "parabola": (implicit_parabola, "a"),
            "cubical_parabola": (implicit_cubical_parabola, "ac")}


def odr_model(curve_class):
    """The implicit curve in world coordinates; parameters [shape; x; y; theta]; exact derivatives."""
    function, letters = IMPLICIT[curve_class]
    n = len(letters)

    def at(beta, points):
        u, v = turned_back(points[0] - beta[n], points[1] - beta[n + 1], beta[n + 2])
        return u, v, function(beta[:n], u, v)

    def by_parameters(beta, points):
        u, v, (_, fu, fv, by_shape) = at(beta, points)
        cosine, sine = math.cos(beta[n + 2]), math.sin(beta[n + 2])
        return np.vstack((*by_shape, -(cosine * fu - sine * fv), -(sine * fu + cosine * fv),
                          fu * v - fv * u))

    def by_points(beta, points):
        _, _, (_, fu, fv, _) = at(beta, points)
        cosine, sine = math.cos(beta[n + 2]), math.sin(beta[n + 2])
        return np.vstack((cosine * fu - sine * fv, sine * fu + cosine * fv))

    return scipy.odr.Model(lambda beta, points: at(beta, points)[2][0], fjacb=by_parameters,
                           fjacd=by_points, implicit=1)


def cubical_parabola_start(x, y):
    """(a, c, x, y, theta): the best of 90 directions of the axis by a cubic polynomial."""
    best = None
    for theta in np.arange(90) * math.pi / 90:
        u, v = turned_back(x, y, theta)
        basis = np.vander(u, 4)
        p, _, rank, _ = np.linalg.lstsq(basis, v, rcond=None)
        # Across the curve: a vertical distance counts by the cosine of the slope.
        slope = np.polyval(np.polyder(p), u)
        residual = np.sum((basis @ p - v) ** 2 / (1 + slope ** 2))
        if rank == 4 and p[0] != 0 and (best is None or residual < best[0]):
            best = (residual, theta, p)
    _, theta, p = best
    u0 = -p[1] / (3 * p[0])
    v0 = np.polyval(p, u0)
    cosine, sine = math.cos(theta), math.sin(theta)
    return np.array([p[0], np.polyval(np.polyder(p), u0), cosine * u0 - sine * v0,
                     sine * u0 + cosine * v0, theta])


def odr_start(x, y, curve_class):
    if curve_class == "cubical_parabola":
        return cubical_parabola_start(x, y)
    conic = algebraic_conic(x, y)
    if curve_class == "parabola":
        return parabola_parameters(conic, x, y)
    start = central_parameters(conic, curve_class)
    if start is None:
        conic = specific_conic(x, y, curve_class)
        start = None if conic is None else central_parameters(conic, curve_class)
    return start


def odr(x, y, curve_class, options):
    start = odr_start(x, y, curve_class)
    if start is None:
        return NO_ANSWER
    fit = scipy.odr.ODR(scipy.odr.Data(np.vstack((x, y)), 1), odr_model(curve_class), beta0=start,
                        maxit=options.odr_iterations)
    fit.set_job(fit_type=1, deriv=2)  # implicit, derivatives given and not checked
    beta = fit.run().beta
    letters = IMPLICIT[curve_class][1]
    shape = dict(zip(letters, beta))
    if curve_class in ("ellipse", "hyperbola"):
        shape = {letter: abs(value) for letter, value in shape.items()}
    if curve_class == "ellipse":
        shape = {"a": max(shape.values()), "b": min(shape.values())}
    return Answer(curve_class, shape)


# --- Running and judging

def peers_present():
    """{name: (function, classes that it can fit)}"""
    peers = {"algebraic conic": (algebraic, CONICS)}
    if cv2 is None:
        print("skipped: OpenCV (python3-opencv is not installed)", file=sys.stderr)
    else:
        for name in ("fitEllipse", "fitEllipseAMS", "fitEllipseDirect"):
            peers[name] = (opencv(getattr(cv2, name)), ("ellipse",))
    if scipy is None:
        print("skipped: scipy.odr (python3-scipy is not installed)", file=sys.stderr)
    else:
        peers["scipy.odr, class given"] = (odr, tuple(IMPLICIT))
    return peers


def timed(fit, points, curve_class, options):
    """Returns the answer and the median time from the user's points to the shape in metres."""
    seconds = []
    for _ in range(options.repetitions):
        start = time.perf_counter()
        mean = points.mean(axis=0)
        about = points - mean
        spread = math.sqrt((about ** 2).mean())
        about /= spread
        try:
            answer = fit(about[:, 0], about[:, 1], curve_class, options)
        except (np.linalg.LinAlgError, ValueError, *(() if cv2 is None else (cv2.error,))) as error:
            print(f"failed: {fit.__name__}: {error}", file=sys.stderr)
            answer = NO_ANSWER
        answer = Answer(answer.curve_class, scaled(answer, spread))
        seconds.append(time.perf_counter() - start)
    return answer, statistics.median(seconds)


def scaled(answer, unit):
    """The shape in metres; a cubical parabola's a is in 1/m^2, its c is a slope."""
    if answer.curve_class == "cubical_parabola":
        return {"a": answer.shape["a"] / unit ** 2, "c": answer.shape["c"]}
    return {letter: value * unit for letter, value in answer.shape.items()}


def relative_error(answer, truth):
    """The largest relative error of the parameters; infinite for another class or no shape. The error of a cubical
    parabola's c, a slope, is relative to at least 1. The signs of a and c do not depend on the frame."""
    if answer.curve_class != truth.curve_class or not answer.shape or answer.shape["a"] == 0:
        return math.inf
    worst = 0.0
    for letter, value in truth.shape.items():
        natural = max(abs(value), 1.0) if letter == "c" else abs(value)
        error = abs(answer.shape.get(letter, math.inf) - value) / natural
        worst = max(worst, error if math.isfinite(error) else math.inf)
    return worst


def rows_of(path):
    with open(path, newline="") as file:
        yield from csv.DictReader(file)


def shape_of(row, prefix=""):
    return {letter: float(row[prefix + letter]) for letter in "abc" if row[prefix + letter]}


def read(folder):
    truth = {int(row["scene"]): row for row in rows_of(folder / "truth.csv")}
    points = collections.defaultdict(list)
    for row in rows_of(folder / "points.csv"):
        points[int(row["scene"])].append((float(row["x_m"]), float(row["y_m"])))
    palpate = {int(row["scene"]): row for row in rows_of(folder / "palpate.csv")}
    return truth, {scene: np.array(p) for scene, p in points.items()}, palpate


PALPATE = "palpate"
PALPATE_GIVEN = "palpate, class given"


def measure(options):
    """Returns one row per scene and peer."""
    truth, points, palpate = read(options.folder)
    peers = peers_present()
    rows = []
    for scene, row in truth.items():
        true = Answer(row["class"], shape_of(row))
        said = palpate[scene]
        answers = [(PALPATE, Answer(said["class"], shape_of(said)), float(said["seconds"]),
                    said["status"]),
                   (PALPATE_GIVEN, Answer(row["class"], shape_of(said, "given_")),
                    float(said["given_seconds"]), said["given_status"])]
        for name, (fit, classes) in peers.items():
            if true.curve_class in classes:
                answer, seconds = timed(fit, points[scene], true.curve_class, options)
                answers.append((name, answer, seconds, ""))
        for name, answer, seconds, status in answers:
            rows.append({
                "scene": scene, "kind": row["kind"], "noise_over_size": row["noise_over_size"],
                "class": true.curve_class, "peer": name, "answer": answer.curve_class,
                "status": status, **{letter: answer.shape.get(letter, "") for letter in "abc"},
                "relative_error": relative_error(answer, true), "seconds": seconds,
                "over_palpate": seconds / float(said["seconds"])})
    return rows, [PALPATE, PALPATE_GIVEN, *peers]


def number(value):
    return "none" if math.isinf(value) else f"{value:.2g}" if value >= 1e-3 else f"{value:.1e}"


def percent(part):
    return f"{100 * sum(part) / len(part):.0f}"


def print_table(title, cells, kinds, columns):
    print(f"\n{title}\n")
    print("| touched | noise/size | " + " | ".join(columns) + " |")
    print("|---|---|" + "---|" * len(columns))
    for kind, noise in kinds:
        values = [cells.get((kind, noise, column), "") for column in columns]
        print(f"| {kind.replace('_', ' ')} | {noise} | " + " | ".join(values) + " |")


def print_tables(rows, columns, options):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row["kind"], row["noise_over_size"], row["peer"]].append(row)
    kinds = list(dict.fromkeys((kind, noise) for kind, noise, _ in groups))

    def table(title, value, wanted):
        cells = {key: value(group) for key, group in groups.items() if key[2] in wanted}
        print_table(title, cells, kinds, [c for c in columns if c in wanted])

    scenes = len(rows) and len(next(iter(groups.values())))
    print(f"{scenes} scenes a row. Not every peer knows every class: an empty field is a class it was "
          "not asked about.")
    table("Relative error of the worse of a and b (cubical parabola: a and c), median; none: half of the "
          "answers or more name another class or no shape",
          lambda group: number(statistics.median_low([r["relative_error"] for r in group])), columns)
    medians = {key: statistics.median_low([r["relative_error"] for r in group]) for key, group in groups.items()}
    print_table("The same over palpate's", {
        key: number(error / medians[(*key[:2], PALPATE)]) for key, error in medians.items()
        if 0 < medians[(*key[:2], PALPATE)] < math.inf}, kinds, [c for c in columns if c != PALPATE])
    table(f"Within {100 * options.success:.0f} % [% of scenes]",
          lambda group: percent([r["relative_error"] <= options.success for r in group]), columns)
    judges = [c for c in columns if c in (PALPATE, "algebraic conic")]
    table("Class right, of those that tell one [% of scenes]",
          lambda group: percent([r["answer"] == r["class"] for r in group]), judges)
    said = {}
    for key, group in groups.items():
        if key[2] == PALPATE:
            sure = [r["status"] == "recognized" for r in group]
            wrong = [s and r["answer"] != r["class"] for s, r in zip(sure, group)]
            far = [s and not w and r["relative_error"] > options.success
                   for s, w, r in zip(sure, wrong, group)]
            said[(*key[:2], "RECOGNIZED")] = percent(sure)
            said[(*key[:2], "of these another class")] = percent(wrong)
            said[(*key[:2], f"of these beyond {100 * options.success:.0f} %")] = percent(far)
    print_table("palpate's certainty [% of scenes]", said, kinds, list(dict.fromkeys(
        key[2] for key in said)))
    table("Time of a fit over palpate's cold recognition of the same scene, all classes considered; "
          "median",
          lambda group: number(statistics.median([r["over_palpate"] for r in group])),
          [c for c in columns if c != PALPATE])
    for name in ("fitEllipseAMS", "fitEllipseDirect"):
        own = [r for r in rows if r["peer"] == name]
        plain = {r["scene"]: (r["a"], r["b"]) for r in rows if r["peer"] == "fitEllipse"}
        if own:
            same = sum((r["a"], r["b"]) == plain[r["scene"]] for r in own)
            print(f"\n{name} gave fitEllipse's answer, to the last digit, in {same} of {len(own)} scenes: OpenCV falls "
                  "back to it without a word.")
    times = [r["seconds"] for r in rows if r["peer"] == PALPATE]
    print(f"\npalpate's own: median {1e3 * statistics.median(times):.2f} ms. The peers' times include "
          "Python's calls; scipy.odr calls back into numpy at every step.")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="what peer_scenes wrote")
    parser.add_argument("--repetitions", type=int, default=3, help="of each fit that is timed (3)")
    parser.add_argument("--success", type=float, default=0.1, help="relative error that counts (0.1)")
    parser.add_argument("--parabola-tolerance", type=float, default=0.02,
                        help="of the algebraic fit's discriminant, over its natural size (0.02)")
    parser.add_argument("--odr-iterations", type=int, default=200, help="ODRPACK's maxit (200)")
    options = parser.parse_args()
    rows, columns = measure(options)
    with open(options.folder / "peers.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    print_tables(rows, columns, options)


if __name__ == "__main__":
    main()
