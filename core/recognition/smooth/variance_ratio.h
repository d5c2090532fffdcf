// Whether two estimates of a variance differ by more than chance.
#pragma once

namespace palpate {

/// True if a variance that rests on `dof` degrees of freedom is `ratio` > 0 times one that rests on
/// `other_dof`, which so large or so small a ratio of equal noises is less than once in a million
/// times.
bool is_ratio_beyond_chance(double ratio, double dof, double other_dof);

}  // namespace palpate
