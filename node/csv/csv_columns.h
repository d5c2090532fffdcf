// What a column of contacts can hold, and the columns of a contact CSV file.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace palpate::csv {

enum class Column {
  Probe,
  Patch,
  X,
  Y,
  Sigma,
  Stamp,
  Object,
  Group,
  TipRadius,
  MaterialSide,
  NormalX,
  NormalY,
  NormalSigma,
  CovarianceXx,
  CovarianceXy,
  CovarianceYy,
  Z,  ///< in files of points only (point_columns.h)
};

/// Of a contact CSV file, in the order of Column. The first kRequiredColumns must be there.
inline constexpr std::array<std::string_view, 16> kColumnNames = {"probe",
                                                                  "patch",
                                                                  "x_m",
                                                                  "y_m",
                                                                  "sigma_m",
                                                                  "stamp_ns",
                                                                  "object",
                                                                  "group",
                                                                  "tip_radius_m",
                                                                  "material_side",
                                                                  "normal_x",
                                                                  "normal_y",
                                                                  "normal_sigma_rad",
                                                                  "cov_xx_m2",
                                                                  "cov_xy_m2",
                                                                  "cov_yy_m2"};
inline constexpr std::size_t kColumnCount = kColumnNames.size();
inline constexpr std::size_t kRequiredColumns = 4;

}  // namespace palpate::csv
