// Work that is counted and bounded: operations, never time, so that an answer is the same on any
// machine and under any load.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace palpate {

/// What is counted: the loops in which a recognition can spend its time, each by what it repeats.
enum class WorkKind {
  PolynomialRow,  ///< a point against a polynomial curve: its foot followed, its row of a step
  ConicRow,       ///< a point against a conic, circle or line, likewise
  SoughtFoot,     ///< a point whose nearest foot is sought anywhere on a polynomial curve
  FitStep,        ///< a step of such a fit, whatever its points: a small system solved
  AxisRow,        ///< a point against a curve seen along an axis, two edges or another point
  SeedRow,        ///< a point or a sum of points, for one axis and vertex of the coarse search
  PlacedRow,      ///< a point carried to another fit, or placed on a canonical curve
  PathRow,        ///< a point or section on the free-form paths of one size
  PosteriorRow,   ///< a point against a curve in touched coordinates
  DriftRow,       ///< a point made white for one size of a drift
  OffsetCell,     ///< one size of an offset by direction
  SpikeRow,       ///< a sample in one fit of the spike search
  SectionRow,     ///< a sample in one fit of a section's polynomials
  Sample,         ///< a sample read and told of once
};
inline constexpr std::size_t kWorkKinds = 14;

/// In units of one PolynomialRow.
double price_of(WorkKind kind);

/// A bound of work that stages share. Each stage counts what it does, and asks before what it could
/// do without. allows() is the one place where the bound bites, and it keeps what it has said:
/// nothing is left out unsaid.
class WorkBudget {
 public:
  /// Counts, and allows everything.
  WorkBudget() = default;

  /// `always`: of `most`, kept for what is done in any case, and for the step that is under way
  /// when the rest is spent.
  WorkBudget(double most, double always) : most_(most), ceiling_(most - always) {}

  void spend(WorkKind kind, std::size_t count) {
    counts_[static_cast<std::size_t>(kind)] += count;
    spent_ += price_of(kind) * static_cast<double>(count);
  }

  /// Whether there is work left for what can be left out.
  bool allows() {
    const bool allowed = spent_ < ceiling_;
    was_cut_ = was_cut_ || !allowed;
    return allowed;
  }

  bool was_cut() const { return was_cut_; }  ///< whether anything was not allowed
  double spent() const { return spent_; }    ///< [PolynomialRow]
  double most() const { return most_; }      ///< likewise
  const std::array<std::size_t, kWorkKinds>& counts() const { return counts_; }  ///< by WorkKind

  /// While it lives, keeps a share of all for what comes after.
  class Reserve {
   public:
    Reserve(WorkBudget& work, double share) : work_(work), before_(work.ceiling_) {
      work.ceiling_ -= share * work.most_;
    }
    ~Reserve() { work_.ceiling_ = before_; }
    Reserve(const Reserve&) = delete;
    Reserve& operator=(const Reserve&) = delete;

   private:
    WorkBudget& work_;
    double before_;
  };

 private:
  static constexpr double kUnbounded = std::numeric_limits<double>::max();
  double most_ = kUnbounded;
  double ceiling_ = kUnbounded;
  double spent_ = 0.0;
  bool was_cut_ = false;
  std::array<std::size_t, kWorkKinds> counts_{};
};

}  // namespace palpate
