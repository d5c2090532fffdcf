// Points of space in a fitted plane, beside the named plane that is nearest.
#include "node/csv/point_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace palpate {
namespace {

TEST(PointPlane, AFittedOneHasTheAxesOfTheNearestNamedOne) {
  struct Case {
    PointPlane plane;
    Eigen::Vector3d first;
    Eigen::Vector3d second;
    const char* name;
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  for (const auto& [plane, first, second, name] :
       {Case{PointPlane::Xy, x, y, "nearest to xy"}, Case{PointPlane::Xz, x, z, "nearest to xz"},
        Case{PointPlane::Yz, y, z, "nearest to yz"}}) {
    // Tilted about each axis in turn, either way, by less than brings another plane nearer.
    for (const Eigen::Vector3d& axis : {x, y, z}) {
      for (const double tilt_rad : {-0.6, -0.01, 0.01, 0.6}) {
        if (axis == first.cross(second).cwiseAbs()) continue;
        const Eigen::Matrix3d turned = Eigen::AngleAxisd(tilt_rad, axis).toRotationMatrix();
        std::vector<Eigen::Vector3d> points;
        for (int i = 0; i < 40; ++i) {
          const double t = 0.1 * i;
          points.push_back(turned * (0.03 * std::cos(t) * first + 0.02 * std::sin(t) * second));
        }
        const csv::PlanePoints named = csv::in_plane(points, plane);
        const csv::PlanePoints fitted = csv::in_plane(points, PointPlane::Fitted);
        EXPECT_NE(fitted.note.find(name), std::string::npos) << fitted.note;
        for (std::size_t i = 0; i < points.size(); ++i) {
          // What the tilt foreshortens in the named plane, and nothing else.
          EXPECT_LE((named.points[i] - fitted.points[i]).norm(),
                    (1.0 - std::cos(tilt_rad)) * points[i].norm() + 1e-12)
              << fitted.note;
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate
