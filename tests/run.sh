#!/usr/bin/env bash
# Installs what is missing (Debian), builds everything and runs every test.
#
#   tests/run.sh              warnings as errors, all tests
#   tests/run.sh --sanitize   the same again under the address and undefined behaviour sanitizers
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

sanitize=no
for argument in "$@"; do
  case "$argument" in
    --sanitize) sanitize=yes ;;
    -h|--help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "tests/run.sh: unknown argument '$argument' (try --help)" >&2; exit 2 ;;
  esac
done

step() { printf '\n== %s\n' "$*"; }

packages=(g++ cmake ninja-build pkg-config libeigen3-dev libceres-dev libgtest-dev libgmock-dev
          libbenchmark-dev protobuf-compiler libprotobuf-dev libzmq3-dev cppzmq-dev libspdlog-dev
          libcli11-dev python3 python3-protobuf python3-zmq)
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
run_preset() {
  step "building ($1)"
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1" -j "$jobs"
  step "testing ($1)"
  ctest --test-dir "build/$1" --output-on-failure -j "$jobs"
}

run_preset strict
if [ "$sanitize" = yes ]; then
  export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
  run_preset asan
fi
step "all tests passed"
