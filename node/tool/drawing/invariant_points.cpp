#include "node/tool/drawing/invariant_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/invariants/canonical_point.h"
#include "core/invariants/conic_line.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/parabola_invariant.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/recognition/tree_answer.h"
#include "node/files/quantity.h"
#include "node/tool/text/recognition_text.h"
#include "node/wire/convert.h"

namespace palpate {
namespace {

using Geometry = Eigen::Vector3d;  ///< tangent angle, kappa, kappa_s
/// The canonical frame of a cubic: its first two shape parameters and its rotation.
using Frame = Eigen::Vector3d;
using Function = std::function<double(const Geometry&, const Frame&)>;

struct PooledFrame {
  Frame value = Frame::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

struct Value {
  double value = 0.0;
  double sigma = 0.0;
};

/// First-order propagation. Differences over a thousandth of a standard deviation are not affected
/// by curvature.
template <typename Of>
double variance_of(const Eigen::Vector3d& at, const Eigen::Matrix3d& covariance, const Of& of) {
  constexpr double kDifference = 1e-3;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double step = kDifference * std::sqrt(covariance(i, i));
    if (step > 0.0) {
      const Eigen::Vector3d aside = step * Eigen::Vector3d::Unit(i);
      gradient[i] = (of(at + aside) - of(at - aside)) / (2.0 * step);
    }
  }
  return std::max(gradient.dot(covariance * gradient), 0.0);
}

/// Includes the uncertainty of the frame: for a contact far out on a cubic, a small rotation of the
/// frame has a large effect.
Value propagated(const MeasuredGeometry& point, const Function& function,
                 const PooledFrame& frame = {}) {
  const Geometry at(point.tangent_angle, point.kappa, point.kappa_s);
  const double own = variance_of(at, point.covariance,
                                 [&](const Geometry& g) { return function(g, frame.value); });
  const double of_frame =
      variance_of(frame.value, frame.covariance, [&](const Frame& f) { return function(at, f); });
  return {function(at, frame.value), std::sqrt(own + of_frame)};
}

/// c of a point of (t^2, a t^3 + b t^2 + c t) from its tangent and curvature, which are measured
/// better than the curvature's derivative. The slope gives c = 2 t (slope - b) - 3 a t^2; then the
/// second derivative (3 a t^2 - c) / (4 t^3) is a quadratic equation for t. Of its two roots the
/// one is taken whose c is nearer to `pooled_c`; NaN if there is none.
double spline_c_of(const CanonicalPoint<double>& p, double a, double b, double pooled_c) {
  const double rise = p.sine / p.cosine - b;
  const double second = p.kappa / (p.cosine * p.cosine * p.cosine);
  const double q = 0.5 * (3.0 * a + std::sqrt(9.0 * a * a - 8.0 * second * rise));
  const auto c_at = [&](double t) { return 2.0 * t * rise - 3.0 * a * t * t; };
  const double first = c_at(0.5 * q / second);
  const double other = c_at(rise / q);
  return std::abs(first - pooled_c) < std::abs(other - pooled_c) ? first : other;
}

class Panels {
 public:
  explicit Panels(const Recognition& answer) : answer_(answer) {
    for (const TreePoint& point : tree_points(answer.contacts)) {
      points_.push_back(measured_geometry(point.estimate, point.patch));
    }
  }

  std::vector<InvariantPanel> make() {
    for (const NamedInvariant& invariant : answer_.invariants) {
      switch (invariant.curve_class) {
        case CurveClass::Circle:
          add_curvature(invariant);
          break;
        case CurveClass::Ellipse:
        case CurveClass::Hyperbola:
        case CurveClass::Parabola:
          add_to_conics(invariant);
          break;
        default:
          add_cubic(invariant);
      }
    }
    return std::move(panels_);
  }

 private:
  static std::string spoken(CurveClass curve_class) { return spoken_name(to_wire(curve_class)); }

  std::string test_of(CurveClass curve_class, bool named) const {
    const double p = answer_.tree_p_values[static_cast<std::size_t>(curve_class)];
    return std::isnan(p) ? ""
                         : (named ? spoken(curve_class) + ": " : "") + "p = " + short_number(p);
  }

  static std::string short_number(double value) {
    std::string text;
    add_row(text, "%.2g", value);
    return text;
  }

  static std::string value_text(const NamedInvariant& invariant) {
    return std::string(invariant.name) + " = " +
           (std::isfinite(invariant.sigma) ? with_sigma(invariant.value, invariant.sigma)
                                           : number(invariant.value));
  }

  /// A panel with the estimates of all contacts and a level line for the pooled value.
  InvariantPanel over_contacts(const NamedInvariant& invariant, const char* unit,
                               const Function& function, const PooledFrame& frame = {}) const {
    InvariantPanel panel;
    const std::string name(invariant.name);
    panel.title = name + " of the " + spoken(invariant.curve_class);
    panel.test = test_of(invariant.curve_class, false);
    panel.x_label = "contact";
    panel.contacts = points_.size();
    panel.y_label = name + (*unit != '\0' ? " [" + std::string(unit) + "]" : "");
    PooledLine line;
    line.label = value_text(invariant);
    line.intercept = invariant.value;
    line.covariance(0, 0) = invariant.sigma * invariant.sigma;
    panel.lines.push_back(line);
    for (std::size_t i = 0; function && i < points_.size(); ++i) {
      const Value value = propagated(points_[i], function, frame);
      panel.points.push_back(
          {points_[i].patch, static_cast<double>(i + 1), 0.0, value.value, value.sigma});
    }
    return panel;
  }

  void add_curvature(const NamedInvariant& invariant) {
    panels_.push_back(over_contacts(
        invariant, "1/m", [](const Geometry& g, const Frame&) { return std::abs(g[1]); }));
  }

  const NamedInvariant* invariant_called(std::string_view name) const {
    const auto found =
        std::find_if(answer_.invariants.begin(), answer_.invariants.end(),
                     [&](const NamedInvariant& invariant) { return invariant.name == name; });
    return found == answer_.invariants.end() ? nullptr : &*found;
  }

  void add_to_conics(const NamedInvariant& invariant) {
    if (!conics_) {
      conics_ = panels_.size();
      panels_.push_back(empty_conics());
    }
    InvariantPanel& panel = panels_[*conics_];
    if (invariant.name == "Ic2") {
      return;  // drawn with Ic1
    }
    PooledLine line;
    if (invariant.name == "Ic1") {
      const NamedInvariant* ic2 = invariant_called("Ic2");
      if (ic2 == nullptr) {
        return;
      }
      line.label = value_text(invariant) + ", " + value_text(*ic2);
      line.intercept = ic2->value;
      line.slope = -invariant.value;
      // Their correlation comes from the line fitted to the contacts, their standard deviations
      // from the published invariants.
      const ConicLine fit = fit_conic_line(points_);
      const double product = std::sqrt(fit.covariance(0, 0) * fit.covariance(1, 1));
      const double correlation = product > 0.0 ? fit.covariance(0, 1) / product : 0.0;
      line.covariance << ic2->sigma * ic2->sigma, -correlation * invariant.sigma * ic2->sigma,
          -correlation * invariant.sigma * ic2->sigma, invariant.sigma * invariant.sigma;
    } else {
      line.label = value_text(invariant);
      line.intercept = invariant.value;
      line.covariance(0, 0) = invariant.sigma * invariant.sigma;
    }
    panel.lines.push_back(line);
    const std::string test = test_of(invariant.curve_class, true);
    panel.test += (panel.test.empty() || test.empty() ? "" : "; ") + test;
  }

  InvariantPanel empty_conics() const {
    InvariantPanel panel;
    panel.title = "Conics: Ip = Ic2 - Ic1 u";
    panel.x_label = "u = |kappa|^(-2/3) [m^(2/3)]";
    panel.y_label = "Ip [m^(-2/3)]";
    panel.x_is_contact = false;
    for (const MeasuredGeometry& point : points_) {
      const Value u = propagated(
          point, [](const Geometry& g, const Frame&) { return 1.0 / curvature_two_thirds(g[1]); });
      const Value v = propagated(
          point, [](const Geometry& g, const Frame&) { return parabola_invariant(g[1], g[2]); });
      panel.points.push_back({point.patch, u.value, u.sigma, v.value, v.sigma});
    }
    return panel;
  }

  /// The canonical frame of the class near these parameters, fitted to all contacts.
  std::optional<PooledFrame> frame_of(CurveClass curve_class,
                                      const Eigen::Vector3d& parameters) const {
    constexpr int kStarts = 24;  // 15 degrees apart
    std::optional<SemiSignatureFit> best;
    SemiSignatureOptions options;
    options.relative_floor = RecognitionTreeOptions().relative_floor;
    for (int i = 0; i < kStarts; ++i) {
      const SemiSignatureFit fit =
          fit_semi_signature(curve_class, points_, parameters, 2.0 * kPi * i / kStarts, options);
      if (fit.status == InvariantStatus::Ok && (!best || fit.chi2 < best->chi2)) {
        best = fit;
      }
    }
    if (!best) {
      best = curve_class == CurveClass::CubicalParabola ? fit_cubical_parabola(points_, options)
             : curve_class == CurveClass::SemiCubicalParabola
                 ? fit_semi_cubical_parabola(points_, options)
                 : fit_cubic_spline(points_, {.refinement = options});
    }
    if (best->status != InvariantStatus::Ok) {
      return std::nullopt;
    }
    const auto turn = static_cast<int>(parameter_letters(curve_class).size());
    const std::array rows = {0, 1, turn};
    return PooledFrame{{best->parameters[0], best->parameters[1], best->orientation},
                       best->covariance(rows, rows)};
  }

  double value_of(std::string_view name) const {
    const NamedInvariant* invariant = invariant_called(name);
    return invariant != nullptr ? invariant->value : 0.0;
  }

  void add_cubic(const NamedInvariant& invariant) {
    if (invariant.name == "a" || invariant.name == "b") {
      return;  // drawn with c
    }
    const bool cubical = invariant.curve_class == CurveClass::CubicalParabola;
    const bool semi = invariant.curve_class == CurveClass::SemiCubicalParabola;
    const Eigen::Vector3d parameters =
        cubical ? Eigen::Vector3d(value_of("Icp1"), value_of("Icp2"), 0.0)
        : semi  ? Eigen::Vector3d(std::sqrt(value_of("Iscp1")), value_of("Iscp2"), 0.0)
                : Eigen::Vector3d(value_of("a"), value_of("b"), value_of("c"));
    if (framed_ != invariant.curve_class) {
      framed_ = invariant.curve_class;
      frame_ = frame_of(invariant.curve_class, parameters);
    }
    const auto canonical = [](const Geometry& g, const Frame& f) {
      return canonical_point(g[0] - f[2], g[1], g[2]);
    };
    Function function;
    const char* unit = "";
    if (invariant.name == "Icp1") {
      unit = "1/m^2";
      function = [=](const Geometry& g, const Frame& f) {
        return cubical_parabola_a(canonical(g, f));
      };
    } else if (invariant.name == "Icp2") {
      function = [=](const Geometry& g, const Frame& f) {
        return cubical_parabola_c(canonical(g, f));
      };
    } else if (invariant.name == "Iscp1") {
      unit = "1/m";
      function = [=](const Geometry& g, const Frame& f) {
        return semi_cubical_parabola_a_squared(canonical(g, f));
      };
    } else if (invariant.name == "Iscp2") {
      function = [=](const Geometry& g, const Frame& f) {
        return semi_cubical_parabola_b(canonical(g, f));
      };
    } else {
      unit = "m^(1/2)";
      // With the pooled values of the other two parameters, each contact gives an estimate of c.
      function = [canonical, pooled_c = invariant.value](const Geometry& g, const Frame& f) {
        return spline_c_of(canonical(g, f), f[0], f[1], pooled_c);
      };
    }
    if (!frame_) {
      function = nullptr;
    }
    InvariantPanel panel = over_contacts(invariant, unit, function, frame_.value_or(PooledFrame()));
    if (!cubical && !semi) {
      panel.lines.front().label = value_text(*invariant_called("a")) + ", " +
                                  value_text(*invariant_called("b")) + ", " + value_text(invariant);
    }
    panels_.push_back(std::move(panel));
  }

  const Recognition& answer_;
  std::vector<MeasuredGeometry> points_;
  std::vector<InvariantPanel> panels_;
  std::optional<std::size_t> conics_;
  CurveClass framed_ = CurveClass::Unclassified;  ///< the class that `frame_` belongs to
  std::optional<PooledFrame> frame_;
};

}  // namespace

double PooledLine::sigma_at(double x) const {
  const Eigen::Vector2d row(1.0, x);
  return std::sqrt(std::max(row.dot(covariance * row), 0.0));
}

std::vector<InvariantPanel> invariant_panels(const Recognition& answer) {
  return Panels(answer).make();
}

}  // namespace palpate
