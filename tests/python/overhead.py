#!/usr/bin/env python3
"""What a call from Python costs above what C++ computes in it, in microseconds.

  PYTHONPATH=build/strict/node/python python3 tests/python/overhead.py
"""
import sys
import time

import numpy as np

import palpate

# Python's own speed: this takes so long on the machine of tests/README.md.
REFERENCE_US = 21.0


def least_us(call, times=300):
    """The least of many times, less what C++ took of it: whatever else the machine does only adds."""
    least = float("inf")
    for _ in range(times):
        start = time.perf_counter_ns()
        computed_s = call()
        least = min(least, (time.perf_counter_ns() - start) / 1e3 - 1e6 * computed_s)
    return least


def reference():
    numbers = {}
    for i in range(400):
        numbers[i % 7] = numbers.get(i % 5, 0) + i
    return 0.0


def stroke(n):
    t = np.linspace(0, 5.5, n)
    return 15 * np.column_stack([np.cos(t), np.sin(t)]) + np.random.default_rng(1).normal(0, 0.01, (n, 2))


def calls(call):
    """How many functions of Python and of C one call enters."""
    call()
    entered = 0

    def count(frame, event, function):
        nonlocal entered
        entered += event == "call" or event == "c_call"

    sys.setprofile(count)
    try:
        call()
    finally:
        sys.setprofile(None)
    return entered


def what_is_called():
    """Name of a call: a function that makes it and returns what C++ took of it in seconds."""
    points, few = stroke(100), stroke(100)[:10]
    recognizer = palpate.Recognizer(sigma=0.01, unit="mm", classes=["circle"])

    def fit():
        return palpate.fit(points, sigma=0.01, unit="mm", classes=["circle"]).compute_s

    def add():
        other.reset()
        other.add(few)
        return 0.0

    recognizer.add(points)
    recognizer.recognize()
    other = palpate.Recognizer(sigma=0.01, unit="mm", classes=["circle"])

    def recognize():
        return recognizer.recognize().compute_s

    return {"palpate.fit": fit, "Recognizer.recognize": recognize, "Recognizer.add": add}


if __name__ == "__main__":
    print(f"this machine's Python takes {least_us(reference) / REFERENCE_US:.2f} of the reference's time")
    for name, call in what_is_called().items():
        print(f"{name:22s} {least_us(call, 3000):6.1f} us above C++, {calls(call)} calls")
