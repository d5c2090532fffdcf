#include "core/numerics/work_budget.h"

namespace palpate {

// Processor time, as `bench_worst_case --prices` measures it, to some tens of percent. Changing one
// changes which answers are cut, on every machine alike.
double price_of(WorkKind kind) {
  switch (kind) {
    case WorkKind::PolynomialRow:
      return 1.0;
    case WorkKind::ConicRow:
      return 2.0;
    case WorkKind::SoughtFoot:
      return 9.0;
    case WorkKind::FitStep:
      return 4.0;
    case WorkKind::AxisRow:
      return 0.32;
    case WorkKind::SeedRow:
      return 0.24;
    case WorkKind::PlacedRow:
      return 2.6;
    case WorkKind::PathRow:
      return 2.2;
    case WorkKind::PosteriorRow:
      return 2.0;
    case WorkKind::DriftRow:
      return 1.1;
    case WorkKind::OffsetCell:
      return 9.0;
    case WorkKind::SpikeRow:
      return 0.4;
    case WorkKind::Sample:
      return 0.9;
  }
  return 1.0;
}

}  // namespace palpate
