// Measures the quality of the posterior on scenes drawn from a stated prior
// (tests/support/scene_prior.h): how often the answer names the class that the data determine,
// whether stated probabilities are true, errors compared with their covariance and with the bound,
// and the time of recognize(). Prints tables.
//   bench_posterior [--scenes N] [--seed S] [--noise stated|unknown] [--classes-only]
//                   [--other-prior] [--followed] [--csv FILE]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "tests/bench/accuracy/calibration_table.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/options/thread_time.h"
#include "tests/support/calibration.h"
#include "tests/support/joint_error.h"
#include "tests/support/rivals.h"
#include "tests/support/scene_prior.h"
#include "tests/support/touched_curve.h"

namespace {

using namespace palpate;

constexpr double kTold = 0.95;       // required probability
constexpr double kCoverage = 0.999;  // of the binomial bands
constexpr int kRepetitions = 3;      // of each timing; the least counts

struct Options {
  int scenes = 600;
  std::uint64_t seed = 2026;
  std::string noise = "stated";
  bool classes_only = false;
  bool other_prior = false;
  bool followed = false;
  std::string csv;
};

/// One scene and its answer.
struct Row {
  test::PriorScene prior_scene;
  test::Margin margin;
  Recognition answer;
  double us = 0.0;

  CurveClass truth() const { return prior_scene.scene.curve_class; }
  bool recognized() const { return answer.status == RecognitionStatus::Recognized; }
  bool right() const { return answer.shape.curve_class == truth(); }
  double stated() const {
    return answer.hypotheses.empty() ? 0.0 : answer.hypotheses.front().probability;
  }
  double of_truth() const {
    const Hypothesis* found = test::hypothesis_of(answer, truth());
    return found != nullptr ? found->probability : 0.0;
  }
};

std::string name(CurveClass curve_class) { return std::string(name_of(curve_class)); }

Row run(const Options& options, const test::ScenePrior& prior, std::uint32_t number) {
  Row row;
  row.prior_scene = test::scene_from(prior, options.seed, number);
  const double sigma = options.noise == "stated" ? row.prior_scene.scene.sigma_m : 0.0;
  row.us = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepetitions; ++i) {
    Recognizer recognizer;
    const auto add = options.followed ? test::add_scene_followed : test::add_scene;
    add(row.prior_scene.scene, sigma, &recognizer);
    const double start = bench::thread_us();
    row.answer = recognizer.recognize();
    row.us = std::min(row.us, bench::thread_us() - start);
  }
  row.margin = test::margin_of(row.prior_scene);
  return row;
}

/// A share in the form "n of m (p %)".
std::string share(long n, long m) {
  char text[64];
  std::snprintf(text, sizeof(text), "%ld of %ld (%.1f %%)", n, m,
                m > 0 ? 100.0 * static_cast<double>(n) / static_cast<double>(m) : 0.0);
  return text;
}

template <typename Predicate>
long count(const std::vector<Row>& rows, const Predicate& predicate) {
  return std::count_if(rows.begin(), rows.end(), predicate);
}

void print_classes(const std::vector<Row>& rows) {
  std::printf(
      "\nClasses. Determined: every class that has not the true one as a limit leaves a chi-square "
      "above %.1f, %.1f, %.1f or\n"
      "%.1f (0, 1, 2, 3 parameters less than the true one) on the points without noise, and every "
      "class that has leaves an\n"
      "Occam factor above %g (tests/support/class_margin.h)\n",
      test::needed_chi2(0), test::needed_chi2(1), test::needed_chi2(2), test::needed_chi2(3),
      test::kOccamFactor);
  std::printf("%-24s %7s %10s | %-22s %-22s | %-16s %-10s %-16s\n", "true class", "scenes",
              "determined", "P(truth) >= 0.95", "RECOGNIZED, right", "all: P >= 0.95", "RECOGNIZED",
              "and wrong");
  const auto line = [&](const std::string& title, const auto& belongs) {
    const auto of = [&](const auto& predicate) {
      return count(rows, [&](const Row& r) { return belongs(r) && predicate(r); });
    };
    const long scenes = of([](const Row&) { return true; });
    const long determined = of([](const Row& r) { return r.margin.determined; });
    std::printf(
        "%-24s %7ld %10ld | %-22s %-22s | %-16ld %-10ld %-16s\n", title.c_str(), scenes, determined,
        share(of([](const Row& r) { return r.margin.determined && r.of_truth() >= kTold; }),
              determined)
            .c_str(),
        share(of([](const Row& r) { return r.margin.determined && r.recognized() && r.right(); }),
              determined)
            .c_str(),
        of([](const Row& r) { return r.of_truth() >= kTold; }),
        of([](const Row& r) { return r.recognized(); }),
        share(of([](const Row& r) { return r.recognized() && !r.right(); }), scenes).c_str());
  };
  for (const CurveClass curve_class : kCurveClasses) {
    line(name(curve_class), [=](const Row& r) { return r.truth() == curve_class; });
  }
  line("all classes", [](const Row& r) { return r.truth() != CurveClass::Unclassified; });
  const auto none = [](const Row& r) { return r.truth() == CurveClass::Unclassified; };
  const auto told = [&](const Row& r) { return none(r) && r.margin.told_apart; };
  const auto wrong = [](const Row& r) { return r.recognized() && !r.right(); };
  std::printf(
      "%-24s %7ld scenes: RECOGNIZED as a class %s\n", "curves of no class", count(rows, none),
      share(count(rows, [&](const Row& r) { return none(r) && wrong(r); }), count(rows, none))
          .c_str());
  std::printf(
      "%-24s %7ld scenes (every class leaves a chi-square above %g without noise): RECOGNIZED as a "
      "class %s; as none %s\n",
      "  long enough to tell", count(rows, told), test::kToldFromEveryClass,
      share(count(rows, [&](const Row& r) { return told(r) && wrong(r); }), count(rows, told))
          .c_str(),
      share(count(rows, [&](const Row& r) { return told(r) && r.recognized() && r.right(); }),
            count(rows, told))
          .c_str());
  for (const Row& row : rows) {
    if (wrong(row)) {
      std::printf("  wrong: scene %td, %s as %s, P %.4f, %zu patches, sigma/size %.1e\n",
                  &row - rows.data(), name(row.truth()).c_str(),
                  name(row.answer.shape.curve_class).c_str(), row.stated(),
                  row.prior_scene.scene.patches.size(),
                  row.prior_scene.scene.sigma_m / row.prior_scene.size_m);
    }
  }
}

void print_calibrations(const std::vector<Row>& rows) {
  std::printf("\nProbability of the most probable hypothesis against how often it is the truth\n");
  std::printf("%-24s %-11s %7s %9s %9s   %s\n", "answer", "bin", "scenes", "stated", "observed",
              "99.9 % band");
  test::Calibration pooled;
  std::array<test::Calibration, 9> by_class;
  for (const Row& row : rows) {
    if (row.answer.hypotheses.empty()) continue;
    pooled.add(row.stated(), row.right());
    by_class[static_cast<std::size_t>(row.answer.shape.curve_class)].add(row.stated(), row.right());
  }
  int beside = bench::print_calibration("all", pooled);
  for (std::size_t i = 0; i < by_class.size(); ++i) {
    beside += bench::print_calibration(name(static_cast<CurveClass>(i)), by_class[i]);
  }
  std::printf("bins beside their band: %d\n", beside);
}

/// What the most probable hypothesis does not tell: a truth that was thought to be out.
void print_scores(const std::vector<Row>& rows) {
  constexpr double kOut = 1e-3;
  constexpr double kLeast = 1e-9;  // where a probability is written as 0
  double score = 0.0, stated = 0.0, expected = 0.0;
  int scenes = 0, out = 0;
  for (const Row& row : rows) {
    if (row.truth() == CurveClass::Unclassified) continue;
    ++scenes;
    score -= std::log(std::max(row.of_truth(), kLeast));
    out += row.of_truth() < kOut ? 1 : 0;
    for (const Hypothesis& hypothesis : row.answer.hypotheses) {
      const double p = hypothesis.probability;
      stated -= p > 0.0 ? p * std::log(p) : 0.0;
      const bool is_class = hypothesis.shape.curve_class != CurveClass::Unclassified;
      expected += is_class && p < kOut ? p : 0.0;
    }
  }
  std::printf(
      "\nCurves of a class: -log P(truth) %.3f in the mean (stated %.3f); truths given less than a "
      "thousandth: %d of %d (stated %.1f)\n",
      score / scenes, stated / scenes, out, scenes, expected);
}

void print_errors(const std::vector<Row>& rows) {
  std::printf(
      "\nErrors of shape and pose where RECOGNIZED and right: root mean square in published "
      "standard deviations by component\n"
      "(a line: across, angle), beyond the published 95 %% ellipsoid, root mean square over the "
      "bound\n");
  for (const CurveClass curve_class : kCurveClasses) {
    int counted = 0;
    int beyond = 0;
    Eigen::VectorXd squares;
    Eigen::VectorXd over_bound;
    for (const Row& row : rows) {
      if (row.truth() != curve_class || !row.recognized() || !row.right()) continue;
      const test::JointError joint =
          test::joint_error(row.answer.hypotheses.front(), row.prior_scene.scene);
      if (counted++ == 0) {
        squares = Eigen::VectorXd::Zero(joint.error.size());
        over_bound = Eigen::VectorXd::Zero(joint.error.size());
      }
      squares += joint.error.cwiseAbs2().cwiseQuotient(joint.covariance.diagonal());
      beyond += test::squared_distance(joint) > test::chi_square_95(joint.error.size()) ? 1 : 0;
      if (curve_class != CurveClass::Line) {
        const Eigen::VectorXd bound =
            test::bound_of(row.prior_scene.scene).diagonal().head(joint.error.size());
        over_bound += joint.error.cwiseAbs2().cwiseQuotient(bound);
      }
    }
    if (counted == 0) continue;
    std::printf("%-24s %4d  rms/sd", name(curve_class).c_str(), counted);
    for (const double square : squares) std::printf(" %5.2f", std::sqrt(square / counted));
    const test::Band band = test::binomial_band(
        std::vector<double>(static_cast<std::size_t>(counted), 0.05), kCoverage);
    std::printf("   beyond 95 %%: %d (99.9 %% band %d-%d)", beyond, band.least, band.most);
    if (curve_class != CurveClass::Line) {
      std::printf("   rms/bound");
      for (const double square : over_bound) std::printf(" %5.2f", std::sqrt(square / counted));
    }
    std::printf("\n");
  }
}

void print_times(const std::vector<Row>& rows) {
  std::vector<double> us;
  for (const Row& row : rows) us.push_back(row.us);
  std::sort(us.begin(), us.end());
  const auto at = [&](double fraction) {
    const auto last = static_cast<double>(us.size() - 1);
    return us[static_cast<std::size_t>(std::lround(fraction * last))];
  };
  const auto slowest = std::max_element(rows.begin(), rows.end(),
                                        [](const Row& a, const Row& b) { return a.us < b.us; });
  std::printf(
      "\nTime of one recognize(), least of %d [us] and over the median: median %.0f; 90 %% %.0f "
      "(%.1f); 99 %% %.0f (%.1f);\n"
      "maximum %.0f (%.1f), scene %td\n",
      kRepetitions, at(0.5), at(0.9), at(0.9) / at(0.5), at(0.99), at(0.99) / at(0.5), at(1.0),
      at(1.0) / at(0.5), slowest - rows.begin());
}

void write_csv(const std::string& path, const std::vector<Row>& rows) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) {
    std::fprintf(stderr, "bench_posterior: %s cannot be written\n", path.c_str());
    std::exit(1);
  }
  std::fprintf(file,
               "scene,truth,patches,sigma_over_size,determined,told_apart,nearest,nearest_chi2,"
               "occam,best,probability,"
               "probability_of_truth,status,doubt,us\n");
  for (const Row& row : rows) {
    std::fprintf(
        file, "%td,%s,%zu,%.3e,%d,%d,%s,%.4g,%.4g,%s,%.6f,%.6f,%d,%s,%.0f\n", &row - rows.data(),
        name(row.truth()).c_str(), row.prior_scene.scene.patches.size(),
        row.prior_scene.scene.sigma_m / row.prior_scene.size_m, row.margin.determined ? 1 : 0,
        row.margin.told_apart ? 1 : 0, name(row.margin.nearest).c_str(), row.margin.chi2,
        row.margin.occam, name(row.answer.shape.curve_class).c_str(), row.stated(), row.of_truth(),
        static_cast<int>(row.answer.status), std::string(name_of(row.answer.doubt)).c_str(),
        row.us);
  }
  std::fclose(file);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (const auto end =
          bench::BenchOptions(
              "Certainty, calibration, errors and time on scenes drawn from a stated prior")
              .number("--scenes", options.scenes, "Number of scenes")
              .seed(options.seed)
              .one_of({"stated", "unknown"}, "--noise", options.noise,
                      "Whether the samples state their noise")
              .flag("--classes-only", options.classes_only, "No curves of no class")
              .flag("--other-prior", options.other_prior,
                    "Scenes from another prior: splines five times as frequent, arcs half as long")
              .flag("--followed", options.followed,
                    "Each answer the third about its scene, whose last patch was still touched "
                    "at the others")
              .text("--csv", options.csv, "Write a row a scene into this file")
              .parse(argc, argv)) {
    return *end;
  }
  test::ScenePrior prior = options.other_prior ? test::other_prior() : test::even_prior();
  if (options.classes_only) prior = test::classes_only(prior);
  std::vector<Row> rows;
  for (int i = 0; i < options.scenes; ++i) {
    rows.push_back(run(options, prior, static_cast<std::uint32_t>(i)));
  }
  std::printf("%d scenes, seed %llu, noise %s, %s%s%s; arcs %g to %g sizes, sigma/size %g to %g\n",
              options.scenes, static_cast<unsigned long long>(options.seed), options.noise.c_str(),
              options.other_prior ? "splines five times as frequent" : "all kinds equally frequent",
              options.classes_only ? ", no curves of no class" : "",
              options.followed ? ", answers followed" : "", prior.least_arc_over_size,
              prior.most_arc_over_size, prior.least_sigma_over_size, prior.most_sigma_over_size);
  print_classes(rows);
  print_calibrations(rows);
  print_scores(rows);
  print_errors(rows);
  print_times(rows);
  if (!options.csv.empty()) write_csv(options.csv, rows);
  return 0;
}
