#include "core/numerics/work_budget.h"

namespace palpate {

// Processor time, as `bench_worst_case --prices` measures it, to some tens of percent. Changing one
// changes which answers are cut, on every machine alike.
double price_of(WorkKind kind) {
  switch (kind) {
    case WorkKind::PolynomialRow:
      return 1.0;
    case WorkKind::ConicRow:
      return 1.85;
    case WorkKind::SoughtFoot:
      return 38.0;
    case WorkKind::FitStep:
      return 3.3;
    case WorkKind::AxisRow:
      return 0.3;
    case WorkKind::SeedRow:
      return 0.28;
    case WorkKind::PlacedRow:
      return 3.3;
    case WorkKind::PathRow:
      return 6.5;
    case WorkKind::PosteriorRow:
      return 2.9;
    case WorkKind::DriftRow:
      return 0.95;
    case WorkKind::OffsetCell:
      return 8.4;
    case WorkKind::SpikeRow:
      return 0.55;
    case WorkKind::Sample:
      break;
  }
  return 1.0;
}

}  // namespace palpate
