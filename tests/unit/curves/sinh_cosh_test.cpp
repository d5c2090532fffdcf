// Both hyperbolic functions at once, against those of more digits.
#include "core/curves/sinh_cosh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

TEST(SinhCosh, IsRightToTwoUnitsInTheLastPlace) {
  static_assert(std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits);
  for (double t = 1e-300; t < 709.0; t *= 1.013) {
    for (const double signed_t : {t, -t}) {
      const auto [sinh, cosh] = sinh_cosh(signed_t);
      const auto wide = static_cast<long double>(signed_t);
      EXPECT_LE(std::abs(static_cast<double>(sinh / std::sinh(wide) - 1.0L)), 2.0 * kUlp) << t;
      EXPECT_LE(std::abs(static_cast<double>(cosh / std::cosh(wide) - 1.0L)), 2.0 * kUlp) << t;
    }
  }
}

TEST(SinhCosh, HoldsAtZeroAndAtTheEnds) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sinh_cosh(0.0).sinh, 0.0);
  EXPECT_TRUE(std::signbit(sinh_cosh(-0.0).sinh));
  EXPECT_EQ(sinh_cosh(0.0).cosh, 1.0);
  for (const double large : {710.5, 1e308, kInfinity}) {
    EXPECT_EQ(sinh_cosh(large).sinh, kInfinity);
    EXPECT_EQ(sinh_cosh(-large).sinh, -kInfinity);
    EXPECT_EQ(sinh_cosh(-large).cosh, kInfinity);
  }
  EXPECT_TRUE(std::isnan(sinh_cosh(std::nan("")).sinh));
  EXPECT_TRUE(std::isnan(sinh_cosh(std::nan("")).cosh));
}

}  // namespace
}  // namespace palpate
