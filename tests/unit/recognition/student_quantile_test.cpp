// Student's law against 50-digit values, found by bisection of the regularised incomplete beta
// function: tan(pi (p - 1/2)) with one degree of freedom.
#include "core/numerics/probability/student_quantile.h"

#include <gtest/gtest.h>

#include <array>

namespace palpate {
namespace {

struct Value {
  double dof = 0.0;
  double z = 0.0;
  double quantile = 0.0;
};

TEST(StudentQuantile, AgreesWithFiftyDigits) {
  constexpr std::array kValues = {
      Value{1, 1, 1.8373372014715831391},  Value{1, 3, 235.80149796046805497},
      Value{1, 5, 1110441.7955811969309},  Value{2, 1, 1.3212773729262554623},
      Value{2, 3, 19.206744211508586227},  Value{2, 5, 1320.7105639083411419},
      Value{3, 3, 9.2189404587002562956},  Value{3, 5, 156.67784113720260372},
      Value{4, 3, 6.6202059668158664384},  Value{5, 3, 5.5070797124692919178},
      Value{5, 5, 31.846999263156628078},  Value{10, 1, 1.0525624152573362101},
      Value{10, 5, 11.166269324317651793}, Value{100, 5, 5.3441696762581253093}};
  constexpr double kRelative = 1e-12;  // the tail's probability is rounded, its root is not
  for (const Value& value : kValues) {
    EXPECT_NEAR(student_quantile(value.z, value.dof), value.quantile, kRelative * value.quantile)
        << value.dof << " degrees of freedom, " << value.z;
  }
}

}  // namespace
}  // namespace palpate
