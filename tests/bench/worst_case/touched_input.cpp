#include "tests/bench/worst_case/touched_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "tests/support/shared_errors.h"
#include "tests/support/test_rng.h"

namespace palpate::bench {
namespace {

constexpr double kMostSpikes = 0.3;
constexpr int kMostPatches = 64;
constexpr int kFewestSamples = 8;
constexpr int kMostSamples = 4096;

using test::log_uniform;
using test::uniform;

int log_integer(std::mt19937_64& rng, int least, int most) {
  return static_cast<int>(std::lround(log_uniform(rng, least, most)));
}

/// Zero with that probability, otherwise log-uniform.
double often_zero(std::mt19937_64& rng, double zero, double least, double most) {
  const bool is_zero = uniform(rng, 0.0, 1.0) < zero;
  return is_zero ? 0.0 : log_uniform(rng, least, most);
}

constexpr int kMembers = 15;

/// Draws member number `which` of the recipe.
void draw(int which, std::mt19937_64& rng, InputRecipe* r) {
  switch (which) {
    case 0:
      r->shape = static_cast<Shape>(std::uniform_int_distribution<int>(0, kShapes - 1)(rng));
      break;
    case 1:
      r->seed = rng();
      break;
    case 2:
      r->patches = log_integer(rng, 1, kMostPatches);
      break;
    case 3:
      r->samples = log_integer(rng, kFewestSamples, kMostSamples);
      break;
    case 4:
      r->size_m = log_uniform(rng, 1e-3, 1.0);
      break;
    case 5:
      r->arc = log_uniform(rng, 0.01, 6.0);
      break;
    case 6:
      r->coverage = uniform(rng, 0.0, 1.0);
      break;
    case 7:
      r->sigma = log_uniform(rng, 1e-10, 0.1);
      break;
    case 8: {
      const bool honest = uniform(rng, 0.0, 1.0) < 0.5;
      r->stated_over_true = honest ? 1.0 : often_zero(rng, 0.5, 1e-3, 1e3);
      break;
    }
    case 9:
      r->spikes = uniform(rng, 0.0, 1.0) < 0.5 ? 0.0 : uniform(rng, 0.0, kMostSpikes);
      break;
    case 10:
      r->spike_size = log_uniform(rng, 1e-3, 10.0);
      break;
    case 11:
      r->tip = often_zero(rng, 0.4, 1e-3, 3.0);
      break;
    case 12:
      r->sides_told = uniform(rng, 0.0, 1.0) < 0.5 ? 0.0 : uniform(rng, 0.0, 1.0);
      break;
    case 13: {
      r->misplacement = often_zero(rng, 0.6, 1e-6, 0.3);
      r->wave = often_zero(rng, 0.6, 1e-6, 0.1);
      break;
    }
    default: {
      r->dwelling = uniform(rng, 0.0, 1.0) < 0.7 ? 0.0 : uniform(rng, 0.0, 0.9);
      r->offset = often_zero(rng, 0.5, 1.0, 1e7);
      break;
    }
  }
}

/// Sets the members that the kind prescribes.
InputRecipe confined(InputRecipe r, InputKind kind) {
  if (kind == InputKind::Any) {
    return r;
  }
  if (kind == InputKind::Few || kind == InputKind::Patches) {
    constexpr int kMany = 16;
    r.patches = kind == InputKind::Patches ? std::max(r.patches, kMany) : r.patches;
    return r;
  }
  constexpr double kTip = 0.1;
  constexpr double kSpikes = 0.05;
  const bool tips = kind == InputKind::Tips || kind == InputKind::Sides;
  r.tip = tips ? (r.tip > 0.0 ? r.tip : kTip) : 0.0;
  r.sides_told = kind == InputKind::Sides ? 0.0 : 1.0;
  r.spikes = kind == InputKind::Spikes ? std::max(r.spikes, kSpikes) : 0.0;
  r.stated_over_true = kind == InputKind::Unstated ? 0.0
                       : r.stated_over_true > 0.0  ? r.stated_over_true
                                                   : 1.0;
  return r;
}

/// Reduces the samples per patch, then the patches, until the total is within `most_samples`.
InputRecipe bounded(InputRecipe recipe, InputKind kind, std::size_t most_samples) {
  InputRecipe r = confined(std::move(recipe), kind);
  constexpr std::size_t kFew = 32;
  most_samples = kind == InputKind::Few ? std::min(most_samples, kFew) : most_samples;
  r.patches = std::clamp(r.patches, 1, kMostPatches);
  r.patches = std::min(r.patches, std::max(1, static_cast<int>(most_samples) / kFewestSamples));
  r.samples = std::clamp(r.samples, kFewestSamples, kMostSamples);
  r.samples = std::clamp(static_cast<int>(most_samples) / r.patches, kFewestSamples, r.samples);
  r.spikes = std::clamp(r.spikes, 0.0, kMostSpikes);
  r.sides_told = std::clamp(r.sides_told, 0.0, 1.0);
  r.coverage = std::clamp(r.coverage, 0.0, 1.0);
  r.dwelling = std::clamp(r.dwelling, 0.0, 0.9);
  return r;
}

using Path = std::function<Vec2(double)>;

/// The curve at parameter u in [0, 1], with a half extent of about 1.
Path path_of(Shape shape, std::mt19937_64& rng) {
  const double p = uniform(rng, 0.0, 1.0);
  const double q = uniform(rng, 0.0, 1.0);
  const auto arms = [](double u) { return 2.0 * u - 1.0; };
  switch (shape) {
    case Shape::Line:
      return [=](double u) { return Vec2(arms(u), 0.0); };
    case Shape::Circle:
      return [](double u) { return Vec2(std::cos(2.0 * kPi * u), std::sin(2.0 * kPi * u)); };
    case Shape::Ellipse:
      return [=](double u) {
        return Vec2(std::cos(2.0 * kPi * u), (0.02 + 0.97 * p) * std::sin(2.0 * kPi * u));
      };
    case Shape::Parabola:
      return [=](double u) { return Vec2((0.05 + p) * arms(u) * arms(u), arms(u)); };
    case Shape::Hyperbola:
      return [=](double u) {
        const double t = 2.0 * arms(u);
        return Vec2(0.25 * (0.02 + p) * std::cosh(t), 0.25 * (0.02 + q) * std::sinh(t));
      };
    case Shape::CubicalParabola:
      return [=](double u) {
        return Vec2(arms(u), (0.05 + p) * std::pow(arms(u), 3) + (2.0 * q - 1.0) * arms(u));
      };
    case Shape::SemiCubicalParabola:
    case Shape::CubicSpline: {
      const double c = shape == Shape::CubicSpline ? std::pow(10.0, -4.0 * q) : 0.0;
      return [=](double u) {
        const double t = arms(u);
        return Vec2(t * t, (0.2 + p) * t * t * t + (q - 0.5) * t * t + c * t);
      };
    }
    case Shape::Sinusoid:
      return [=](double u) {
        return Vec2(arms(u), (0.05 + 0.5 * p) * std::sin((2.0 + 20.0 * q) * u));
      };
    case Shape::Superellipse:
      return [=](double u) {
        const double exponent = 2.0 / (2.2 + 6.0 * p);
        const auto power = [=](double x) {
          return std::copysign(std::pow(std::abs(x), exponent), x);
        };
        return Vec2(power(std::cos(2.0 * kPi * u)), 0.7 * power(std::sin(2.0 * kPi * u)));
      };
    case Shape::LogSpiral:
      return [=](double u) {
        const double angle = 10.0 * u;
        return Vec2(std::exp((0.3 * p + 0.02) * (angle - 10.0)) *
                    Vec2(std::cos(angle), std::sin(angle)));
      };
    case Shape::Quartic:
      return [=](double u) {
        const double t = 1.2 * arms(u);
        return Vec2(t, (0.5 + p) * std::pow(t, 4) - (0.8 + 0.4 * q) * t * t + 0.2 * t);
      };
    case Shape::FreeForm: {
      std::array<double, 12> harmonics{};
      std::normal_distribution<double> normal;
      for (std::size_t k = 0; k < harmonics.size(); ++k) {
        harmonics[k] = 0.3 * normal(rng) / std::pow(1.0 + 0.5 * static_cast<double>(k), 1.0 + p);
      }
      return [=](double u) {
        double radius = 1.0;
        for (std::size_t k = 0; k < harmonics.size(); ++k) {
          const double n = 2.0 + static_cast<double>(k / 2);
          const double phase = 2.0 * kPi * n * u;
          radius += harmonics[k] * (k % 2 == 0 ? std::cos(phase) : std::sin(phase));
        }
        return Vec2(radius * std::cos(2.0 * kPi * u), radius * std::sin(2.0 * kPi * u));
      };
    }
    case Shape::Polygon: {
      const int corners = 3 + static_cast<int>(5.0 * p);
      return [=](double u) {
        const double side = std::min(u * corners, corners - 1e-9);
        const double k = std::floor(side);
        const auto corner = [=](double i) {
          return Vec2(std::cos(2.0 * kPi * i / corners), std::sin(2.0 * kPi * i / corners));
        };
        return Vec2(corner(k) + (side - k) * (corner(k + 1.0) - corner(k)));
      };
    }
    case Shape::RandomWalk: {
      std::vector<Vec2> walk(512, Vec2::Zero());
      std::normal_distribution<double> normal(0.0, 0.05);
      for (std::size_t i = 1; i < walk.size(); ++i) {
        const double dx = normal(rng);
        walk[i] = walk[i - 1] + Vec2(dx, normal(rng));
      }
      return [walk](double u) {
        const double place = u * static_cast<double>(walk.size() - 1);
        const auto k = std::min(static_cast<std::size_t>(place), walk.size() - 2);
        return Vec2(walk[k] + (place - static_cast<double>(k)) * (walk[k + 1] - walk[k]));
      };
    }
  }
  return {};
}

/// Parameter by arc length.
class ArcTable {
 public:
  explicit ArcTable(const Path& path) {
    constexpr int kSteps = 2000;
    Vec2 before = path(0.0);
    arc_.push_back(0.0);
    for (int i = 1; i <= kSteps; ++i) {
      const Vec2 here = path(static_cast<double>(i) / kSteps);
      arc_.push_back(arc_.back() + (here - before).norm());
      before = here;
    }
  }
  double total() const { return arc_.back(); }
  double parameter_at(double arc) const {
    const auto upper = std::upper_bound(arc_.begin(), arc_.end(), arc);
    const auto k = std::clamp<std::ptrdiff_t>(upper - arc_.begin(), 1,
                                              static_cast<std::ptrdiff_t>(arc_.size()) - 1);
    const double span = arc_[static_cast<std::size_t>(k)] - arc_[static_cast<std::size_t>(k - 1)];
    const double f = span > 0.0 ? (arc - arc_[static_cast<std::size_t>(k - 1)]) / span : 0.0;
    return std::clamp((static_cast<double>(k - 1) + f) / static_cast<double>(arc_.size() - 1), 0.0,
                      1.0);
  }

 private:
  std::vector<double> arc_;
};

}  // namespace

std::size_t sample_count(const TouchedInput& input) {
  std::size_t count = 0;
  for (const TouchedPatch& patch : input) {
    count += patch.samples.size();
  }
  return count;
}

std::optional<InputKind> input_kind(std::string_view name) {
  constexpr std::array kKinds = {
      std::pair("any", InputKind::Any),       std::pair("plain", InputKind::Plain),
      std::pair("tips", InputKind::Tips),     std::pair("sides", InputKind::Sides),
      std::pair("spikes", InputKind::Spikes), std::pair("unstated", InputKind::Unstated),
      std::pair("few", InputKind::Few),       std::pair("patches", InputKind::Patches),
  };
  const auto* found = std::find_if(kKinds.begin(), kKinds.end(),
                                   [&](const auto& kind) { return kind.first == name; });
  return found == kKinds.end() ? std::nullopt : std::optional(found->second);
}

InputRecipe random_recipe(std::mt19937_64& rng, InputKind kind, std::size_t most_samples) {
  InputRecipe recipe;
  for (int k = 0; k < kMembers; ++k) {
    draw(k, rng, &recipe);
  }
  return bounded(recipe, kind, most_samples);
}

InputRecipe mutated(InputRecipe recipe, std::mt19937_64& rng, InputKind kind,
                    std::size_t most_samples) {
  const int changes = std::uniform_int_distribution<int>(1, 3)(rng);
  for (int i = 0; i < changes; ++i) {
    const int which = std::uniform_int_distribution<int>(0, kMembers - 1)(rng);
    if (uniform(rng, 0.0, 1.0) < 0.4) {
      draw(which, rng, &recipe);
      continue;
    }
    const double factor = std::exp(std::normal_distribution<double>(0.0, 0.4)(rng));
    switch (which) {
      case 2:
        recipe.patches = static_cast<int>(std::lround(factor * recipe.patches));
        break;
      case 3:
        recipe.samples = static_cast<int>(std::lround(factor * recipe.samples));
        break;
      case 5:
        recipe.arc = std::min(factor * recipe.arc, 6.0);
        break;
      case 6:
        recipe.coverage *= factor;
        break;
      case 7:
        recipe.sigma = std::min(factor * recipe.sigma, 0.1);
        break;
      case 8:
        recipe.stated_over_true = std::clamp(factor * recipe.stated_over_true, 0.0, 1e3);
        break;
      case 9:
        recipe.spikes *= factor;
        break;
      case 10:
        recipe.spike_size *= factor;
        break;
      case 11:
        recipe.tip = std::min(factor * recipe.tip, 3.0);
        break;
      case 13:
        recipe.misplacement *= factor;
        break;
      default:
        draw(which, rng, &recipe);
        break;
    }
  }
  return bounded(recipe, kind, most_samples);
}

namespace {

/// Position of sample i along its patch, 0 to 1.
double share_at(const InputRecipe& r, int i) {
  const int standing = static_cast<int>(r.standing * r.samples);
  const int moving = r.samples - standing;
  const int middle = moving / 2;
  const int step = i < middle ? i : std::max(i - standing, middle);
  const double way = moving > 1 ? r.passes * static_cast<double>(step) / (moving - 1) : 0.0;
  const double done = std::min(std::floor(way), r.passes - 1.0);
  const bool back = static_cast<int>(done) % 2 == 1;
  return back ? 1.0 - (way - done) : way - done;
}

}  // namespace

TouchedInput input_of(const InputRecipe& r) {
  std::mt19937_64 rng = test::seeded_rng(r.seed, {});
  const Path path = path_of(r.shape, rng);
  const ArcTable table(path);
  const double phase = uniform(rng, 0.0, 2.0 * kPi);
  const Pose2 pose{r.offset * r.size_m, -0.3 * r.offset * r.size_m, uniform(rng, -kPi, kPi)};
  std::normal_distribution<double> normal;
  TouchedInput input;
  for (int k = 0; k < r.patches; ++k) {
    TouchedPatch patch;
    patch.context.patch = static_cast<std::uint32_t>(k);
    patch.context.tip_radius_m = r.tip * r.size_m;
    const bool forward = uniform(rng, 0.0, 1.0) < 0.5;
    if (uniform(rng, 0.0, 1.0) < r.sides_told) {
      // Tips are to the right of increasing u: outside a curve that runs counterclockwise.
      patch.context.material_side = forward ? MaterialSide::Left : MaterialSide::Right;
    }
    const double arc = std::min(r.arc, table.total());
    const double start = r.coverage * uniform(rng, 0.0, table.total() - arc);
    const double shift_x = r.misplacement * normal(rng);
    const Vec2 shift(shift_x, r.misplacement * normal(rng));
    Vec2 before = Vec2::Zero();
    test::SharedErrors errors(r.shared_noise);
    for (int i = 0; i < r.samples; ++i) {
      const double share = share_at(r, i);
      const double place = start + arc * (forward ? share : 1.0 - share);
      const double u = table.parameter_at(place);
      constexpr double kStep = 1e-5;
      const Vec2 ahead = path(std::min(u + kStep, 1.0)) - path(std::max(u - kStep, 0.0));
      const Vec2 right = ahead.norm() > 0.0 ? Vec2(-left_of(ahead).normalized()) : Vec2(0.0, -1.0);
      Vec2 point = path(u) + shift + (r.tip + r.wave * std::sin(12.0 * place + phase)) * right;
      const Vec2 error = errors.next(normal, rng);
      point += r.sigma * error;
      if (uniform(rng, 0.0, 1.0) < r.spikes) {
        const double angle = uniform(rng, 0.0, 2.0 * kPi);
        point += r.spike_size * Vec2(std::cos(angle), std::sin(angle));
      }
      if (i > 0 && uniform(rng, 0.0, 1.0) < r.dwelling) {
        // Not exactly, because exact repetitions are not accepted.
        point = before + 1e-3 * r.sigma * Vec2(error.x(), -error.x());
      }
      before = point;
      patch.samples.push_back(
          {pose * Vec2(r.size_m * point), r.stated_over_true * r.sigma * r.size_m, 0});
    }
    input.push_back(std::move(patch));
  }
  return input;
}

TouchedInput clean_ellipse_like(const TouchedInput& input, std::uint32_t seed) {
  constexpr double kA_m = 0.025;
  constexpr double kB_m = 0.0175;
  constexpr double kSigma_m = 2.5e-5;
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> noise(0.0, kSigma_m);
  TouchedInput clean;
  for (std::size_t k = 0; k < input.size(); ++k) {
    TouchedPatch patch;
    patch.context.patch = static_cast<std::uint32_t>(k);
    const std::size_t count = input[k].samples.size();
    // Patches cover at least an eighth of the circumference.
    const double turn = 2.0 * kPi * std::max(1.0 / static_cast<double>(input.size()), 0.125);
    for (std::size_t i = 0; i < count; ++i) {
      const double t = 2.0 * kPi * static_cast<double>(k) / static_cast<double>(input.size()) +
                       0.9 * turn * static_cast<double>(i) / static_cast<double>(count);
      const double dx = noise(rng);
      const Vec2 point(kA_m * std::cos(t) + dx, kB_m * std::sin(t) + noise(rng));
      patch.samples.push_back({point, kSigma_m, 0});
    }
    clean.push_back(std::move(patch));
  }
  return clean;
}

std::string to_text(const InputRecipe& r) {
  constexpr std::array kNames = {"line",
                                 "circle",
                                 "ellipse",
                                 "parabola",
                                 "hyperbola",
                                 "cubical parabola",
                                 "semi-cubical parabola",
                                 "cubic spline",
                                 "sinusoid",
                                 "superellipse",
                                 "logarithmic spiral",
                                 "quartic",
                                 "free form",
                                 "polygon",
                                 "random walk"};
  static_assert(kNames.size() == kShapes);
  char text[512];
  std::snprintf(text, sizeof(text),
                "%s, seed %llu, %d patches of %d samples, size %.3g m, arc %.3g, coverage %.2f, "
                "sigma %.2g (stated: x %.3g), "
                "spikes %.1f %% of %.2g, tip %.3g (side told: %.0f %%), misplaced %.2g, wave %.2g, "
                "dwelling %.0f %%, offset %.2g",
                kNames.at(static_cast<std::size_t>(r.shape)),
                static_cast<unsigned long long>(r.seed), r.patches, r.samples, r.size_m, r.arc,
                r.coverage, r.sigma, r.stated_over_true, 100.0 * r.spikes, r.spike_size, r.tip,
                100.0 * r.sides_told, r.misplacement, r.wave, 100.0 * r.dwelling, r.offset);
  return text;
}

}  // namespace palpate::bench
