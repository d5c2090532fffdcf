#include "core/numerics/work_budget.h"

namespace palpate {

// Processor time, as `bench_worst_case --prices` measures it, to some tens of percent. Changing one
// changes which answers are cut, on every machine alike.
double price_of(WorkKind kind) {
  switch (kind) {
    case WorkKind::PolynomialRow:
      return 1.0;
    case WorkKind::ConicRow:
      return 3.2;
    case WorkKind::SoughtFoot:
      return 14.0;
    case WorkKind::FitStep:
      return 4.0;
    case WorkKind::AxisRow:
      return 0.15;
    case WorkKind::SeedRow:
      return 0.27;
    case WorkKind::PlacedRow:
      return 0.8;
    case WorkKind::PathRow:
    case WorkKind::PosteriorRow:
      return 2.2;
    case WorkKind::DriftRow:
      return 1.0;
    case WorkKind::OffsetCell:
      return 6.0;
    case WorkKind::SpikeRow:
      return 0.5;
    case WorkKind::SectionRow:
      return 5.5;
    case WorkKind::Sample:
      return 1.0;
  }
  return 1.0;
}

}  // namespace palpate
