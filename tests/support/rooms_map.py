#!/usr/bin/env python3
"""The rooms of the house as one picture, an SVG on standard output: boxes are rooms, in the order of
tests/unit/rooms_test.py; a room may include what is above it. Lines are the includes that there are, but for
those that lead over another room anyway.

usage: tests/support/rooms_map.py > tests/rooms.svg
       tests/support/rooms_map.py --check     ends with 1 where that file is another picture"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/unit"))
from rooms_test import NODE, SIM, room_of  # noqa: E402

BOX_WIDTH, BOX_HEIGHT, GAP_X, GAP_Y, MARGIN = 204, 30, 18, 44, 20
COLOURS = {"core": "#dbe9f6", "node": "#e2f0d9", "sim": "#fbe5d6"}


def includes():
    """Returns {room: rooms that it includes}."""
    found = {room: set() for room in dict.fromkeys(NODE + SIM)}
    for top in ("core", "node", "sim"):
        for file in sorted((ROOT / top).rglob("*")):
            path = file.relative_to(ROOT).as_posix()
            if file.suffix in (".h", ".cpp") and not path.startswith("node/examples/"):
                named = re.findall(r'^#include "((?:core|node|sim)/[^"]+)"', file.read_text(), re.MULTILINE)
                found[room_of(path)] |= {room_of(other) for other in named} - {room_of(path)}
    return found


def reach(room, edges):
    """All rooms that can be reached from a room."""
    waiting, seen = list(edges[room]), set()
    while waiting:
        other = waiting.pop()
        if other not in seen:
            seen.add(other)
            waiting += edges[other]
    return seen


def reduced(edges):
    """Without edges whose target is also reached through another room."""
    return {room: sorted(other for other in others
                         if not any(other in reach(between, edges) for between in others - {other}))
            for room, others in edges.items()}


def rows_of(edges):
    """Puts each room into the row below the lowest room that it includes."""
    level = {}
    for room in edges:  # in an order in which what is included stands first
        level[room] = 1 + max((level[other] for other in edges[room]), default=-1)
    rows = [[] for _ in range(1 + max(level.values()))]
    for room in edges:
        rows[level[room]].append(room)
    return rows


def svg():
    edges = includes()
    rows = rows_of(edges)
    width = 2 * MARGIN + max(len(row) for row in rows) * (BOX_WIDTH + GAP_X) - GAP_X
    height = 2 * MARGIN + len(rows) * (BOX_HEIGHT + GAP_Y) - GAP_Y
    place = {}
    for number, row in enumerate(rows):
        left = (width - len(row) * (BOX_WIDTH + GAP_X) + GAP_X) / 2
        for column, room in enumerate(row):
            place[room] = (left + column * (BOX_WIDTH + GAP_X), MARGIN + number * (BOX_HEIGHT + GAP_Y))
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
             f'font-size="13">',
             "<title>Rooms and what they include: a room includes what is above it</title>",
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for room, others in reduced(edges).items():
        x, y = place[room]
        for other in others:
            to_x, to_y = place[other]
            start, end = x + BOX_WIDTH / 2, to_x + BOX_WIDTH / 2
            below = to_y + BOX_HEIGHT
            lines.append(f'<path d="M{start:g} {y:g}C{start:g} {y - GAP_Y:g} {end:g} {below + GAP_Y:g} {end:g} {below:g}" '
                         f'fill="none" stroke="#888"/>')
    for room, (x, y) in place.items():
        lines.append(f'<rect x="{x:g}" y="{y:g}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="5" '
                     f'fill="{COLOURS[room.split("/")[0]]}" stroke="#555"/>')
        lines.append(f'<text x="{x + BOX_WIDTH / 2:g}" y="{y + BOX_HEIGHT / 2 + 5:g}" text-anchor="middle">{room}</text>')
    return "\n".join(lines + ["</svg>", ""])


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        is_current = (ROOT / "tests/rooms.svg").read_text() == svg()
        print("current" if is_current else "tests/rooms.svg is not current: tests/support/rooms_map.py > tests/rooms.svg")
        sys.exit(0 if is_current else 1)
    sys.stdout.write(svg())
