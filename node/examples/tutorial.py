#!/usr/bin/env python3
"""palpate in Python, step by step. Every step prints its result.

  PYTHONPATH=build/strict/node/python python3 node/examples/tutorial.py [--plot FILE.png | --no-plot]
"""
import argparse

import numpy as np

import palpate

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--plot", help="file of the picture (needs matplotlib); else a window")
parser.add_argument("--no-plot", action="store_true")
options = parser.parse_args()
rng = np.random.default_rng(1)
sigma = 0.02  # noise of the probe [mm]


def stroke(start, end, n=111):
    """Points of a probe along an ellipse with half axes of 25 mm and 17.5 mm, in millimetres."""
    t = np.linspace(start, end, n)
    return np.column_stack([25 * np.cos(t), 17.5 * np.sin(t)]) + rng.normal(0, sigma, (n, 2))


print("1. Two strokes on a part. Its class, its shape, its pose:")
strokes = [stroke(0.3, 1.5), stroke(2.3, 3.6)]
result = palpate.fit(strokes, sigma=sigma, unit="mm")
print("  ", result)

print("2. How well is each known? One standard deviation:")
for name, deviation in result.std.items():
    print(f"   {name}: {deviation:.2g}")

print("3. How far from the curve do the points lie?")
residuals = result.residuals(np.concatenate(strokes))
print(f"   rms {residuals.std():.4f} mm, the probe's noise is {sigma} mm")

print("4. A short stroke cannot tell, and says so:")
short = palpate.fit(stroke(0.3, 0.5), sigma=sigma, unit="mm")
print("  ", short)
for curve_class, probability in short.probabilities.items():
    if probability > 0.01:
        print(f"   {curve_class}: {probability:.2f}")

print("5. As the points come in:")
recognizer = palpate.Recognizer(sigma=sigma, unit="mm")
for number, points in enumerate(strokes):
    for some in np.array_split(points, 4):
        recognizer.add(some, patch=number)
        answer = recognizer.recognize()
        print(f"   {answer.sample_count:4d} points: {answer.curve_class} ({answer.status})")

if not options.no_plot:
    axes = result.plot()
    if options.plot:
        axes.figure.savefig(options.plot)
    else:
        import matplotlib.pyplot as plt
        plt.show()
