#!/usr/bin/env bash
# Instructions per call of each piece of the library, counted by valgrind. A busy machine does not change them.
#
#   tests/bench/compare.sh             the working tree: CSV of kernel, calls, instructions
#   tests/bench/compare.sh OLD         also those of the commit OLD, and the ratio to them
#   tests/bench/compare.sh OLD NEW     the commit NEW in place of the working tree
#     --only REGEX    kernels whose name matches, e.g. '^recognition/cold' ('kernels --list' lists all)
#     --jobs N        builds and counts N at a time (default: all cores)
#
# The CSV goes to standard output, everything else to standard error. A ratio below 1 means fewer instructions than in
# OLD. Both are built with the working tree's kernels.cpp and tests/support (Release, same flags), so the data are
# equal; a commit with other interfaces does not compile, and the script says so. Commits are checked out as git
# worktrees in build/kernels/{old,new}; remove them with 'git worktree remove --force'. Preparing data is not counted;
# allocation within a call is. Repeated counts agree to 1e-5. Instructions are not time: cache misses, mispredicted
# branches and divisions cost more than one. Needs valgrind; installs nothing.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

old='' new='' only=. jobs=$(nproc)
fail() { echo "tests/bench/compare.sh: $1" >&2; exit "${2:-1}"; }
while [ $# -gt 0 ]; do
  case "$1" in
    --only) [ $# -gt 1 ] || fail "--only needs a regular expression" 2; only=$2; shift ;;
    --jobs) [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail "--jobs needs a whole number of at least 1" 2; jobs=$2; shift ;;
    -h|--help) sed -n '2,18s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) fail "unknown argument '$1' (try --help)" 2 ;;
    *)
      [ -z "$new" ] || fail "two commits at most (try --help)" 2
      if [ -z "$old" ]; then old=$1; else new=$1; fi ;;
  esac
  shift
done
for program in valgrind cmake ninja git; do
  command -v $program >/dev/null || fail "$program is missing (Debian: apt-get install ${program/#ninja/ninja-build})"
done

work=build/kernels
mkdir -p $work
commit() {  # the full name of a commit
  git rev-parse --verify --quiet "$1^{commit}" || fail "no such commit: $1" 2
}
if [ -n "$old" ]; then old=$(commit "$old"); fi
if [ -n "$new" ]; then new=$(commit "$new"); fi

build() {  # title, source folder, build folder; leaves kernels in it
  echo "== building: $1" >&2
  cmake -S "$2" -B "$3" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPALPATE_BUILD_NODE=OFF -DPALPATE_BUILD_SIM=OFF \
    -DPALPATE_BUILD_TESTS=ON >"$3.log" 2>&1 && cmake --build "$3" --target kernels -j "$jobs" >>"$3.log" 2>&1 || {
    grep -E 'error|Error' "$3.log" | head -20 >&2
    fail "$1 does not build with this kernels.cpp: see $3.log"
  }
}
build_commit() {  # side, commit
  local tree=$work/$1
  if [ -e "$tree/.git" ]; then
    git -C "$tree" checkout --quiet --force --detach "$2"
    git -C "$tree" clean --quiet --force -d
  else
    git worktree add --quiet --force --detach "$tree" "$2"
  fi
  rm -rf "$tree/tests/support" "$tree/tests/bench/kernels"
  mkdir -p "$tree/tests/bench"
  cp -Rp tests/support "$tree/tests/support"
  cp -Rp tests/bench/kernels "$tree/tests/bench/kernels"
  # Commits from before headers were precompiled lack the function that tests/support asks for.
  printf '%s\n' 'find_package(GTest REQUIRED)' 'if(NOT COMMAND palpate_use_precompiled)' \
    '  function(palpate_use_precompiled)' '  endfunction()' 'endif()' 'add_subdirectory(support)' \
    'add_subdirectory(bench/kernels)' >"$tree/tests/CMakeLists.txt"
  build "$1: $(git log -1 --format='%h %s' "$2")" "$tree" "$work/$1-build"
}
if [ -n "$new" ]; then build_commit new "$new"; else build "the working tree" . $work/new-build; fi
if [ -n "$old" ]; then build_commit old "$old"; fi

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

program_of() { find "$work/$1-build" -type f -name kernels -perm -u+x; }
kernels=$(program_of new)
chosen=$("$kernels" --list | awk -v only="$only" '$1 == "empty" || $1 ~ only')
[ "$(wc -l <<<"$chosen")" -gt 1 ] || fail "no kernel matches '$only'" 2
sides=(new ${old:+old})
for side in "${sides[@]}"; do
  folder=$work/count-$side
  program=$(program_of $side)
  rm -rf $folder
  mkdir -p $folder
  echo "== counting: $side, $(wc -l <<<"$chosen") kernels" >&2
  tr '\n' '\0' <<<"$chosen" | xargs -0 -P "$jobs" -I{} bash -c 'count "$@"' count "$program" $folder {} ||
    fail "not every kernel was counted"
done

echo "kernel,calls,instructions_per_call${old:+,old_instructions_per_call,ratio}"
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
      now = each
    }
    if (sides == 2 && NR % 2 == 0) {
      printf ",%.1f,%.4f", each, now / each
      logs += log(now / each)
      rows++
    }
    if (NR % sides == 0) printf "\n"
  }
  END { if (rows) printf "geometric mean of the ratios: %.4f\n", exp(logs / rows) >"/dev/stderr" }'
