// From the probe's patch numbers to runs of unbroken contact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "core/recognition/recognizer.h"

namespace palpate {

/// A run ends where the probe says so (another patch number), where the probe or the object starts
/// anew, and where messages were lost and the arc is broken by it. Runs are numbered for the
/// recognizer and never joined again; the probe's number of each is remembered.
class PatchNumbering {
 public:
  /// Number of the run that these samples continue or begin. `break_spacings`: after lost messages
  /// the arc is broken where the hole exceeds this many sample spacings.
  std::uint32_t run_of(std::uint32_t wire_patch, bool samples_are_missing, double break_spacings,
                       std::span<const ContactSample> samples) {
    const bool joins = open_ && wire_patch == wire_patches_.back() &&
                       !(samples_are_missing && is_broken(break_spacings, samples));
    if (!joins) begin(wire_patch);
    follow(samples, samples_are_missing);
    return first_run_ + static_cast<std::uint32_t>(wire_patches_.size()) - 1;
  }

  /// The next samples begin a run in any case: new epoch, new object.
  void end_run() { open_ = false; }

  /// The probe's own number of a run; nullopt where that is too long ago.
  std::optional<std::uint32_t> wire_patch(std::uint32_t run) const {
    const std::uint32_t index = run - first_run_;
    if (index >= wire_patches_.size()) return std::nullopt;
    return wire_patches_[index];
  }

 private:
  // Twice the strokes (most_patches, 1,024 at most) and touches (1,024) that one recognition holds.
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

  // A single sample has no spacing: then nothing speaks for an unbroken arc.
  bool is_broken(double break_spacings, std::span<const ContactSample> samples) const {
    if (!has_last_ || samples.empty()) return true;
    return (samples.front().position_m - last_).norm() > break_spacings * spacing_;
  }

  // Mean spacing over about the last kMemory samples; a hole is no spacing.
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
