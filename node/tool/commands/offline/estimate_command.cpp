// palpate estimate: local estimates along the patches of a CSV file, as CSV.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/local/estimator.h"
#include "core/recognition/samples/joined_runs.h"
#include "node/files/counted.h"
#include "node/files/written_file.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/file_flags.h"
#include "node/tool/contact_groups.h"

namespace palpate {
namespace {

struct EstimateCommand {
  std::string file;
  std::string estimator = "jet";
  EstimatorOptions options;
  FileFlags flags;
};

/// Root mean square of the samples' noise; 0 where one brings none.
double sigma_of(const ContactRun& run, double given_m) {
  double squares = 0.0;
  for (const ContactSample& sample : run.samples) {
    const double sigma = sample.sigma_m > 0.0 ? sample.sigma_m : given_m;
    if (!(sigma > 0.0)) {
      return 0.0;
    }
    squares += sigma * sigma;
  }
  return std::sqrt(squares / static_cast<double>(run.samples.size()));
}

void print_row(const std::string& probe, std::uint32_t patch, std::size_t first,
               const LocalEstimate& estimate) {
  const auto sigma = [&](Eigen::Index k) { return std::sqrt(estimate.covariance(k, k)); };
  std::printf("%s,%u,%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.9g,%.9g,%.9g,%.9g,%d,%.17g\n",
              probe.c_str(), patch, first, estimate.position.x(), estimate.position.y(),
              estimate.tangent_angle, estimate.kappa, estimate.kappa_s, sigma(0), sigma(1),
              sigma(2), sigma(3), estimate.window_samples, estimate.window_arc_m);
}

/// Why a window gives none, and what to do.
std::string_view sentence_of(LocalStatus status) {
  switch (status) {
    case LocalStatus::TooFewSamples:
      return "the window has too few samples (--window)";
    case LocalStatus::NotFinite:
      return "the samples lie too far from the origin";
    case LocalStatus::NoExtent:
      return "the window is no longer than the noise: take a longer one (--window)";
    case LocalStatus::Unresolved:
      return "the window lies at too few different places: take a longer one (--window)";
    case LocalStatus::DoublesBack:
      return "the samples run back by more than the noise, or turn by more than a right angle: "
             "take a longer window where they are dense, else a shorter one (--window)";
    case LocalStatus::TurnsTooFar:
    case LocalStatus::NotFollowed:
      return "the window bends more than the estimator follows: take a shorter one (--window)";
    case LocalStatus::Ok:
      break;
  }
  return "the reason is not known";
}

/// Windows of a file that gave no estimate, by their reason: said once each at the end. A long
/// stroke has millions.
class Refused {
 public:
  void add(const ContactRun& run, const std::string& probe, const WindowResult& window) {
    Reason& reason = reasons_[window.result.status];
    if (reason.windows++ > 0) return;
    reason.first = probe + ", patch " + std::to_string(run.context.patch) + ", sample " +
                   std::to_string(window.first_sample);
  }

  bool any() const { return !reasons_.empty(); }

  void tell() const {
    for (const auto& [status, reason] : reasons_) {
      complain(counted(reason.windows, "window gives", "windows give") + " no estimate, first " +
                   reason.first + ": " + std::string(sentence_of(status)),
               kDone);
    }
  }

 private:
  struct Reason {
    std::size_t windows = 0;
    std::string first;
  };
  std::map<LocalStatus, Reason> reasons_;
};

int run(EstimateCommand& command) {
  const std::optional<EstimatorKind> kind = estimator_kind_from_name(command.estimator);
  if (!kind) {
    return complain("--estimator: \"" + command.estimator +
                        "\" is none of finite-difference, circle, two-round, jet",
                    kUsage);
  }
  command.options.kind = *kind;
  const Result<ContactFile> file = read_contact_file(command.file, options_of(command.flags));
  if (!file) {
    return complain(file.error, kUsage);
  }
  for (const std::string& note : file.value->notes) complain(command.file + ": " + note, kDone);
  std::printf(
      "probe,patch,first_sample,x_m,y_m,tangent_rad,kappa_per_m,kappa_s_per_m2,normal_sigma_m,"
      "tangent_sigma_rad,kappa_sigma_per_m,kappa_s_sigma_per_m2,window_samples,window_arc_m\n");
  Refused refused;
  for (const ContactGroup& group : contact_groups(command.file, file.value->table)) {
    if (const std::string note = note_of_unused_detail(group); !note.empty()) {
      complain(command.file + ": " + note, kDone);
    }
    if (const std::string note = note_of_unused_sigma(group, command.options.sigma_m);
        !note.empty()) {
      complain(command.file + ": " + note, kDone);
    }
    for (const ContactRun& run : joined_runs(group.runs).runs) {
      const std::string& probe = group.probes[run.context.probe];
      std::vector<Vec2> points;
      for (const ContactSample& sample : run.samples) {
        points.push_back(sample.position_m);
      }
      EstimatorOptions options = command.options;
      options.sigma_m = sigma_of(run, command.options.sigma_m);
      if (points.size() < samples_per_estimate(options)) {
        std::cerr << "palpate: " << probe << ", patch " << run.context.patch << ": "
                  << counted(points.size(), "sample") << ", an estimate takes "
                  << samples_per_estimate(options) << " (--window)\n";
        continue;
      }
      for (const WindowResult& window : estimate_all(points, options)) {
        if (window.result) {
          print_row(probe, run.context.patch, window.first_sample, window.result.estimate);
        } else {
          refused.add(run, probe, window);
        }
        if (std::ferror(stdout) != 0) {
          return complain(flush_standard_output(), kFailed);
        }
      }
    }
  }
  refused.tell();
  if (const std::string why = flush_standard_output(); !why.empty()) return complain(why, kFailed);
  return refused.any() ? kFailed : kDone;
}

}  // namespace

void add_estimate_command(CLI::App& app, int& exit_code) {
  auto estimate = std::make_shared<EstimateCommand>();
  CLI::App* command = app.add_subcommand(
      "estimate",
      "Tangent angle, curvature and its derivative by arc length along the patches of a CSV file,\n"
      "with their standard deviations, as CSV. Round tips are not taken off: estimates are of the\n"
      "path of the samples.");
  command->add_option("FILE", estimate->file, "CSV file; - is standard input")
      ->required()
      ->type_name("");
  command
      ->add_option("--estimator", estimate->estimator,
                   "finite-difference, circle, two-round or jet")
      ->capture_default_str()
      ->type_name("NAME");
  command->add_option("--window", estimate->options.window, "Samples of a window")
      ->check(CLI::Range(5, 1000000))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--shift", estimate->options.shift, "Samples from one estimate to the next")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->type_name("L");
  command
      ->add_option("--sigma", estimate->options.sigma_m,
                   "Noise of samples that bring none; 0 = from each window's residuals [m]")
      ->check(number_within(0.0, 1e3))
      ->capture_default_str()
      ->type_name("METRES");
  command->add_option("--degree", estimate->options.jet_degree, "Degree of the jet's polynomial")
      ->check(CLI::Range(3, 5))
      ->capture_default_str()
      ->type_name("D");
  command
      ->add_option("--fits", estimate->options.two_round_fits,
                   "Curvatures that the two-round fit takes its derivative from")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str()
      ->type_name("M");
  add_file_flags(*command, estimate->flags);
  command->callback([estimate, &exit_code] { exit_code = run(*estimate); });
}

}  // namespace palpate
