#include "tests/bench/worst_case/work_prices.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>

namespace palpate::bench {
namespace {

constexpr auto kKinds = static_cast<Eigen::Index>(kWorkKinds);

constexpr std::array kNames = {"polynomial row", "conic row", "sought foot", "fit step",
                               "axis row",       "seed row",  "placed row",  "path row",
                               "posterior row",  "drift row", "offset cell", "spike row",
                               "section row",    "sample"};
static_assert(kNames.size() == kWorkKinds);

/// What a unit takes at prices, over the inputs [ns].
void print_unit(const char* which, const std::vector<CountedTime>& measured,
                const std::array<double, kWorkKinds>& prices) {
  std::vector<double> ns;
  for (const CountedTime& input : measured) {
    double work = 0.0;
    for (std::size_t k = 0; k < kWorkKinds; ++k) {
      work += prices[k] * static_cast<double>(input.counts[k]);
    }
    ns.push_back(1e3 * input.us / work);
  }
  std::sort(ns.begin(), ns.end());
  const auto quantile = [&](double q) {
    return ns[static_cast<std::size_t>(q * static_cast<double>(ns.size() - 1))];
  };
  std::printf(
      "a unit at the prices %s takes %.1f ns in the middle, 1 %% %.1f, 10 %% %.1f, 90 %% %.1f, "
      "99 %% %.1f, all %.1f to %.1f\n",
      which, quantile(0.5), quantile(0.01), quantile(0.1), quantile(0.9), quantile(0.99),
      quantile(0.0), quantile(1.0));
}

}  // namespace

std::array<double, kWorkKinds> prices_us(const std::vector<CountedTime>& measured) {
  using Row = Eigen::Matrix<double, kKinds, 1>;
  Eigen::Matrix<double, kKinds, kKinds> squares = Eigen::Matrix<double, kKinds, kKinds>::Zero();
  Row pull = Row::Zero();
  for (const CountedTime& input : measured) {
    Row row;
    for (Eigen::Index k = 0; k < kKinds; ++k) {
      row[k] = static_cast<double>(input.counts[static_cast<std::size_t>(k)]) / input.us;
    }
    squares += row * row.transpose();
    pull += row;
  }
  // Coordinate by coordinate down a convex function.
  constexpr int kRounds = 20000;
  std::array<double, kWorkKinds> prices{};
  Eigen::Map<Row> x(prices.data());
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index k = 0; k < kKinds; ++k) {
      if (squares(k, k) > 0.0) {
        x[k] = std::max(x[k] + (pull[k] - squares.row(k).dot(x)) / squares(k, k), 0.0);
      }
    }
  }
  return prices;
}

void print_prices(const std::vector<CountedTime>& measured) {
  const std::array<double, kWorkKinds> found_us = prices_us(measured);
  std::array<double, kWorkKinds> found{};
  std::array<double, kWorkKinds> in_force{};
  std::printf("%-16s %10s %10s %10s\n", "kind", "ns", "units", "in force");
  for (std::size_t k = 0; k < kWorkKinds; ++k) {
    found[k] = found_us[k] / found_us[0];
    in_force[k] = price_of(static_cast<WorkKind>(k));
    std::printf("%-16s %10.1f %10.2f %10.2f\n", kNames[k], 1e3 * found_us[k], found[k],
                in_force[k]);
  }
  std::printf("%zu inputs\n", measured.size());
  print_unit("in force", measured, in_force);
  print_unit("found", measured, found);
}

}  // namespace palpate::bench
