// Normals and covariances of the rows of CSV files.
#pragma once

#include <string_view>

#include "node/csv/contact_table.h"

namespace palpate::csv {

/// The numbers of a row's normal and covariance, in SI units; all 0 where none is given.
struct DetailNumbers {
  Vec2 normal = Vec2::Zero();
  double normal_sigma_rad = 0.0;
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();  ///< xx, xy, yy
};

enum class DetailFault { None, NormalLength, NormalDeviation, Covariance };

/// What is wrong, in words for the one who wrote the file.
std::string_view words_of(DetailFault fault);

/// Puts them into the row, with the mean noise of a covariance; the row is unchanged if they have a
/// fault.
DetailFault take_detail(const DetailNumbers& numbers, ContactRow& row);

}  // namespace palpate::csv
