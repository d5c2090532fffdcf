// The functions of a curve must not allocate memory.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>

#include "core/curves/curve.h"
#include "tests/support/allocation_counter.h"

namespace {
std::atomic<std::size_t> malloc_count = 0;
}

// The linker's --wrap redirects all calls from this program's objects and static libraries to
// these.
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  ++malloc_count;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++malloc_count;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* memory, std::size_t size) {
  ++malloc_count;
  return __real_realloc(memory, size);
}
}

namespace palpate {
namespace {

std::size_t allocations() { return malloc_count + test::allocation_count(); }

const void* volatile seen = nullptr;  // keeps the compiler from removing an allocation

TEST(Allocation, TheCountersCount) {
  const std::size_t before = allocations();
  const Eigen::VectorXd dynamic = Eigen::VectorXd::Zero(100);
  seen = dynamic.data();
  const std::size_t by_eigen = allocations();
  EXPECT_GT(by_eigen, before);
  const auto plain = std::make_unique<double>(1.0);
  seen = plain.get();
  EXPECT_GT(allocations(), by_eigen);
}

TEST(Allocation, NoneInAnyFunctionOfAnyClass) {
  for (const CurveClass curve_class : kCurveClasses) {
    double sum = 0.0;
    const std::size_t before = allocations();
    const auto curve = make_curve(curve_class, {1.3, 0.7, -0.4});
    for (int i = -50; i <= 50; ++i) {
      const double t = 0.03 * i + 0.001;
      const Vec2 point(3.0 * std::sin(7.0 * i), 2.0 * std::cos(3.0 * i));
      const auto place = localise(*curve, geometry(*curve, t));
      sum += position(*curve, t).x() + derivatives(*curve, t).third.y();
      sum += position_by_parameters(*curve, t).sum() + parameters(*curve).sum();
      sum += foot_point(*curve, point).distance + foot_point_near(*curve, point, t).distance;
      sum += arc_length(*curve, -0.2, t) + parameter_at_arc_length(*curve, t, 0.1);
      sum += pose_from_contact(*curve, place.value_or(Localisation{}), point, t).theta;
    }
    EXPECT_EQ(allocations(), before) << name_of(curve_class);
    EXPECT_TRUE(std::isfinite(sum)) << name_of(curve_class);
  }
}

}  // namespace
}  // namespace palpate
