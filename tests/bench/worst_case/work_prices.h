// What each kind of counted work costs in processor time, by least squares over many inputs.
#pragma once

#include <array>
#include <vector>

#include "core/numerics/work_budget.h"

namespace palpate::bench {

struct CountedTime {
  double us = 0.0;
  std::array<std::size_t, kWorkKinds> counts{};
};

/// None negative; relative errors count. [us]
std::array<double, kWorkKinds> prices_us(const std::vector<CountedTime>& measured);

/// One line a kind: what it costs, that over a PolynomialRow's, the price in force; and how far
/// times are from what counts tell at the prices in force.
void print_prices(const std::vector<CountedTime>& measured);

}  // namespace palpate::bench
