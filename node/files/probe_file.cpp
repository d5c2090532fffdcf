#include "node/files/probe_file.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>
#include <utility>

#include "core/qualification/estimated_tip.h"
#include "node/files/text_format.h"

namespace palpate {
namespace {

using google::protobuf::TextFormat;

/// Checks a probe file and keeps the first error.
class ProbeCheck {
 public:
  ProbeCheck(const v1::Probe& probe, const TextFormat::ParseInfoTree& tree, std::string file)
      : probe_(probe), tree_(tree), file_(std::move(file)) {}

  std::optional<ProbeCharacter> check() {
    ProbeCharacter character;
    character.tip_radius_m = probe_.tip_radius_m();
    if (!(std::isfinite(character.tip_radius_m) && character.tip_radius_m >= 0.0)) {
      return fail("tip_radius_m", "must be a number >= 0");
    }
    if (!harmonics(character.offset) || !covariance(character.offset)) return std::nullopt;
    if (!estimate(probe_.sigma_m(), "sigma_m", character.sigma_m) ||
        !estimate(probe_.deviation_m(), "deviation_m", character.deviation_m) ||
        !estimate(probe_.deviation_length_m(), "deviation_length_m",
                  character.deviation_length_m) ||
        !estimate(probe_.spike_probability(), "spike_probability", character.spike_probability) ||
        !estimate(probe_.setup_m(), "setup_m", character.setup_m)) {
      return std::nullopt;
    }
    if (character.spike_probability.value > 1.0) {
      return fail("spike_probability", "value must be a probability, 0 to 1");
    }
    if (!(character.deviation_length_m.value > 0.0)) {
      const bool deviates =
          character.deviation_m.value > 0.0 || character.deviation_m.deviation > 0.0;
      if (deviates) {
        return fail(probe_.has_deviation_length_m() ? "deviation_length_m" : "deviation_m",
                    "deviation_m needs a deviation_length_m whose value is > 0");
      }
      character.deviation_length_m.value = 1.0;  // no deviation: any length will do
    }
    if (probe_.has_lag_m()) {
      const v1::ProbeEstimate& lag = probe_.lag_m();
      if (!std::isfinite(lag.value()) ||
          !(std::isfinite(lag.deviation()) && lag.deviation() >= 0)) {
        return fail("lag_m", "must be numbers, the deviation >= 0");
      }
      character.lag_m = Estimate{lag.value(), lag.deviation()};
    }
    if (const char* field = missing()) {
      error_ = file_ + ": " + field +
               ": is missing, which palpate calibrate always writes: the file is incomplete";
      return std::nullopt;
    }
    return with_estimated_tip(std::move(character));
  }

  const std::string& error() const { return error_; }

 private:
  /// The first field that is not there but is in every file of `palpate calibrate`. What is cut off
  /// would else count as zero: a noise and an uncertainty that nobody measured. The last of them is
  /// the last line of a file.
  const char* missing() const {
    if (probe_.artefact().empty()) return "artefact";
    if (probe_.sample_count() == 0) return "sample_count";
    if (probe_.verdict() == v1::QUALIFICATION_VERDICT_UNSPECIFIED) return "verdict";
    if (probe_.offset_covariance_m2().empty()) return "offset_covariance_m2";
    if (!probe_.has_sigma_m()) return "sigma_m";
    if (!probe_.has_deviation_m()) return "deviation_m";
    if (!probe_.has_deviation_length_m()) return "deviation_length_m";
    if (!probe_.has_spike_probability()) return "spike_probability";
    return probe_.has_setup_m() ? nullptr : "setup_m";
  }

  std::nullopt_t fail(const char* field, const std::string& why, int index = -1) {
    const auto* descriptor = probe_.GetDescriptor()->FindFieldByName(field);
    // protobuf aborts if GetLocation gets a repeated field without an index.
    const int line =
        descriptor->is_repeated() && index < 0 ? -1 : tree_.GetLocation(descriptor, index).line;
    error_ = file_ + ":" + std::to_string(line < 0 ? 1 : line + 1);
    error_.append(": ").append(field);
    if (index >= 0) error_.append("[").append(std::to_string(index)).append("]");
    error_.append(": ").append(why);
    return std::nullopt;
  }

  bool estimate(const v1::ProbeEstimate& read, const char* field, Estimate& estimate) {
    const auto good = [](double v) { return std::isfinite(v) && v >= 0.0; };
    if (!good(read.value()) || !good(read.deviation())) {
      fail(field, "value and deviation must be numbers >= 0");
      return false;
    }
    estimate = {read.value(), read.deviation()};
    return true;
  }

  bool harmonics(NormalOffset& offset) {
    constexpr int kMostHarmonics = 64;
    if (!std::isfinite(probe_.offset_m())) {
      fail("offset_m", "must be a number");
      return false;
    }
    const int count = probe_.harmonics_size();
    if (count > kMostHarmonics) {
      fail("harmonics", "more than " + std::to_string(kMostHarmonics), kMostHarmonics);
      return false;
    }
    offset.order = count == 0 ? 0 : count + 1;
    offset.coefficients_m = Eigen::VectorXd::Zero(offset_coefficients(offset.order));
    offset.coefficients_m[0] = probe_.offset_m();
    for (int i = 0; i < count; ++i) {
      const v1::ProbeHarmonic& harmonic = probe_.harmonics(i);
      if (harmonic.order() != static_cast<std::uint32_t>(i) + 2) {
        fail("harmonics", "order must be " + std::to_string(i + 2) + ": from 2 on, none left out",
             i);
        return false;
      }
      if (!std::isfinite(harmonic.cosine_m()) || !std::isfinite(harmonic.sine_m())) {
        fail("harmonics", "cosine_m and sine_m must be numbers", i);
        return false;
      }
      offset.coefficients_m[2 * i + 1] = harmonic.cosine_m();
      offset.coefficients_m[2 * i + 2] = harmonic.sine_m();
    }
    return true;
  }

  bool covariance(NormalOffset& offset) {
    const Eigen::Index size = offset.coefficients_m.size();
    offset.covariance_m2 = Eigen::MatrixXd::Zero(size, size);
    const int count = probe_.offset_covariance_m2_size();
    if (count == 0) return true;  // missing
    if (count != size * size) {
      fail("offset_covariance_m2",
           "must be " + std::to_string(size * size) + " numbers, " + std::to_string(size) +
               " rows of as many, not " + std::to_string(count),
           0);
      return false;
    }
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index j = 0; j < size; ++j) {
        offset.covariance_m2(i, j) = probe_.offset_covariance_m2(static_cast<int>(i * size + j));
      }
    }
    if (!offset.covariance_m2.allFinite()) {
      fail("offset_covariance_m2", "must be numbers", 0);
      return false;
    }
    // Tolerance for asymmetry, relative to the largest entry: the decimals of a file are rounded.
    constexpr double kRounding = 1e-9;
    const double largest = offset.covariance_m2.cwiseAbs().maxCoeff();
    const Eigen::MatrixXd& matrix = offset.covariance_m2;
    const bool symmetric =
        (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kRounding * largest;
    const Eigen::MatrixXd ridge = kRounding * largest * Eigen::MatrixXd::Identity(size, size);
    if (!symmetric || (largest > 0.0 && (matrix + ridge).llt().info() != Eigen::Success)) {
      fail("offset_covariance_m2", "is no covariance: symmetric, no variance negative", 0);
      return false;
    }
    return true;
  }

  const v1::Probe& probe_;
  const TextFormat::ParseInfoTree& tree_;
  std::string file_;
  std::string error_;
};

void set(const Estimate& estimate, v1::ProbeEstimate& out) {
  out.set_value(estimate.value);
  out.set_deviation(estimate.deviation);
}

}  // namespace

Result<QualifiedProbe> parse_probe(const std::string& text, const std::string& name) {
  QualifiedProbe probe;
  probe.file = name;
  TextFormat::ParseInfoTree tree;
  if (const std::string error = parse_text(text, name, probe.described, &tree); !error.empty()) {
    return Result<QualifiedProbe>::fail(
        in_words(error, name,
                 "this is no line of a probe file; palpate calibrate --output writes probe files"));
  }
  ProbeCheck check(probe.described, tree, name);
  std::optional<ProbeCharacter> character = check.check();
  if (!character) return Result<QualifiedProbe>::fail(check.error());
  probe.character = *std::move(character);
  return Result<QualifiedProbe>::ok(std::move(probe));
}

Result<QualifiedProbe> read_probe(const std::string& path) {
  const Result<std::string> text = read_file(path);
  return text ? parse_probe(*text.value, path) : Result<QualifiedProbe>::fail(text.error);
}

void to_wire(const ProbeCharacter& character, v1::Probe& probe) {
  probe.set_tip_radius_m(character.tip_radius_m);
  const Eigen::VectorXd& coefficients = character.offset.coefficients_m;
  probe.set_offset_m(coefficients[0]);
  probe.clear_harmonics();
  for (int order = 2; order <= character.offset.order; ++order) {
    v1::ProbeHarmonic& harmonic = *probe.add_harmonics();
    harmonic.set_order(static_cast<std::uint32_t>(order));
    harmonic.set_cosine_m(coefficients[2 * order - 3]);
    harmonic.set_sine_m(coefficients[2 * order - 2]);
  }
  probe.clear_offset_covariance_m2();
  const Eigen::MatrixXd& covariance = character.offset.covariance_m2;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
      probe.add_offset_covariance_m2(0.5 * (covariance(i, j) + covariance(j, i)));
    }
  }
  set(character.sigma_m, *probe.mutable_sigma_m());
  set(character.deviation_m, *probe.mutable_deviation_m());
  set(character.deviation_length_m, *probe.mutable_deviation_length_m());
  set(character.spike_probability, *probe.mutable_spike_probability());
  set(character.setup_m, *probe.mutable_setup_m());
  probe.clear_lag_m();
  if (character.lag_m) set(*character.lag_m, *probe.mutable_lag_m());
}

std::string probe_text(const v1::Probe& probe) {
  std::string text;
  TextFormat::PrintToString(probe, &text);
  return "# A qualified probe: palpate/v1/probe.proto says what each field is.\n" + text;
}

}  // namespace palpate
