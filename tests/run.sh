#!/usr/bin/env bash
# Installs what is missing (Debian), builds all but the benchmarks and runs every test.
#
#   tests/run.sh                  warnings as errors, all tests
#   tests/run.sh --sanitize       besides: under the address, undefined and thread sanitizers (needs clang)
#   tests/run.sh --tidy           besides: clang-tidy over the sources, before all else
#   tests/run.sh --fuzz SECONDS   besides: each fuzz target for so long (needs clang)
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

sanitize=no
tidy=no
fuzz=0
while [ $# -gt 0 ]; do
  case "$1" in
    --sanitize) sanitize=yes ;;
    --tidy) tidy=yes ;;
    --fuzz) fuzz=${2:?"tests/run.sh: --fuzz needs a number of seconds"}; shift ;;
    -h|--help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "tests/run.sh: unknown argument '$1' (try --help)" >&2; exit 2 ;;
  esac
  shift
done

source tests/support/install.sh

# Parts of the run, each with the seconds it may take on the machine of tests/README.md: 40 minutes in all.
budgets=()
part=''
end_part() {
  [ -n "$part" ] || return 0
  local line
  line=$(printf '%-44s %5d s of %d s' "$part" $((SECONDS - part_start)) "$part_budget")
  printf '\n== budget: %s\n' "$line"
  budgets+=("$line")
  part=''
}
begin_part() {  # name, seconds
  end_part
  part=$1 part_budget=$2 part_start=$SECONDS
  step "$part"
}

packages=(g++ cmake ninja-build pkg-config libeigen3-dev libceres-dev libgtest-dev libgmock-dev
          libbenchmark-dev protobuf-compiler libprotobuf-dev libzmq3-dev cppzmq-dev libspdlog-dev
          libcli11-dev libboost-dev nlohmann-json3-dev zlib1g-dev libdxflib-dev python3 python3-protobuf python3-zmq
          python3-ezdxf python3-numpy git pybind11-dev python3-dev clang-format chromium chromium-driver
          doxygen dpkg-dev file iproute2 libnats-dev lintian make man-db nats-server openssl python3-cryptography
          python3-distributed python3-pip python3-setuptools python3-wheel strace systemd zsh)
if [ "$sanitize" = yes ] || [ "$fuzz" != 0 ]; then packages+=(clang); fi
if [ "$tidy" = yes ]; then packages+=(clang clang-tidy); fi
install "${packages[@]}"

jobs=$(nproc)
build() {  # preset, targets...
  local preset=$1
  shift
  # Benchmarks are no tests: tests/bench/run.sh builds them.
  cmake --preset "$preset" -DPALPATE_BUILD_BENCHMARKS=OFF >/dev/null
  cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"}
}

source tests/support/how_long.sh
calibrate
cost=$((strict_build_cost + strict_test_cost))
if [ "$sanitize" = yes ]; then cost=$((cost + sanitize_cost)); fi
if [ "$tidy" = yes ]; then cost=$((cost + tidy_cost)); fi
if [ "$fuzz" != 0 ]; then cost=$((cost + fuzz_cost)); fi
step "about $(how_long $cost) on this machine, $(nproc) cores$(
  command -v ccache >/dev/null && echo '; less where ccache has the objects')"

if [ "$tidy" = yes ]; then
  begin_part "clang-tidy" 300
  tests/support/tidy.py
fi

begin_part "building (strict)" 420
build strict
begin_part "testing (strict)" 420
# One more at a time than cores: tests of processes wait for most of theirs.
ctest --test-dir build/strict --output-on-failure -j $((jobs + 1))

if [ "$sanitize" = yes ]; then
  export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
  begin_part "building (address and undefined behaviour)" 480
  build asan tests_core tests_recognition
  begin_part "testing (address and undefined behaviour)" 240
  # The processes' own tests measure time; their twin in one process is among the others. The statistics were
  # taken above: here a thirtieth of their scenes runs the same code.
  PALPATE_TEST_STRESS=0.03 \
    ctest --test-dir build/asan --output-on-failure -j "$jobs" -L 'core|recognition'
  begin_part "building (thread)" 150
  build tsan twin_test
  begin_part "testing (thread)" 60
  # libzmq is not instrumented: its hand-over between threads looks like a race.
  TSAN_OPTIONS="suppressions=$PWD/tests/processes/tsan.supp" \
    ctest --test-dir build/tsan --output-on-failure -R '^twin_test$'
fi

if [ "$fuzz" != 0 ]; then
  targets=(answers config contact_csv http_border ingest keys part plant probe recording scene)
  begin_part "building (fuzz)" 60
  build asan "${targets[@]/#/fuzz_}"
  mkdir -p build/fuzz
  # Some inputs a second under sanitizers: it tells something in minutes only.
  if [ "$fuzz" -ge 120 ]; then
    build fuzz fuzz_recognizer
    targets+=(recognizer)
  fi
  begin_part "fuzzing" $(((${#targets[@]} + jobs - 1) / jobs * (fuzz + 10)))
  fuzz_one() {  # target, seconds
    local program=build/asan/tests/fuzz/fuzz_$1
    [ "$1" != recognizer ] || program=build/fuzz/tests/fuzz/fuzz_recognizer
    mkdir -p "build/fuzz/corpus/$1"
    if "$program" -max_total_time="$2" -max_len=4096 -print_final_stats=1 \
      -artifact_prefix="build/fuzz/$1-" "build/fuzz/corpus/$1" "tests/fuzz/corpus/$1" >"build/fuzz/$1.log" 2>&1; then
      printf 'fuzz_%s: %s\n' "$1" "$(grep 'number_of_executed_units' "build/fuzz/$1.log")"
    else
      tail -n 100 "build/fuzz/$1.log" >&2
      printf 'tests/run.sh: fuzz_%s found something: build/fuzz/%s.log\n' "$1" "$1" >&2
      return 1
    fi
  }
  export -f fuzz_one
  printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I {} bash -c "fuzz_one {} $fuzz"
fi
end_part
step "all tests passed"
printf '%s\n' "${budgets[@]}"
