#include "node/files/quantity.h"

#include <gtest/gtest.h>

#include <limits>

namespace palpate {
namespace {

TEST(Quantity, ShowsAsManyDigitsAsTheStandardDeviationLeaves) {
  EXPECT_EQ(with_sigma(24.99096, 0.0163), "24.991 +- 0.016");
  EXPECT_EQ(with_sigma(-0.5, 0.00123), "-0.5000 +- 0.0012");
  EXPECT_EQ(with_sigma(73.2, 31.4), "73 +- 31");
  EXPECT_EQ(with_sigma(4800.0, 130000.0), "4.8e+03 +- 1.3e+05");
  EXPECT_EQ(with_sigma(153000.0, 31000.0), "1.53e+05 +- 3.1e+04");
  EXPECT_EQ(with_sigma(1.0, 1e-12), "1.0000000000000e+00 +- 1.0e-12");
}

TEST(Quantity, RoundsWithoutAnExponent) {
  EXPECT_EQ(with_digits(934.2, 2), "930");
  EXPECT_EQ(with_digits(0.09951, 2), "0.1");
  EXPECT_EQ(with_digits(1234.5, 3), "1230");
  EXPECT_EQ(with_digits(-0.001234, 2), "-0.0012");
}

TEST(Quantity, SaysWhatIsNotKnown) {
  EXPECT_EQ(with_sigma(1.23456789, 0.0), "1.23457");
  EXPECT_EQ(with_sigma(2.0, std::numeric_limits<double>::infinity()), "2 +- inf");
}

TEST(Quantity, PicksTheUnitThatGivesANumberOfOneOrMore) {
  EXPECT_EQ(length_unit_for(2.0).name, "m");
  EXPECT_EQ(length_unit_for(0.02).name, "mm");
  EXPECT_EQ(length_unit_for(2e-5).name, "um");
  EXPECT_EQ(length_unit_for(2e-7).name, "um");
  EXPECT_EQ(length_unit_for(2e-8).name, "nm");
  EXPECT_EQ(length_unit_for(2e-11).name, "nm");
  EXPECT_EQ(length_unit_for(0.0).name, "m");
}

}  // namespace
}  // namespace palpate
