// What palpate watch shows on a terminal: groups and probes as one table.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "palpate/v1/node_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// A recognizer says every second that it lives; after this it is called silent.
inline constexpr std::chrono::duration<double> kRecognizerSilence{2.5};

struct WatchedGroup {
  v1::Recognition answer;
  double latency_ms = 0.0;  ///< from the touch to here; 0 = not known
};

struct WatchedState {
  std::map<std::string, WatchedGroup> groups;
  v1::NodeStatus status;
  bool has_status = false;
  double silent_s = 0.0;  ///< since anything was heard
};

/// Lines of at most `columns` characters, at most `rows` of them; what does not fit is counted in
/// the last one. Text from the bus is shown without control characters.
std::vector<std::string> watch_table(const WatchedState& state, std::size_t columns,
                                     std::size_t rows);

/// "recognizer silent for 6 s".
std::string silence_text(double silent_s);

}  // namespace palpate
