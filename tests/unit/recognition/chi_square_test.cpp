// The chi-square law against 50-digit values (tests/data/reference/make_chi_square.py).
#include "core/numerics/probability/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace palpate {
namespace {

struct ReferenceValue {
  std::string what;
  int dof = 0;
  double chi2 = 0.0;
  double survival = 0.0;
};

std::vector<ReferenceValue> reference_values() {
  std::ifstream file(std::string(PALPATE_TEST_DATA) + "/reference/chi_square.csv");
  std::vector<ReferenceValue> values;
  std::string line;
  std::getline(file, line);  // names of the columns
  while (std::getline(file, line)) {
    std::istringstream stream(line);
    ReferenceValue value;
    std::string dof, chi2, survival;
    std::getline(stream, value.what, ',');
    std::getline(stream, dof, ',');
    std::getline(stream, chi2, ',');
    std::getline(stream, survival, ',');
    value.dof = std::stoi(dof);
    value.chi2 = std::stod(chi2);
    value.survival = std::stod(survival);
    values.push_back(value);
  }
  return values;
}

TEST(ChiSquare, SurvivalAgreesWithFiftyDigits) {
  constexpr double kAbsolute = 1e-14;  // as its header says
  int compared = 0;
  for (const ReferenceValue& value : reference_values()) {
    if (value.what == "survival") {
      ++compared;
      EXPECT_NEAR(chi_square_survival(value.chi2, value.dof), value.survival, kAbsolute)
          << value.dof << " degrees of freedom, " << value.chi2;
    }
  }
  EXPECT_GT(compared, 150);
}

TEST(ChiSquare, ThresholdAgreesWithFiftyDigits) {
  constexpr double kRelative = 1e-12;  // as its header says
  int compared = 0;
  for (const ReferenceValue& value : reference_values()) {
    if (value.what == "threshold") {
      ++compared;
      EXPECT_NEAR(chi_square_threshold(value.survival, value.dof) / value.chi2, 1.0, kRelative)
          << value.dof << " degrees of freedom, " << value.survival;
    }
  }
  EXPECT_GE(compared, 150);
}

TEST(ChiSquare, NothingToTestIsNeverExceeded) {
  EXPECT_EQ(chi_square_survival(0.0, 5), 1.0);
  EXPECT_EQ(chi_square_survival(3.0, 0), 1.0);
  EXPECT_EQ(chi_square_threshold(0.05, 0), 0.0);
}

}  // namespace
}  // namespace palpate
