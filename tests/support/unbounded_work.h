// Work for stages of the recogniser that a test calls by themselves: as much as they take.
#pragma once

#include "core/numerics/work_budget.h"

namespace palpate::test {

inline WorkBudget& unbounded_work() {
  static WorkBudget work;
  return work;
}

}  // namespace palpate::test
