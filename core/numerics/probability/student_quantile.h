// Quantiles of Student's law, from those of the normal law.
#pragma once

namespace palpate {

/// What Student's law with `dof` > 0 degrees of freedom exceeds as rarely as the normal law exceeds
/// `z`.
double student_quantile(double z, double dof);

}  // namespace palpate
