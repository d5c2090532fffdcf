// Writes scenes for palpate and its peers, and palpate's answers to them: peer_scenes FOLDER
//   points.csv   the samples of all scenes
//   truth.csv    the true curves
//   palpate.csv  the answer to each scene, all classes considered (cold), and with the class given
// Letters of the shape: parameter_letters(class). A scene of an ellipse arc is one stretch of that
// many degrees of the eccentric angle; the other scenes are two patches anywhere on the part.
// "Class given" means RecognizerOptions::classes: the other classes are still fitted to the reduced
// points, but take no further part.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/scene_data.h"

namespace palpate {
namespace {

struct Options {
  std::filesystem::path folder;
  std::uint64_t seed = 20240607;
  int scenes = 40;      ///< of each kind and noise
  int repetitions = 5;  ///< of each timed recognition
};

/// What is touched and how.
struct Kind {
  std::string name;
  CurveClass curve_class = CurveClass::Ellipse;
  int arc_deg = 0;  ///< of an ellipse touched in one stretch; 0 = two patches anywhere
};

struct PeerScene {
  const Kind* kind = nullptr;
  double noise = 0.0;
  test::Scene scene;
};

struct Timed {
  Recognition answer;
  double seconds = 0.0;
};

/// The answer of a new recognizer and the median of its times, including passing the samples.
Timed recognise(const test::Scene& scene, const RecognizerOptions& options, int repetitions) {
  Timed timed;
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    timed.answer = test::recognise(scene, scene.sigma_m, options);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    seconds.push_back(taken.count());
  }
  const auto middle = seconds.begin() + repetitions / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  timed.seconds = *middle;
  return timed;
}

/// With the fewest digits that give the same number when read back.
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// The shape in columns a, b, c, and the pose; empty fields if there is none.
void write_shape(std::ostream& out, const ShapeParameters& shape, const Pose2& pose) {
  const std::string_view letters = parameter_letters(shape.curve_class);
  for (const char letter : std::string_view("abc")) {
    out << ',';
    if (const auto i = letters.find(letter); i != std::string_view::npos) {
      out << number(shape.values[static_cast<Eigen::Index>(i)]);
    }
  }
  if (shape.curve_class == CurveClass::Unclassified) {
    out << ",,,";
  } else {
    out << ',' << number(pose.x) << ',' << number(pose.y) << ',' << number(pose.theta);
  }
}

std::string_view name_of_status(RecognitionStatus status) {
  switch (status) {
    case RecognitionStatus::Recognized:
      return "recognized";
    case RecognitionStatus::Ambiguous:
      return "ambiguous";
    default:
      return "collecting";
  }
}

std::ofstream open(const std::filesystem::path& path) {
  std::ofstream out(path);
  if (!out) {
    throw std::runtime_error("cannot write " + path.string());
  }
  return out;
}

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const int arc : {60, 90, 120, 180, 360}) {
    all.push_back({"ellipse_arc_" + std::to_string(arc), CurveClass::Ellipse, arc});
  }
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Parabola,
                                       CurveClass::Hyperbola, CurveClass::CubicalParabola}) {
    all.push_back({std::string(name_of(curve_class)) + "_two_patches", curve_class, 0});
  }
  return all;
}

std::vector<PeerScene> make_scenes(const std::vector<Kind>& kinds, const Options& options) {
  std::mt19937_64 rng(options.seed);
  std::vector<PeerScene> scenes;
  for (const Kind& kind : kinds) {
    for (const double noise : {1e-5, 1e-4, 1e-3, 2e-3}) {
      for (int i = 0; i < options.scenes; ++i) {
        test::SceneOptions how;
        how.sigma_over_size = noise;
        if (kind.arc_deg == 360) {
          how.patches = 1;
          how.points_per_patch = 222;
        }
        scenes.push_back({&kind, noise,
                          kind.arc_deg > 0
                              ? test::random_ellipse_arc(kind.arc_deg * kPi / 180.0, how, rng)
                              : test::random_scene(kind.curve_class, how, rng)});
      }
    }
  }
  return scenes;
}

void write_points(const std::vector<PeerScene>& scenes, std::ostream& out) {
  out << "scene,curve_class,noise_over_size,patch,x_m,y_m,sigma_m\n";
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const PeerScene& s = scenes[i];
    for (std::size_t patch = 0; patch < s.scene.patches.size(); ++patch) {
      for (const Vec2& p : s.scene.patches[patch]) {
        out << i << ',' << name_of(s.kind->curve_class) << ',' << number(s.noise) << ',' << patch
            << ',' << number(p.x()) << ',' << number(p.y()) << ',' << number(s.scene.sigma_m)
            << '\n';
      }
    }
  }
}

void write_truth(const std::vector<PeerScene>& scenes, std::ostream& out) {
  out << "scene,kind,noise_over_size,class,a,b,c,x,y,theta\n";
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const PeerScene& s = scenes[i];
    out << i << ',' << s.kind->name << ',' << number(s.noise) << ','
        << name_of(s.kind->curve_class);
    write_shape(out, {s.kind->curve_class, s.scene.values}, s.scene.world_T_curve);
    out << '\n';
  }
}

void write_answers(const std::vector<PeerScene>& scenes, int repetitions, std::ostream& out) {
  out << "scene,class,status,doubt,a,b,c,x,y,theta,seconds,"
         "given_status,given_a,given_b,given_c,given_x,given_y,given_theta,given_seconds\n";
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const test::Scene& scene = scenes[i].scene;
    const Timed all = recognise(scene, {}, repetitions);
    RecognizerOptions options;
    options.classes = 1U << static_cast<unsigned>(scene.curve_class);
    const Timed given = recognise(scene, options, repetitions);
    // "Unclassified" remains a rival when one class is given; here the hypothesis of that class
    // counts.
    const Hypothesis* hypothesis = test::hypothesis_of(given.answer, scene.curve_class);
    out << i << ',' << name_of(all.answer.shape.curve_class) << ','
        << name_of_status(all.answer.status) << ',' << name_of(all.answer.doubt);
    write_shape(out, all.answer.shape, all.answer.world_T_curve);
    out << ',' << number(all.seconds) << ',' << name_of_status(given.answer.status);
    write_shape(out, hypothesis ? hypothesis->shape : ShapeParameters(),
                hypothesis ? hypothesis->world_T_curve : Pose2());
    out << ',' << number(given.seconds) << '\n';
  }
}

int usage() {
  std::cerr << "usage: peer_scenes FOLDER [--scenes N] [--repetitions N] [--seed N]\n";
  return 2;
}

template <typename T>
bool parse(const char* text, T* value) {
  const char* end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, *value);
  return error == std::errc() && stop == end && *value > 0;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (argument == "--scenes" || argument == "--repetitions" || argument == "--seed") {
      const bool good = argument == "--scenes"        ? parse(value, &options.scenes)
                        : argument == "--repetitions" ? parse(value, &options.repetitions)
                                                      : parse(value, &options.seed);
      if (!good) {
        std::cerr << "peer_scenes: " << argument << " needs a positive whole number, not '" << value
                  << "'\n";
        return 2;
      }
      ++i;
    } else if (options.folder.empty() && !argument.starts_with('-')) {
      options.folder = argument;
    } else {
      return usage();
    }
  }
  if (options.folder.empty()) {
    return usage();
  }
  try {
    std::filesystem::create_directories(options.folder);
    const std::vector<Kind> all = kinds();
    const std::vector<PeerScene> scenes = make_scenes(all, options);
    auto points = open(options.folder / "points.csv");
    write_points(scenes, points);
    auto truth = open(options.folder / "truth.csv");
    write_truth(scenes, truth);
    auto answers = open(options.folder / "palpate.csv");
    write_answers(scenes, options.repetitions, answers);
    if (!points.flush() || !truth.flush() || !answers.flush()) {
      throw std::runtime_error("cannot write to " + options.folder.string());
    }
    std::printf("%zu scenes, %d of each kind and noise, seed %llu, median of %d recognitions\n",
                scenes.size(), options.scenes, static_cast<unsigned long long>(options.seed),
                options.repetitions);
  } catch (const std::exception& error) {
    std::cerr << "peer_scenes: " << error.what() << '\n';
    return 1;
  }
}
