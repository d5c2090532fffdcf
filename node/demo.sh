#!/usr/bin/env bash
# Shows the whole system: simulator, recognizer node, a planner's watch and a live picture for the browser as
# four processes on loopback, scene after scene against its truth, then a real recording against its design.
# Installs what is missing (Debian) and builds Release first; ends by itself about a minute after the build.
#
#   node/demo.sh             with the live picture on http://127.0.0.1:8090
#   node/demo.sh --no-view   without
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

view=yes
for argument in "$@"; do
  case "$argument" in
    --no-view) view=no ;;
    -h|--help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "node/demo.sh: unknown argument '$argument' (try --help)" >&2; exit 2 ;;
  esac
done

source tests/support/install.sh
source tests/support/how_long.sh

install g++ cmake ninja-build pkg-config libeigen3-dev libceres-dev protobuf-compiler libprotobuf-dev \
  libzmq3-dev cppzmq-dev libspdlog-dev libcli11-dev libboost-dev nlohmann-json3-dev zlib1g-dev libdxflib-dev python3
calibrate
step "building (release): about $(how_long $demo_build_cost) on this machine, $(nproc) cores$(
  command -v ccache >/dev/null && echo '; less where ccache has the objects')"
cmake --preset release -DPALPATE_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release -j "$(nproc)" --target palpate palpate-node palpate-sim
palpate=build/release/node/tool/palpate

out=build/demo
mkdir -p "$out"
bus=$(mktemp -d)
contacts=ipc://$bus/contacts
results=ipc://$bus/results
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -rf "$bus"' EXIT

step "starting the recognizer (palpate-node) and a planner (palpate watch)"
build/release/node/palpate-node --contacts "$contacts" --results "$results" --log-level warning &
"$palpate" watch --results "$results" --interval 0.5 | sed -u 's/^/   watch | /' &
if [ "$view" = yes ]; then
  step "the live picture (palpate view): open its address in a browser; it stays while the scenes play"
  # Where its port is taken, the rest is shown all the same.
  "$palpate" view --results "$results" 2>&1 | sed -u 's/^/    view | /' &
fi
sleep 0.5

truth() {  # of a file that palpate-sim --truth wrote
  python3 - "$1" <<'EOF'
import json, math, sys
for line in open(sys.argv[1]):
    truth = json.loads(line)
    name = truth["curve_class"].removeprefix("CURVE_CLASS_").lower().replace("_", " ")
    sizes = "".join(f", {k} {v:.6g}" for k, v in truth.get("parameters", {}).items())
    pose = truth.get("pose")
    place = (f", x {1e3 * pose['x_m']:.3f} mm, y {1e3 * pose['y_m']:.3f} mm, "
             f"theta {math.degrees(pose['theta_rad']):.2f} deg") if pose and sizes else ""
    print(f"   TRUTH | {truth['group']}: {name}{sizes}{place}")
EOF
}

for scene in circle ellipse hyperbola semi_cubical_parabola cubic_spline two_finger_grasp unknown hard; do
  step "palpate-sim plays sim/scenes/$scene.textproto: $(sed -n 's/^description: "\(.*\)"$/\1/p' "sim/scenes/$scene.textproto")"
  build/release/sim/palpate-sim "sim/scenes/$scene.textproto" --contacts "$contacts" --quiet \
    --truth "$out/$scene.json"
  sleep 1.2
  truth "$out/$scene.json"
done

step "palpate replay plays a real recording: an X-ray mirror, height profile by slope metrology (DABAM 020, MIT)"
"$palpate" replay tests/data/real/dabam/dabam-020.csv --contacts "$contacts" --rate 500
sleep 1.5
echo "  DESIGN | ellipse, a (p + q)/2 = 4.675 m, b sqrt(p q) sin theta = 0.0774 m; what it deviates by is figure
         | error, correlated along the mirror: the answer stays ambiguous, and says why"

step "palpate fit draws a scene without any network"
build/release/sim/palpate-sim sim/scenes/hard.textproto --csv "$out/hard.csv"
"$palpate" fit "$out/hard.csv" --format text --plot "$out/hard.svg" | head -9
step "done: the picture is $out/hard.svg"
