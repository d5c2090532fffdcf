#!/usr/bin/env bash
# Instructions per call of each piece of the library, counted by valgrind: a busy machine changes nothing.
#
#   tests/bench/kernels/compare.sh                 the working tree: CSV of kernel, calls, instructions
#   tests/bench/kernels/compare.sh BASE_COMMIT     beside another commit's, with the ratio to it
#     --only REGEX    kernels whose name matches, e.g. '^recognition/cold' ('kernels --list' lists all)
#     --jobs N        builds and counts N at a time (default: all cores)
#
# The CSV goes to standard output, all else to standard error. The ratio is the working tree's over the base
# commit's: under 1 is fewer instructions than there. The same kernels.cpp and tests/support are built
# against both (Release, same flags), so data are equal; a base whose interfaces differ from what
# they use does not compile, and is said so. It is checked out as a git worktree in build/kernels/base, which
# 'git worktree remove --force build/kernels/base' takes away again. Preparing data is not counted,
# allocation within a call is. Repeated counts agree to 1e-5. Instructions are not time: cache misses, mispredicted
# branches and divisions cost more than one. Needs valgrind; installs nothing.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../../.."

base='' only=. jobs=$(nproc)
fail() { echo "tests/bench/kernels/compare.sh: $1" >&2; exit "${2:-1}"; }
while [ $# -gt 0 ]; do
  case "$1" in
    --only) [ $# -gt 1 ] || fail "--only needs a regular expression" 2; only=$2; shift ;;
    --jobs) [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail "--jobs needs a whole number of at least 1" 2; jobs=$2; shift ;;
    -h|--help) sed -n '2,16s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) fail "unknown argument '$1' (try --help)" 2 ;;
    *) [ -z "$base" ] || fail "one BASE_COMMIT only (try --help)" 2; base=$1 ;;
  esac
  shift
done
for program in valgrind cmake ninja git; do
  command -v $program >/dev/null || fail "$program is missing (Debian: apt-get install ${program/#ninja/ninja-build})"
done

work=build/kernels
mkdir -p $work
if [ -n "$base" ]; then
  given=$base
  base=$(git rev-parse --verify --quiet "$given^{commit}") || fail "no such commit: $given" 2
  step_base="base $(git log -1 --format='%h %s' "$base")"
fi

build() {  # title, source folder, build folder; leaves kernels in it
  echo "== building: $1" >&2
  cmake -S "$2" -B "$3" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPALPATE_BUILD_NODE=OFF -DPALPATE_BUILD_SIM=OFF \
    -DPALPATE_BUILD_TESTS=ON >"$3.log" 2>&1 && cmake --build "$3" --target kernels -j "$jobs" >>"$3.log" 2>&1 || {
    grep -E 'error|Error' "$3.log" | head -20 >&2
    fail "$1 does not build with this kernels.cpp: see $3.log"
  }
}
build "the working tree" . $work/head
if [ -n "$base" ]; then
  if [ -e $work/base/.git ]; then
    git -C $work/base checkout --quiet --force --detach "$base"
    git -C $work/base clean --quiet --force -d
  else
    git worktree add --quiet --force --detach $work/base "$base"
  fi
  rm -rf $work/base/tests/support $work/base/tests/bench/kernels
  mkdir -p $work/base/tests/bench
  cp -Rp tests/support $work/base/tests/support
  cp -Rp tests/bench/kernels $work/base/tests/bench/kernels
  printf '%s\n' 'find_package(GTest REQUIRED)' 'add_subdirectory(support)' 'add_subdirectory(bench/kernels)' \
    >$work/base/tests/CMakeLists.txt
  build "$step_base" $work/base $work/base-build
fi

# count PROGRAM FOLDER "NAME CALLS": writes the instructions of all calls to FOLDER/NAME (slashes as dots)
count() {
  local name=${3% *} calls=${3##* }
  local file=$2/${name//\//.}
  valgrind --tool=callgrind --toggle-collect=palpate_kernel_call --callgrind-out-file="$file.callgrind" \
    "$1" "$name" "$calls" >"$file.log" 2>&1 || { echo "$name failed: see $file.log" >&2; return 1; }
  sed -n 's/^totals: *//p' "$file.callgrind" >"$file"
  [ -s "$file" ] || { echo "$name: no count in $file.callgrind" >&2; return 1; }
}
export -f count

kernels=$(find $work/head -type f -name kernels -perm -u+x)
chosen=$("$kernels" --list | awk -v only="$only" '$1 == "empty" || $1 ~ only')
[ "$(wc -l <<<"$chosen")" -gt 1 ] || fail "no kernel matches '$only'" 2
sides=(head ${base:+base})
for side in "${sides[@]}"; do
  folder=$work/count-$side
  program=$kernels
  [ $side = head ] || program=$(find $work/base-build -type f -name kernels -perm -u+x)
  rm -rf $folder
  mkdir -p $folder
  echo "== counting: $side, $(wc -l <<<"$chosen") kernels" >&2
  tr '\n' '\0' <<<"$chosen" | xargs -0 -P "$jobs" -I{} bash -c 'count "$@"' count "$program" $folder {} ||
    fail "not every kernel was counted"
done

echo "kernel,calls,instructions_per_call${base:+,base_instructions_per_call,ratio}"
while read -r name calls; do
  [ "$name" != empty ] || continue
  for side in "${sides[@]}"; do
    echo "$name $calls $(cat "$work/count-$side/empty") $(cat "$work/count-$side/${name//\//.}")"
  done
done <<<"$chosen" | awk -v sides=${#sides[@]} '
  {
    each = $4 / $2 - $3  # the cost of calling a kernel at all is taken off
    if (NR % sides == 1 || sides == 1) {
      printf "%s,%d,%.1f", $1, $2, each
      head = each
    }
    if (sides == 2 && NR % 2 == 0) {
      printf ",%.1f,%.4f", each, head / each
      logs += log(head / each)
      rows++
    }
    if (NR % sides == 0) printf "\n"
  }
  END { if (rows) printf "geometric mean of the ratios: %.4f\n", exp(logs / rows) >"/dev/stderr" }'
