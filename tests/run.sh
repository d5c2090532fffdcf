#!/usr/bin/env bash
# Installs what is missing (Debian), builds everything and runs every test.
#
#   tests/run.sh                  warnings as errors, all tests
#   tests/run.sh --sanitize       besides: under the address, undefined and thread sanitizers
#   tests/run.sh --fuzz SECONDS   besides: each fuzz target for so long (needs clang)
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

sanitize=no
fuzz=0
while [ $# -gt 0 ]; do
  case "$1" in
    --sanitize) sanitize=yes ;;
    --fuzz) fuzz=${2:?"tests/run.sh: --fuzz needs a number of seconds"}; shift ;;
    -h|--help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "tests/run.sh: unknown argument '$1' (try --help)" >&2; exit 2 ;;
  esac
  shift
done

step() { printf '\n== %s\n' "$*"; }

packages=(g++ cmake ninja-build pkg-config libeigen3-dev libceres-dev libgtest-dev libgmock-dev
          libbenchmark-dev protobuf-compiler libprotobuf-dev libzmq3-dev cppzmq-dev libspdlog-dev
          libcli11-dev libboost-dev nlohmann-json3-dev python3 python3-protobuf python3-zmq
          chromium chromium-driver)
if [ "$fuzz" != 0 ]; then packages+=(clang); fi
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
    missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  step "installing: ${missing[*]}"
  as_root=()
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    "${missing[@]}" >/dev/null
fi

jobs=$(nproc)
build() {  # preset, targets...
  local preset=$1
  shift
  step "building ($preset)"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"}
}

build strict
step "testing (strict)"
ctest --test-dir build/strict --output-on-failure -j "$jobs"

if [ "$sanitize" = yes ]; then
  export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
  build asan
  step "testing (address and undefined behaviour sanitizers)"
  # The processes' own tests measure time; their twin in one process is among the others. The long
  # statistics were taken above: laws, units and hard cases run the same code.
  GTEST_FILTER='-SegmentMatchStatistics.*:LongestSegmentStatistics.*:JointCovariance*:FormDeviation.*' ctest --test-dir build/asan --output-on-failure -j "$jobs" -LE processes -E '^view_(page|hostile)_test$'
  build tsan twin_test
  step "testing (thread sanitizer)"
  # libzmq is not instrumented: its hand-over between threads looks like a race.
  TSAN_OPTIONS="suppressions=$PWD/tests/processes/tsan.supp" \
    ctest --test-dir build/tsan --output-on-failure -R '^twin_test$'
fi

if [ "$fuzz" != 0 ]; then
  targets=(contact_csv http_border ingest recording)
  build fuzz "${targets[@]/#/fuzz_}"
  for target in "${targets[@]}"; do
    step "fuzzing $target for $fuzz s"
    mkdir -p "build/fuzz/corpus/$target"
    "build/fuzz/tests/fuzz/fuzz_$target" -max_total_time="$fuzz" -max_len=4096 -print_final_stats=1 \
      -artifact_prefix="build/fuzz/$target-" "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target"
  done
fi
step "all tests passed"
