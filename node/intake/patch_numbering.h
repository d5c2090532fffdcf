// Splits a probe's patches into runs of unbroken contact.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "core/recognition/recognizer.h"

namespace palpate {

/// A run ends where the patch number changes, where the probe or the object starts anew, and where
/// lost messages leave a gap in the arc. The recognizer gets its own number for each run; the
/// probe's patch number of each is kept for as long as the recognizer may hold samples of the run.
class PatchNumbering {
 public:
  /// Number of the run that these samples continue or begin. `break_spacings`: after lost messages,
  /// a gap larger than this many sample spacings ends the run.
  std::uint32_t run_of(std::uint32_t wire_patch, bool samples_are_missing, double break_spacings,
                       std::span<const ContactSample> samples) {
    const bool joins = open_ && wire_patch == latest_.wire_patch &&
                       !(samples_are_missing && is_broken(break_spacings, samples));
    if (!joins) begin(wire_patch);
    follow(samples, samples_are_missing);
    return latest_.number;
  }

  /// Makes the next samples begin a new run (new epoch or new object).
  void end_run() { open_ = false; }

  /// The probe's patch number of a run; nullopt if the run is too old.
  std::optional<std::uint32_t> wire_patch(std::uint32_t run) const {
    for (const std::deque<Run>& kept : runs_) {
      const auto found = std::lower_bound(
          kept.begin(), kept.end(), run,
          [](const Run& each, std::uint32_t number) { return each.number < number; });
      if (found != kept.end() && found->number == run) return found->wire_patch;
    }
    return std::nullopt;
  }

 private:
  struct Run {
    std::uint32_t number = 0;
    std::uint32_t wire_patch = 0;
  };

  // The recognizer forgets strokes and single touches each by their own number, so any number of
  // touches may come while a stroke stays in use. Samples that all lie in one place are a touch to
  // a search and a stroke to a given class.
  enum Kind : std::size_t { kTouch, kStill, kStroke, kKinds };

  // Runs remembered of each kind: twice what one recognition holds (most_patches strokes, at most
  // 1,024, and 1,024 single touches).
  static constexpr std::size_t kRemembered = 2048;

  void begin(std::uint32_t wire_patch) {
    // Only now the kind of the run before is settled.
    if (runs_[kind_].size() > kRemembered) runs_[kind_].pop_front();
    latest_ = {next_number_++, wire_patch};
    kind_ = kTouch;
    runs_[kind_].push_back(latest_);
    open_ = true;
    has_last_ = false;
    spacing_ = 0.0;
  }

  void become(Kind kind) {
    if (kind <= kind_) return;
    runs_[kind_].pop_back();
    kind_ = kind;
    runs_[kind_].push_back(latest_);
  }

  // A single sample gives no spacing, so nothing shows that the arc is unbroken.
  bool is_broken(double break_spacings, std::span<const ContactSample> samples) const {
    if (!has_last_ || samples.empty()) return true;
    return (samples.front().position_m - last_).norm() > break_spacings * spacing_;
  }

  // Updates the mean spacing over about the last kMemory samples. A gap does not count as a
  // spacing.
  void follow(std::span<const ContactSample> samples, bool after_hole) {
    constexpr double kMemory = 16.0;
    for (const ContactSample& sample : samples) {
      if (has_last_) become(sample.position_m == last_ ? kStill : kStroke);
      if (has_last_ && !after_hole) {
        const double step = (sample.position_m - last_).norm();
        spacing_ = spacing_ == 0.0 ? step : spacing_ + (step - spacing_) / kMemory;
      }
      after_hole = false;
      last_ = sample.position_m;
      has_last_ = true;
    }
  }

  std::array<std::deque<Run>, kKinds> runs_;  // the latest of each kind, by increasing number
  Run latest_;
  Kind kind_ = kTouch;  // of the latest run, which is the last of its kind
  std::uint32_t next_number_ = 0;
  bool open_ = false;
  bool has_last_ = false;
  Vec2 last_ = Vec2::Zero();
  double spacing_ = 0.0;
};

}  // namespace palpate
