#!/usr/bin/env bash
# Speed against error, compared with the paper, other programs and the theoretical limits: one command, one report.
#
#   tests/bench/run.sh            everything, about half an hour on two cores
#   tests/bench/run.sh --quick    fewer scenes, under five minutes after the build
#   tests/bench/run.sh --keep     also copies the summary and its plots to tests/bench/report/latest/, for the repository
#
# Installs what is missing (Debian), builds Release (preset strict), writes build/report/report.md with its plots (SVG and PNG)
# and a CSV of every figure. Programs that cannot be installed are skipped, with a message. Run nothing else meanwhile:
# times are medians, but other work still disturbs them.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

scale=full
keep=no
while [ $# -gt 0 ]; do
  case "$1" in
    --quick) scale=quick ;;
    --keep) keep=yes ;;
    -h|--help) sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "tests/bench/run.sh: unknown argument '$1' (try --help)" >&2; exit 2 ;;
  esac
  shift
done

source tests/support/install.sh
install g++ cmake ninja-build pkg-config libeigen3-dev libceres-dev libgtest-dev libgmock-dev libbenchmark-dev \
  protobuf-compiler libprotobuf-dev libzmq3-dev cppzmq-dev libspdlog-dev libcli11-dev zlib1g-dev python3 python3-protobuf \
  python3-zmq python3-matplotlib python3-numpy
for peer in python3-opencv python3-scipy; do
  install "$peer" || echo "$peer cannot be installed: its peers are skipped"
done

step "building (strict: Release)"
cmake --preset strict -DPALPATE_BUILD_BENCHMARKS=ON >/dev/null
cmake --build --preset strict -j "$(nproc)"
bench=build/strict/tests/bench
out=build/report
rm -rf "$out"
mkdir -p "$out"

if [ $scale = quick ]; then
  pareto=6 sweeps=10 calibration=4 rounds=1000 load=1 least_time=0.05 peers=4 strokes=3 posterior=150 worst=20 view=4
else
  pareto=40 sweeps=100 calibration=40 rounds=10000 load=5 least_time=0.5 peers=40 strokes=10 posterior=600 worst=120 view=20
fi
measure() {  # title, file, command...
  local title=$1 file=$2
  shift 2
  step "$title"
  "$@" >"$out/$file"
}
measure "latency beside a bare relay" latency.csv "$bench/processes/bench_latency" --rounds $rounds
measure "load, probes, two nodes" load.csv "$bench/processes/bench_load" --seconds $load
# In headless Chromium where it is installed; beyond its bounds it says so and the report goes on.
export PALPATE_SOURCE=$PWD PALPATE_BUILD=$PWD/build/strict
PYTHONPATH=tests/support:tests/view:build/strict/proto/python measure "the live picture" view.csv \
  /usr/bin/python3 tests/view/bench_view.py --turns $view || echo "the live picture: see above what is not as it should be"
measure "time of a recognition" recognition.csv "$bench/core/bench_recognition" --benchmark_format=csv \
  --benchmark_min_time=$least_time
measure "time of the local estimators" local.csv "$bench/core/bench_local" --benchmark_format=csv \
  --benchmark_min_time=$least_time
measure "speed against error" pareto.csv "$bench/accuracy/bench_pareto" --scenes $pareto
measure "hard cases" sweeps.csv "$bench/accuracy/bench_sweeps" --scenes $sweeps
measure "noise honesty" calibration.csv "$bench/accuracy/bench_calibration" --scenes $calibration
measure "certainty, calibration and time on scenes of a stated prior" posterior.txt \
  "$bench/accuracy/bench_posterior" --scenes $posterior
measure "the same where scenes come from another prior" posterior_other.txt "$bench/accuracy/bench_posterior" \
  --scenes $posterior --other-prior
measure "what makes a recognition dearer" factors.txt "$bench/worst_case/bench_factors" --scenes $posterior
measure "what habits of a probe do to answers" habits.txt "$bench/worst_case/bench_habits" --scenes $posterior
measure "inputs found to cost the most" hostile.txt "$bench/worst_case/bench_worst_case" tests/data/hostile/*.csv
measure "search for the worst case" worst_case.txt "$bench/worst_case/bench_worst_case" --seconds $worst \
  --save "$out/worst_case.csv"
measure "the sliding window beside the best window in hindsight" hindsight.md "$bench/accuracy/bench_hindsight" \
  --strokes $strokes
measure "the paper's tables" paper.md build/strict/tests/paper/paper_tables
PYTHONPATH=tests/support:build/strict/proto/python measure "the paper's tables by the whole pipeline" pipeline.md \
  /usr/bin/python3 tests/paper/pipeline_tables.py
measure "signature curves" signatures.csv "$bench/accuracy/bench_signatures"
measure "real recordings" real.md "$bench/real/bench_real"
step "peers on the same points"
"$bench/peers/peer_scenes" "$out" --scenes $peers
/usr/bin/python3 tests/bench/peers/peers.py "$out" >"$out/peers.md"
/usr/bin/python3 tests/bench/peers/given_class.py build/strict/node/tool/palpate >"$out/given_class.md" ||
  echo "a class that is given: no peers (python3-scipy)"
measure "a class that is given, against 50 digits" given_reference.md /usr/bin/python3 \
  tests/bench/peers/given_reference.py build/strict/node/tool/palpate
measure "touches one at a time beside an exhaustive reference" touches.txt "$bench/accuracy/bench_touches" --reference \
  --scenes $peers

step "report"
/usr/bin/python3 tests/bench/report/report.py "$out" --scale $scale
echo "written: $out/report.md"
if [ $keep = yes ]; then
  mkdir -p tests/bench/report/latest
  cp "$out"/summary.md "$out"/{pareto,hard_cases,calibration}.svg tests/bench/report/latest/
  echo "kept: tests/bench/report/latest/summary.md"
fi
