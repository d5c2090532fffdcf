// Splits a probe's patches into runs of unbroken contact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "core/recognition/recognizer.h"

namespace palpate {

/// A run ends where the patch number changes, where the probe or the object starts anew, and where
/// lost messages leave a gap in the arc. The recognizer gets its own number for each run; the
/// probe's patch number of each is kept.
class PatchNumbering {
 public:
  /// Number of the run that these samples continue or begin. `break_spacings`: after lost messages,
  /// a gap larger than this many sample spacings ends the run.
  std::uint32_t run_of(std::uint32_t wire_patch, bool samples_are_missing, double break_spacings,
                       std::span<const ContactSample> samples) {
    const bool joins = open_ && wire_patch == wire_patches_.back() &&
                       !(samples_are_missing && is_broken(break_spacings, samples));
    if (!joins) begin(wire_patch);
    follow(samples, samples_are_missing);
    return first_run_ + static_cast<std::uint32_t>(wire_patches_.size()) - 1;
  }

  /// Makes the next samples begin a new run (new epoch or new object).
  void end_run() { open_ = false; }

  /// The probe's patch number of a run; nullopt if the run is too old.
  std::optional<std::uint32_t> wire_patch(std::uint32_t run) const {
    const std::uint32_t index = run - first_run_;
    if (index >= wire_patches_.size()) return std::nullopt;
    return wire_patches_[index];
  }

 private:
  // Twice what one recognition holds: most_patches strokes (at most 1,024) plus 1,024 single
  // touches.
  static constexpr std::size_t kRemembered = 4096;

  void begin(std::uint32_t wire_patch) {
    wire_patches_.push_back(wire_patch);
    if (wire_patches_.size() > kRemembered) {
      wire_patches_.pop_front();
      ++first_run_;
    }
    open_ = true;
    has_last_ = false;
    spacing_ = 0.0;
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
      if (has_last_ && !after_hole) {
        const double step = (sample.position_m - last_).norm();
        spacing_ = spacing_ == 0.0 ? step : spacing_ + (step - spacing_) / kMemory;
      }
      after_hole = false;
      last_ = sample.position_m;
      has_last_ = true;
    }
  }

  std::deque<std::uint32_t> wire_patches_;  // of the latest runs
  std::uint32_t first_run_ = 0;             // number of wire_patches_.front()
  bool open_ = false;
  bool has_last_ = false;
  Vec2 last_ = Vec2::Zero();
  double spacing_ = 0.0;
};

}  // namespace palpate
