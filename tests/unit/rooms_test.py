#!/usr/bin/env python3
"""The rooms of the house: who may include whom. An include against the order is an error, and so is a circle
of headers within a room, or a room that is in nobody's list."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Each room may include itself, the rooms before it in its list, and those of the lists named in brackets.
CORE = [
    "core/numerics/matrices", "core/numerics/polynomials", "core/numerics/probability", "core/numerics",
    "core/curves", "core/curves/algebraic", "core/local", "core/local/spikes", "core/local/stream", "core/invariants",
    "core/invariants/signature_fit", "core/recognition/samples", "core/recognition/samples/cleaned",
    "core/recognition/samples/tips", "core/recognition/smooth", "core/recognition/fit/orthogonal",
    "core/recognition/fit/starts", "core/recognition/fit", "core/recognition/touches",
    "core/recognition/given/placed", "core/recognition/given/starts", "core/recognition/given",
    "core/recognition/prior", "core/recognition/modes", "core/recognition/posterior", "core/recognition/coherent",
    "core/recognition/weigh", "core/recognition/verdict", "core/recognition/tree", "core/recognition/counted",
    "core/recognition", "core/part", "core/qualification",
]
NODE = CORE + [
    "node/files", "node/process", "node/wire", "node/csv", "node/check", "node/intake", "node/python", "node/client",
    "node/security",
    "node/groups", "node/publish", "node", "node/gateway/plant", "node/gateway/place", "node/gateway",
    "node/tool", "node/tool/text", "node/tool/drawing", "node/tool/drawing/svg", "node/tool/view",
    "node/tool/commands", "node/tool/commands/check", "node/tool/commands/offline", "node/tool/commands/live",
    "node/tool/main",
]
SIM = CORE + ["node/files", "node/process", "node/wire", "node/csv", "node/intake", "node/client", "sim"]
# What one program is made of is no part of another.
APART = [("node/tool", "node/groups"), ("node/tool", "node/publish"), ("node/tool", "node/gateway"),
         ("node/gateway", "node/groups"), ("node/gateway", "node/publish")]


def room_of(path):
    return path.rpartition("/")[0] if path != "node/tool/main.cpp" else "node/tool/main"


def main():
    errors = []
    includes = {}
    for top, order in (("core", CORE), ("node", NODE), ("sim", SIM)):
        for file in sorted((ROOT / top).rglob("*")):
            path = file.relative_to(ROOT).as_posix()
            if file.suffix not in (".h", ".cpp") or path.startswith("node/examples/"):
                continue
            room = room_of(path)
            if room not in order:
                errors.append(f"{path}: a room that {pathlib.Path(__file__).name} does not know")
                continue
            named = re.findall(r'^#include "((?:core|node|sim)/[^"]+)"', file.read_text(), re.MULTILINE)
            includes[path] = named
            for other in named:
                if not (ROOT / other).is_file():
                    errors.append(f"{path}: there is no {other}")
                elif room_of(other) not in order[:order.index(room) + 1]:
                    errors.append(f"{path} includes {other}: against the order of the rooms")
                elif any(room.startswith(a) and other.startswith(b + "/") for a, b in APART):
                    errors.append(f"{path} includes {other}, a part of another program")
    state = {}

    def walk(path, way):
        if state.get(path) == "left":
            return
        if path in way:
            errors.append("a circle: " + " -> ".join(way[way.index(path):] + [path]))
            return
        for other in includes.get(path, []):
            if other.endswith(".h"):
                walk(other, way + [path])
        state[path] = "left"

    for path in includes:
        if path.endswith(".h"):
            walk(path, [])
    print("\n".join(errors) or f"{len(includes)} files, every include along the order of the rooms")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
