# Sourced by node/demo.sh and tests/run.sh: predicts how long a part takes on this machine.
#
# The cost of a part is known in core seconds of the machine of the table in tests/README.md. To compare this machine,
# and its present load, with that one, a small program is compiled on all cores at once.

# Seconds that compiling the program below took there, on both cores at once, with nothing else running.
calibration_reference_s=4.1
# Core seconds there of the parts, from empty folders. Measure builds with tests/support/cpu_seconds.py.
demo_build_cost=320
strict_build_cost=650
strict_test_cost=650
sanitize_cost=1520
tidy_cost=460
fuzz_cost=330

calibrate() {  # sets calibration_s: the seconds that it takes here and now
  local LC_ALL=C  # a point in EPOCHREALTIME
  local folder start=$EPOCHREALTIME
  folder=$(mktemp -d)
  cat >"$folder/calibrate.cpp" <<'EOF'
#include <iostream>
#include <map>
#include <regex>
#include <string>
int main() {
  std::map<std::string, int> counts;
  for (std::string line; std::getline(std::cin, line);) {
    if (std::regex_search(line, std::regex("[a-z]+"))) ++counts[line];
  }
  return static_cast<int>(counts.size());
}
EOF
  local core
  for core in $(seq "$(nproc)"); do
    c++ -std=c++20 -O2 -c "$folder/calibrate.cpp" -o "$folder/$core.o" &
  done
  wait
  rm -rf "$folder"
  calibration_s=$(awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { print b - a }')
}

how_long() {  # $1: core seconds there; prints about how many minutes here
  awk -v cost="$1" -v here="$calibration_s" -v there="$calibration_reference_s" -v cores="$(nproc)" \
    'BEGIN { minutes = cost * here / there / cores / 60; printf minutes < 1 ? "a minute" : "%.0f minutes", minutes + 0.5 }'
}
