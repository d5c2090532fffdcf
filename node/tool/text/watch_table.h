// The table of groups and probes that `palpate watch` shows on a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "palpate/v1/node_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// A recognizer publishes its status every second. After this time without it, the recognizer is
/// shown as silent.
inline constexpr std::chrono::duration<double> kRecognizerSilence{2.5};

struct WatchedGroup {
  v1::Recognition answer;
  double latency_ms = 0.0;  ///< from the touch to here; 0 = not known
};

struct WatchedState {
  std::map<std::string, WatchedGroup> groups;
  v1::NodeStatus status;
  bool has_status = false;
  double silent_s = 0.0;  ///< since the last message
};

/// At most `rows` lines of at most `columns` characters. The last line counts what does not fit.
/// Control characters in received text are not shown.
std::vector<std::string> watch_table(const WatchedState& state, std::size_t columns,
                                     std::size_t rows);

/// E.g. "3 objects without an answer".
std::string superseded_text(const v1::NodeStatus& status);

/// E.g. "recognizer silent for 6 s".
std::string silence_text(double silent_s);

}  // namespace palpate
