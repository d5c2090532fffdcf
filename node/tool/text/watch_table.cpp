#include "node/tool/text/watch_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "node/files/counted.h"
#include "node/files/printable.h"
#include "node/files/quantity.h"
#include "node/tool/text/advice.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

constexpr std::size_t kWidestName = 16;
constexpr std::size_t kObjectWidth = 7;

/// A name padded or cut to the width of its column.
std::string column(const std::string& text, std::size_t width) {
  std::string cell = printable(text).substr(0, width);
  cell.resize(width, ' ');
  return cell + " ";
}

std::string right_column(const std::string& text, std::size_t width) {
  return std::string(width > text.size() ? width - text.size() : 0, ' ') + text + " ";
}

/// The number of an object. A long one (such as a time stamp) is shortened to its last digits,
/// which distinguish it from the next.
std::string object_text(std::uint64_t object) {
  const std::string digits = std::to_string(object);
  return digits.size() <= kObjectWidth ? digits
                                       : ".." + digits.substr(digits.size() - kObjectWidth + 2);
}

/// Widths of the columns: as wide as the names in them.
struct NameWidths {
  std::size_t group = std::string_view("GROUP").size();
  std::size_t probe = std::string_view("PROBE").size();
};

NameWidths widths_of(const WatchedState& state) {
  NameWidths widths;
  const auto widen = [](std::size_t& width, const std::string& name) {
    width = std::max(width, std::min(printable(name).size(), kWidestName));
  };
  for (const auto& entry : state.groups) widen(widths.group, entry.first);
  for (const v1::ProbeStatus& probe : state.status.probes()) {
    widen(widths.probe, probe.probe());
    widen(widths.group, probe.group());
  }
  return widths;
}

std::string status_word(const v1::Recognition& answer) {
  const std::string text = status_text(answer);
  return text.substr(0, text.find(':'));
}

std::string latency_text(double latency_ms) {
  return latency_ms > 0.0 ? number(std::round(10.0 * latency_ms) / 10.0) + " ms" : "-";
}

void add_group(const std::string& name, const WatchedGroup& group, const NameWidths& widths,
               std::size_t columns, std::vector<std::string>& lines) {
  const v1::Recognition& answer = group.answer;
  std::string shape;
  for (const Quantity& quantity : quantities_of(answer)) {
    shape += (shape.empty() ? "" : ", ") + quantity.name + " " + quantity.text;
  }
  std::string line =
      column(name, widths.group) + right_column(object_text(answer.object()), kObjectWidth) +
      column(spoken_name(answer.curve_class()), 21) + column(status_word(answer), 10) +
      right_column(std::to_string(answer.sample_count()), 8) +
      right_column(latency_text(group.latency_ms), 9);
  if (line.size() + shape.size() <= columns) {
    lines.push_back(line + shape);
  } else {
    lines.push_back(std::move(line));
    lines.push_back("  " + shape);
  }
  if (answer.status() != v1::RECOGNITION_STATUS_RECOGNIZED) {
    lines.push_back("  " + advice_text(answer));
  }
  if (!answer.invariants().empty()) {
    lines.push_back("  " + invariants_text(answer));
  }
}

void add_probe(const v1::ProbeStatus& probe, double status_age_s, const NameWidths& widths,
               std::vector<std::string>& lines) {
  char age[32];
  std::snprintf(age, sizeof age, "SILENT for %.1f s", std::max(probe.age_s(), 0.0) + status_age_s);
  char rate[32];
  std::snprintf(rate, sizeof rate, "%.0f", probe.sample_rate_hz());
  lines.push_back(column(probe.probe(), widths.probe) + column(probe.group(), widths.group) +
                  column(probe.alive() ? "alive" : age, 18) + right_column(rate, 9) +
                  right_column(std::to_string(probe.gaps()), 6) +
                  right_column(std::to_string(probe.missing()), 6) +
                  right_column(std::to_string(probe.rejected()), 7) +
                  right_column(std::to_string(probe.restarts()), 8));
}

std::string head_line(const WatchedState& state) {
  if (!state.has_status) {
    return state.silent_s > kRecognizerSilence.count() ? "no recognizer heard yet"
                                                       : "waiting for the recognizer";
  }
  if (state.silent_s > kRecognizerSilence.count()) return silence_text(state.silent_s);
  char text[160];
  std::snprintf(
      text, sizeof text,
      "recognizer alive for %.0f s, %llu of %llu messages taken, computing %.1f ms (p99 %.1f ms)",
      state.status.uptime_s(), static_cast<unsigned long long>(state.status.messages_accepted()),
      static_cast<unsigned long long>(state.status.messages_received()),
      1e-6 * static_cast<double>(state.status.compute_p50_ns()),
      1e-6 * static_cast<double>(state.status.compute_p99_ns()));
  std::string line = text;
  if (state.status.objects_superseded() > 0)
    line.append("; ").append(superseded_text(state.status));
  return line;
}

}  // namespace

std::string superseded_text(const v1::NodeStatus& status) {
  return counted(status.objects_superseded(), "object") + " without an answer";
}

std::string silence_text(double silent_s) {
  char text[48];
  std::snprintf(text, sizeof text, "recognizer silent for %.0f s", silent_s);
  return text;
}

std::vector<std::string> watch_table(const WatchedState& state, std::size_t columns,
                                     std::size_t rows) {
  std::vector<std::string> lines{head_line(state)};
  const NameWidths widths = widths_of(state);
  if (!state.groups.empty()) {
    lines.push_back(column("GROUP", widths.group) + right_column("OBJECT", kObjectWidth) +
                    column("CLASS", 21) + column("STATUS", 10) + right_column("SAMPLES", 8) +
                    right_column("LATENCY", 9) + "SHAPE AND POSE");
    for (const auto& [name, group] : state.groups) add_group(name, group, widths, columns, lines);
  }
  if (!state.status.probes().empty()) {
    lines.push_back(column("PROBE", widths.probe) + column("GROUP", widths.group) +
                    column("STATE", 18) + right_column("SAMPLES/S", 9) + right_column("GAPS", 6) +
                    right_column("LOST", 6) + right_column("REFUSED", 7) +
                    right_column("RESTARTS", 8));
    for (const v1::ProbeStatus& probe : state.status.probes()) {
      add_probe(probe, state.silent_s, widths, lines);
    }
  }
  if (rows > 0 && lines.size() > rows) {
    const std::size_t hidden = lines.size() - rows + 1;
    lines.resize(rows - 1);
    lines.push_back("... " + std::to_string(hidden) + " more lines");
  }
  for (std::string& line : lines) line = line.substr(0, columns);
  return lines;
}

}  // namespace palpate
