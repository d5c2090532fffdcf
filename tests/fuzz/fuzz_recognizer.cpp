// Any bytes as options, patches and samples of the recogniser: every answer keeps the invariants
// (tests/support/answer_invariants.h), cold, warm, and after a reset.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/fuzz/byte_reader.h"
#include "tests/support/answer_invariants.h"

namespace {

using namespace palpate;

/// Few samples, so that many inputs are tried in a minute even under the sanitizers: what the work
/// grows to is bench_worst_case's to find.
constexpr std::size_t kMostSamples = 120;
constexpr int kMostPatches = 10;
constexpr int kMostSamplesOfAPatch = 48;
/// Powers of ten of lengths in metres; squares of the extreme ones leave the range of a double.
constexpr double kUsualPower = 4.0;
constexpr double kExtremePower = 160.0;

RecognizerOptions options_from(ByteReader& bytes) {
  RecognizerOptions options;
  const int choices = bytes.byte();
  if ((choices & 1) != 0) {
    options.sigma_m = bytes.power_of_ten(kUsualPower, 15.0);
  }
  if ((choices & 2) != 0) {
    options.form_deviation_m = bytes.power_of_ten(kUsualPower, 15.0);
  }
  if ((choices & 4) != 0) {
    options.classes = static_cast<unsigned>(bytes.byte()) << 1U;
  }
  if ((choices & 64) != 0) options.unqualified_probe = true;  // else by the noise
  if ((choices & 8) != 0) {
    options.recognized_probability = 0.75 + 0.249 * bytes.unit();
  }
  if ((choices & 16) != 0) {
    options.memory.most_samples_per_patch = kFewestMeans + static_cast<std::size_t>(bytes.byte());
    options.memory.most_patches = 1 + static_cast<std::size_t>(bytes.below(kMostPatches));
  }
  if ((choices & 32) != 0) {
    options.touched_from = (choices & 128) != 0 ? TouchedFrom::Inside : TouchedFrom::Outside;
  }
  if ((choices & 0xe0) == 0xe0) {
    options.method = RecognitionMethod::Tree;
  }
  return options;
}

/// A stroke of falling Taylor coefficients of its direction, with noise, repeats and spikes from
/// the bytes.
std::vector<ContactSample> samples_from(ByteReader& bytes, double size_m, const Vec2& origin) {
  std::vector<ContactSample> samples;
  const int count = 1 + bytes.below(kMostSamplesOfAPatch);
  const int kind = bytes.byte();
  const double sigma_m = (kind & 1) != 0 ? size_m * bytes.power_of_ten(6.0, 20.0) : 0.0;
  const double noise = (kind & 2) != 0 ? std::pow(10.0, -6.0 + 5.0 * bytes.unit()) : 0.0;
  const bool raw = (kind & 4) != 0;
  double heading = kPi * bytes.unit();
  double turn = 0.2 * bytes.unit();
  const double turn_rate = 0.01 * bytes.unit();
  const double step = std::pow(10.0, -1.5 + 1.5 * bytes.unit());
  Vec2 place(bytes.unit(), bytes.unit());
  std::uint32_t random = 1U + bytes.byte();
  const auto pseudo = [&random] {
    random = 1664525U * random + 1013904223U;
    return static_cast<double>(random >> 8U) / 8388608.0 - 1.0;
  };
  for (int i = 0; i < count; ++i) {
    Vec2 position = place;
    if (raw) {
      const double x = bytes.unit();
      position = {x, bytes.unit()};
    } else {
      const double dx = pseudo();
      position += noise * Vec2(dx, pseudo());
    }
    if ((kind & 8) != 0) {
      // Repeats of a place and of the one before it, and spikes, where the bytes say.
      const int event = bytes.below(8);
      if (event == 7 && !samples.empty()) {
        samples.push_back(samples[samples.size() - std::min<std::size_t>(samples.size(), 2)]);
        continue;
      }
      if (event == 6) {
        const double x = bytes.unit();
        position += Vec2(x, bytes.unit());
      }
    }
    samples.push_back({origin + size_m * position, sigma_m, 0});
    place += step * Vec2(std::cos(heading), std::sin(heading));
    heading += turn;
    turn += turn_rate;
  }
  return samples;
}

/// Sound ones and others, of any size; a sample in four has none.
std::vector<SampleDetail> details_from(ByteReader& bytes, std::size_t count, double size_m) {
  std::vector<SampleDetail> details(count);
  for (SampleDetail& detail : details) {
    const int kind = bytes.below(4);
    if ((kind & 1) != 0) {
      const double angle = kPi * bytes.unit();
      detail.normal =
          bytes.below(8) == 7 ? Vec2(angle, angle) : as_unit({std::cos(angle), std::sin(angle)});
      detail.normal_sigma_rad = bytes.power_of_ten(2.0, 300.0);
    }
    if ((kind & 2) != 0) {
      const double xx = std::pow(size_m * bytes.power_of_ten(4.0, 100.0), 2.0);
      const double yy = std::pow(size_m * bytes.power_of_ten(4.0, 100.0), 2.0);
      detail.covariance_m2 = {xx, bytes.unit() * std::sqrt(xx * yy), yy};
    }
  }
  return details;
}

void check(const Recognition& answer, const std::vector<Vec2>& positions) {
  const std::string broken = test::broken_invariant(answer, test::places_of(positions));
  if (!broken.empty()) {
    std::fprintf(stderr, "fuzz_recognizer: %s\n", broken.c_str());
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  const RecognizerOptions options = options_from(bytes);
  Recognizer recognizer(options);
  const double size_m = bytes.power_of_ten(kUsualPower, kExtremePower);
  const double far = bytes.below(4) == 3 ? bytes.power_of_ten(6.0, 16.0) : 0.0;
  const double x = bytes.unit();
  const Vec2 origin = size_m * far * Vec2(x, bytes.unit());
  std::vector<Vec2> positions;
  // What the memory has forgotten or merged still bounds the distinct places from above.
  for (int p = 0; p < kMostPatches && !bytes.empty() && positions.size() < kMostSamples; ++p) {
    const int choices = bytes.byte();
    PatchContext context;
    context.probe = static_cast<std::uint32_t>(choices & 1);
    context.patch =
        (choices & 2) != 0 ? static_cast<std::uint32_t>(p / 2) : static_cast<std::uint32_t>(p);
    if ((choices & 4) != 0) {
      context.tip_radius_m = size_m * bytes.power_of_ten(2.0, 12.0);
      context.material_side = static_cast<MaterialSide>(bytes.below(3));
    }
    const std::vector<ContactSample> samples = samples_from(bytes, size_m, origin);
    const std::vector<SampleDetail> details = (choices & 0x48) == 0x48
                                                  ? details_from(bytes, samples.size(), size_m)
                                                  : std::vector<SampleDetail>();
    recognizer.add(context, samples, details);
    for (const ContactSample& sample : samples) {
      if (sample.position_m.allFinite()) positions.push_back(sample.position_m);
    }
    if ((choices & 0x30) == 0x30) {
      check(recognizer.recognize(), positions);
    }
    if (choices == 0xff) {
      recognizer.reset();
      positions.clear();
    }
  }
  check(recognizer.recognize(), positions);
  check(recognizer.recognize(), positions);  // once more, from the answer before
  return 0;
}
