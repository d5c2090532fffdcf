#!/usr/bin/env python3
"""Writes given.txt: least orthogonal distances of every class in 50-digit arithmetic, for
tests/unit/recognition/given_class_test.cpp. Run where python3-mpmath is: make_given.py > given.txt

Independent of the program: parameters are counted in the world's frame, foot points by Newton's
method in t, the gradient of the sum of squares in closed form, its Hessian by differences of that
gradient (1e-24 apart), Newton's method on it to 1e-40.

Per case: `case NAME CLASS POINTS`, `value` [shape; x; y; theta], `rounding` of each (what one
rounding of every coordinate, relative to the half extent, moves it by, in the root of the sum of
squares, and one rounding of its own), `squares` (sum of squared distances), then the points. A
circle's theta is 0, a line's origin lies nearest to the points' mean."""
import math
import random
import sys

import mpmath as mp

mp.mp.dps = 50
EPSILON = mp.mpf(2) ** -52
LETTERS = {"line": 0, "circle": 1, "parabola": 1, "cubic_spline": 3}


def curve(name, s, t):
    """Position, first and second derivative by t, and the position by every shape parameter."""
    if name == "line":
        return (t, mp.mpf(0)), (mp.mpf(1), mp.mpf(0)), (mp.mpf(0), mp.mpf(0)), []
    if name in ("circle", "ellipse"):
        a, b = s[0], s[-1]
        c, i = mp.cos(t), mp.sin(t)
        by = [(c, i)] if name == "circle" else [(c, mp.mpf(0)), (mp.mpf(0), i)]
        return (a * c, b * i), (-a * i, b * c), (-a * c, -b * i), by
    if name == "parabola":
        a = s[0]
        return (a * t * t, 2 * a * t), (2 * a * t, 2 * a), (2 * a, mp.mpf(0)), [(t * t, 2 * t)]
    if name == "hyperbola":
        a, b = s
        c, i = mp.cosh(t), mp.sinh(t)
        return (a * c, b * i), (a * i, b * c), (a * c, b * i), [(c, mp.mpf(0)), (mp.mpf(0), i)]
    if name == "cubical_parabola":
        a, c = s
        return ((t, a * t**3 + c * t), (mp.mpf(1), 3 * a * t * t + c), (mp.mpf(0), 6 * a * t),
                [(mp.mpf(0), t**3), (mp.mpf(0), t)])
    a, b = s[:2]
    c = s[2] if name == "cubic_spline" else mp.mpf(0)
    by = [(mp.mpf(0), t**3), (mp.mpf(0), t * t), (mp.mpf(0), t)]
    return ((t * t, a * t**3 + b * t * t + c * t), (2 * t, 3 * a * t * t + 2 * b * t + c),
            (mp.mpf(2), 6 * a * t + 2 * b), by[:len(s)])


class Problem:
    def __init__(self, name, shape, pose, points, feet):
        self.name = name
        self.letters = len(shape)
        self.points = [(mp.mpf(x), mp.mpf(y)) for x, y in points]
        self.feet = [mp.mpf(t) for t in feet]
        q = [mp.mpf(v) for v in shape]
        x, y, theta = (mp.mpf(v) for v in pose)
        self.theta = theta  # of a circle: 0
        # Of a line: distance of its points from the mean along the first normal, and the angle.
        n = len(points)
        self.mean = (sum(p[0] for p in self.points) / n, sum(p[1] for p in self.points) / n)
        if name == "line":
            c, s = mp.cos(theta), mp.sin(theta)
            offset = -s * (x - self.mean[0]) + c * (y - self.mean[1])
            self.base = theta
            q += [offset, theta]
        elif name == "circle":
            q += [x, y]
        else:
            q += [x, y, theta]
        self.q = q

    def pose(self, q):
        if self.name == "line":
            c, s = mp.cos(self.base), mp.sin(self.base)
            return (self.mean[0] - s * q[0], self.mean[1] + c * q[0], q[1])
        if self.name == "circle":
            return (q[1], q[2], mp.mpf(0))
        return tuple(q[self.letters:])

    def term(self, q, trig, point, i):
        """Gradient of half the squared distance of one point, and that distance squared."""
        x, y, c, s = trig
        dx, dy = point[0] - x, point[1] - y
        p = (c * dx + s * dy, -s * dx + c * dy)
        t = self.feet[i]
        shape = q[:self.letters]
        for _ in range(60):
            at, first, second, by = curve(self.name, shape, t)
            away = (p[0] - at[0], p[1] - at[1])
            f = away[0] * first[0] + away[1] * first[1]
            slope = (first[0]**2 + first[1]**2 - away[0] * second[0] - away[1] * second[1])
            step = f / slope
            t += step
            if abs(step) < mp.mpf(10)**-46 * (1 + abs(t)):
                break
        self.feet[i] = t
        at, first, second, by = curve(self.name, shape, t)
        away = (p[0] - at[0], p[1] - at[1])
        gradient = [-(away[0] * d[0] + away[1] * d[1]) for d in by]
        world = (c * away[0] - s * away[1], s * away[0] + c * away[1])
        turn = -(away[1] * at[0] - away[0] * at[1])
        if self.name == "line":
            cb, sb = mp.cos(self.base), mp.sin(self.base)
            gradient += [-(-sb * world[0] + cb * world[1]), turn]
        elif self.name == "circle":
            gradient += [-world[0], -world[1]]
        else:
            gradient += [-world[0], -world[1], turn]
        return gradient, away[0]**2 + away[1]**2

    def frame(self, q):
        x, y, theta = self.pose(q)
        return x, y, mp.cos(theta), mp.sin(theta)

    def gradient(self, q):
        trig = self.frame(q)
        total = [mp.mpf(0)] * len(q)
        squares = mp.mpf(0)
        for i, point in enumerate(self.points):
            g, d2 = self.term(q, trig, point, i)
            total = [u + v for u, v in zip(total, g)]
            squares += d2
        return total, squares

    def hessian(self, q, g):
        h = mp.mpf(10)**-24
        rows = mp.matrix(len(q), len(q))
        for j in range(len(q)):
            step = h * max(abs(q[j]), mp.mpf(10)**-6)
            moved = list(q)
            moved[j] += step
            other, _ = self.gradient(moved)
            for i in range(len(q)):
                rows[i, j] = (other[i] - g[i]) / step
        return rows

    def solve(self):
        g, squares = self.gradient(self.q)
        for _ in range(60):
            hessian = self.hessian(self.q, g)
            scale = [mp.sqrt(abs(hessian[i, i])) for i in range(len(g))]
            damping = mp.mpf(0)
            while True:
                m = hessian.copy()
                for i in range(len(g)):
                    m[i, i] += damping * scale[i]**2
                step = mp.lu_solve(m, mp.matrix([-v for v in g]))
                length = max(abs(step[i]) * scale[i] for i in range(len(g)))
                trial = [self.q[i] + step[i] for i in range(len(g))]
                feet = list(self.feet)
                next_g, next_squares = self.gradient(trial)
                if next_squares <= squares or length < mp.mpf(10)**-20:
                    break
                self.feet = feet
                damping = max(10 * damping, mp.mpf(10)**-6)
                if damping > 1e6:
                    raise ArithmeticError("no descent")
            self.q, g, squares = trial, next_g, next_squares
            if length < mp.mpf(10)**-36:
                break
        else:
            raise ArithmeticError("not settled")
        hessian = self.hessian(self.q, g)
        # A minimum, not a saddle.
        mp.cholesky((hessian + hessian.T) / 2)
        return squares, hessian

    def rounding(self, hessian):
        """What one rounding of every coordinate moves each unknown by."""
        inverse = hessian**-1
        xs, ys = [p[0] for p in self.points], [p[1] for p in self.points]
        half = max(max(xs) - min(xs), max(ys) - min(ys)) / 2
        trig = self.frame(self.q)
        h = mp.mpf(10)**-24 * half
        sums = [mp.mpf(0)] * len(self.q)
        for i, point in enumerate(self.points):
            g, _ = self.term(self.q, trig, point, i)
            for axis in range(2):
                moved = list(point)
                moved[axis] += h
                other, _ = self.term(self.q, trig, moved, i)
                change = mp.matrix([(u - v) / h for u, v in zip(other, g)])
                moves = inverse * change
                for j in range(len(self.q)):
                    sums[j] += moves[j]**2
        return [EPSILON * half * mp.sqrt(v) for v in sums]


# Name, class, shape, range of t, counts, form errors as parts of the size, offsets [m].
TRUTHS = [
    ("line", [], (-0.03, 0.05), 0.1),
    ("circle_5_degrees", [0.0525], (0.3, 0.3 + math.radians(5)), 1.0),
    ("circle_40_degrees", [25.0], (-1.0, -1.0 + math.radians(40)), 1.0),
    ("circle_360_degrees", [0.004], (0.0, 2 * math.pi), 1.0),
    ("ellipse_5_degrees", [0.065, 0.0525], (0.7, 0.7 + math.radians(5)), 1e-10),
    ("ellipse_20_degrees", [0.065, 0.0525], (0.7, 0.7 + math.radians(20)), 1e-7),
    ("ellipse_90_degrees", [0.065, 0.0525], (0.2, 0.2 + math.radians(90)), 0.03),
    ("ellipse_360_degrees", [0.025, 0.0175], (0.0, 2 * math.pi), 1.0),
    ("parabola", [0.0125], (-0.7, 1.4), 0.3),
    ("parabola_short", [0.0125], (0.5, 0.65), 3e-4),
    ("hyperbola", [0.02, 0.015], (-0.9, 1.3), 0.1),
    ("hyperbola_short", [0.02, 0.03], (0.2, 0.5), 1e-5),
    ("cubical_parabola", [300.0, 0.2], (-0.04, 0.05), 0.1),
    ("cubical_parabola_short", [-300.0, -0.1], (0.01, 0.03), 1e-3),
    ("semi_cubical_parabola", [6.0, 0.8], (-0.12, 0.2), 0.02),
    ("semi_cubical_parabola_arm", [6.0, -0.8], (0.08, 0.2), 1e-3),
    ("cubic_spline", [4.0, 0.5, -0.1], (-0.15, 0.2), 0.03),
    ("cubic_spline_short", [4.0, 0.5, 0.2], (0.02, 0.15), 1e-4),
]
# Points beyond those that the class needs, form error (of what the touched arc bears), offset [m].
SCENES = [(0, 0.0, 0.0), (5, 1e-4, 1e6), (14, 1e-2, 0.0), (40, 1e-3, 1e3)]
LARGE = {"circle_5_degrees", "ellipse_90_degrees", "hyperbola", "cubic_spline"}


def class_of(name):
    for known in ("cubic_spline", "cubical_parabola", "semi_cubical_parabola", "line", "circle",
                  "ellipse", "parabola", "hyperbola"):
        if name.startswith(known):
            return known
    raise KeyError(name)


def needed(name):
    return {"line": 2, "circle": 3, "parabola": 4, "cubic_spline": 6}.get(name, 5)


def scene(rng, truth, more, form, offset):
    name, shape, (low, high), bears = truth
    kind = class_of(name)
    count = more if more >= 400 else needed(kind) + more
    pose = (offset + rng.uniform(-0.1, 0.1), -offset / 3 + rng.uniform(-0.1, 0.1),
            rng.uniform(-1.5, 1.5))
    place = [low + (high - low) * (i + rng.uniform(0.1, 0.9)) / count for i in range(count)]
    rng.shuffle(place)
    c, s = math.cos(pose[2]), math.sin(pose[2])
    ends = [curve(kind, [mp.mpf(v) for v in shape], mp.mpf(t))[0] for t in (low, high)]
    chord = float(mp.hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]))
    size = max(chord, 1e-3) if bears < 1.0 or "360" not in name else shape[0]
    if name == "circle_5_degrees":
        form *= 0.1  # a sagitta is 1 % of such a chord
    points = []
    for t in place:
        at, first, _, _ = curve(kind, [mp.mpf(v) for v in shape], mp.mpf(t))
        speed = mp.hypot(*first)
        wave = math.sin(7.0 * (t - low) / (high - low) + 1.0) + rng.gauss(0.0, 0.5)
        d = form * bears * size * wave
        x = float(at[0] - d * first[1] / speed)
        y = float(at[1] + d * first[0] / speed)
        points.append((c * x - s * y + pose[0], s * x + c * y + pose[1]))
    return Problem(kind, shape, pose, points, place), points


def normalised(problem):
    """[shape; x; y; theta] in the program's conventions."""
    q = problem.q
    values = list(q[:problem.letters])
    if problem.name == "circle":
        values[0] = abs(values[0])  # the same circle, half a turn on
    x, y, theta = problem.pose(q)
    if problem.name == "line":
        c, s = mp.cos(theta), mp.sin(theta)
        along = c * (problem.mean[0] - x) + s * (problem.mean[1] - y)
        x, y = x + along * c, y + along * s
    return values + [x, y, theta]


def main():
    print("# Made by make_given.py: do not edit.")
    for truth in TRUTHS:
        scenes = SCENES + ([(500, 1e-2, 10.0)] if truth[0] in LARGE else [])
        for number, (more, form, offset) in enumerate(scenes):
            rng = random.Random(f"{truth[0]} {number}")
            problem, points = scene(rng, truth, more, form, offset)
            name = f"{truth[0]}_{len(points)}"
            try:
                squares, hessian = problem.solve()
                moves = problem.rounding(hessian)
            except (ArithmeticError, ValueError) as error:
                print(f"{name}: {error}: left out", file=sys.stderr)
                continue
            values = normalised(problem)
            if problem.name == "line":
                theta = values[2]
                moves = [moves[0] * abs(mp.sin(theta)) + 0, moves[0] * abs(mp.cos(theta)), moves[1]]
                moves = [max(m, EPSILON * abs(points[0][k])) if k < 2 else m
                         for k, m in enumerate(moves)]
            elif problem.name == "circle":
                moves = moves + [mp.mpf(0)]
            print(f"case {name} {problem.name} {len(points)}")
            print("value", *(mp.nstr(v, 25) for v in values))
            print("rounding", *(mp.nstr(m + EPSILON * abs(v), 6) for m, v in zip(moves, values)))
            print("squares", mp.nstr(squares, 25))
            for x, y in points:
                print(repr(x), repr(y))
            print(f"{name}: rms {math.sqrt(float(squares) / len(points)):.3g} m", file=sys.stderr)


if __name__ == "__main__":
    main()
