// palpate-sim: plays scenes as the probes of a real cell would. Exit codes: 0 all played, 1 failed
// at run time (no recognizer listens, a file cannot be written), 2 usage or bad input.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "node/client/connection.h"
#include "node/csv/contact_csv.h"
#include "node/files/counted.h"
#include "node/files/overwritten_input.h"
#include "node/files/written_file.h"
#include "node/process/clock.h"
#include "node/process/number_checks.h"
#include "node/process/quiet_protobuf.h"
#include "node/process/stop_signals.h"
#include "node/wire/key_flags.h"
#include "sim/contact_export.h"
#include "sim/contacts.h"
#include "sim/playback.h"
#include "sim/truth.h"

namespace {

using namespace palpate;

enum ExitCode { kPlayed = 0, kFailed = 1, kUsage = 2 };

struct CommandLine {
  std::vector<std::string> scenes;
  std::string contacts{kDefaultContactsEndpoint};
  double speed = 1.0;
  bool fast = false;
  std::uint64_t repeat = 1;
  double pause_s = 0.5;
  double wait_s = 10.0;
  std::uint64_t object = 0;
  std::string csv;
  std::string truth;
  std::string own_key;
  std::string recognizer_key;
  bool quiet = false;
};

void add_options(CLI::App& app, CommandLine& options) {
  app.add_option("SCENE", options.scenes, "Scene files (sim/scenes/*.textproto), played in turn")
      ->required()
      ->type_name("");
  app.add_option("--contacts", options.contacts,
                 "The recognizer's contacts endpoint, [bind:|connect:]ADDRESS")
      ->capture_default_str()
      ->type_name("ENDPOINT");
  app.add_option("--speed", options.speed, "Times as fast as the scene's own time")
      ->check(positive_number())
      ->capture_default_str()
      ->type_name("FACTOR");
  app.add_flag("--fast", options.fast, "As fast as possible");
  app.add_option(
         "--repeat", options.repeat,
         "Play all scenes so many times, each time a new object with new noise; 0 = for ever")
      ->check(counting_number())
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--pause", options.pause_s, "Seconds between two scenes")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--wait", options.wait_s,
                 "Seconds to wait for a recognizer, or with --fast for room, before giving up")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--object", options.object,
                 "Number of the first object; the others follow. Default: the scene's own, or else "
                 "one that was never used before (1 with --csv)")
      ->check(counting_number())
      ->type_name("N");
  app.add_option(
         "--csv", options.csv,
         "Write the samples to FILE (- = standard output) for `palpate fit`, publish nothing")
      ->type_name("FILE");
  app.add_option(
         "--truth", options.truth,
         "Write class, parameters and pose to FILE (- = standard output), one JSON line for "
         "each group and object")
      ->type_name("FILE");
  add_key_flags(app, options.own_key, "CURVE: this probe's secret key file (palpate keygen)",
                options.recognizer_key, "CURVE: the recognizer's public key file");
  app.add_flag("--quiet", options.quiet, "Say nothing unless it fails");
}

/// A file, or standard output for "-".
class Output {
 public:
  /// What is wrong, or nothing.
  std::string open(const std::string& path) {
    path_ = path;
    if (path == "-" || path.empty()) return {};
    errno = 0;
    file_.open(path, std::ios::binary | std::ios::trunc);
    return file_ ? std::string() : cannot_be_written(path);
  }

  /// What is wrong, or nothing.
  std::string write(const std::string& text) {
    if (path_.empty()) return {};
    errno = 0;
    if (path_ == "-") {
      std::cout << text;
      return flush_standard_output();
    }
    return file_ << text << std::flush ? std::string() : cannot_be_written(path_);
  }

 private:
  std::string path_;
  std::ofstream file_;
};

/// The numbers of the objects, in the order in which they are played.
class ObjectNumbers {
 public:
  ObjectNumbers(const CLI::App& app, const CommandLine& options) {
    if (app.count("--object") > 0) {
      next_ = options.object;
      given_ = true;
    } else {
      next_ = options.csv.empty() ? static_cast<std::uint64_t>(unix_time_ns() / 1'000'000) : 1;
    }
  }

  std::uint64_t next(const sim::Scene& scene) {
    // A scene's own number is used the first time only: after that it would be the same object.
    if (!given_ && scene.description.has_object() &&
        (!started_ || scene.description.object() >= next_)) {
      next_ = scene.description.object();
    }
    started_ = true;
    return next_++;
  }

 private:
  std::uint64_t next_ = 1;
  bool given_ = false;
  bool started_ = false;
};

std::string summary(const sim::Scene& scene, const sim::PlaybackCounts& counts,
                    std::uint64_t object) {
  return scene.name + ": object " + std::to_string(object) + ", " + std::to_string(counts.samples) +
         " samples in " + std::to_string(counts.messages) + " messages" +
         (counts.refused > 0 ? ", " + std::to_string(counts.refused) + " not taken" : "") + "\n";
}

struct Player {
  const CommandLine& options;
  ObjectNumbers numbers;
  Output truth;
  int stop_fd;

  /// Writes the truth. What is wrong, or nothing.
  std::string tell_truth(const sim::Scene& scene, std::span<const sim::SimulatedProbe> probes,
                         std::uint64_t object) {
    for (const v1::SceneTruth& line : sim::scene_truths(scene, probes, object)) {
      if (std::string why = truth.write(sim::to_json(line) + "\n"); !why.empty()) return why;
    }
    return {};
  }

  int export_csv(const std::vector<sim::Scene>& scenes) {
    ContactTable table;
    for (std::uint64_t round = 0; round < options.repeat; ++round) {
      for (const sim::Scene& scene : scenes) {
        const std::vector<sim::SimulatedProbe> probes = sim::simulate_contacts(scene, round);
        const std::uint64_t object = numbers.next(scene);
        sim::append_rows(scene, probes, object, table);
        if (const std::string why = tell_truth(scene, probes, object); !why.empty()) {
          return failed(why);
        }
      }
    }
    Output csv;
    std::string why = csv.open(options.csv);
    if (why.empty()) why = csv.write(to_csv(table));
    return why.empty() ? kPlayed : failed(why);
  }

  int publish(const std::vector<sim::Scene>& scenes) {
    client::ContactPublisherOptions publisher_options;
    publisher_options.endpoint = options.contacts;
    publisher_options.all_readers_or_none = options.fast;
    if (!options.own_key.empty()) {
      Result<CurveClient> curve =
          client::read_curve_client(options.own_key, options.recognizer_key);
      if (!curve) {
        complain(curve.error);
        return kUsage;
      }
      publisher_options.curve = *curve.value;
    }
    client::ContactPublisher publisher(publisher_options);
    if (const int code = wait_for_recognizer(publisher); code != kPlayed) return code;
    const auto pause = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(options.pause_s));
    const auto say = [&](const std::string& news) {
      if (!options.quiet) complain("the recognizer at " + options.contacts + " " + news);
    };
    std::uint64_t refused = 0;
    for (std::uint64_t round = 0; options.repeat == 0 || round < options.repeat; ++round) {
      for (const sim::Scene& scene : scenes) {
        const bool is_first = round == 0 && &scene == &scenes.front();
        if (!is_first && stop_requested_before(now_steady() + pause, stop_fd)) {
          return code_of(refused, publisher);
        }
        const std::vector<sim::SimulatedProbe> probes = sim::simulate_contacts(scene, round);
        const std::uint64_t object = numbers.next(scene);
        if (const std::string why = tell_truth(scene, probes, object); !why.empty()) {
          return failed(why);
        }
        std::vector<sim::TimedBatch> batches = sim::make_batches(scene, probes, object);
        const sim::PlaybackCounts counts =
            sim::play(batches, probes, options.fast ? 0.0 : options.speed, options.wait_s, stop_fd,
                      publisher, say);
        if (!options.quiet) std::cerr << summary(scene, counts, object);
        refused += counts.refused;
        if (counts.stopped || (options.fast && refused > 0)) return code_of(refused, publisher);
      }
    }
    if (refused == 0 && publisher.recognizer_has_gone()) {
      return failed("the recognizer at " + options.contacts +
                    " has gone: what was published since is lost");
    }
    publisher.finish_within();
    return code_of(refused, publisher);
  }

  int code_of(std::uint64_t refused, const client::ContactPublisher& publisher) const {
    if (refused > 0) {
      return failed(counted(refused, "message") + " not taken: the recognizer at " +
                    options.contacts + " is behind or has gone");
    }
    if (const std::uint64_t lost = publisher.published_to_nobody(); lost > 0) {
      return failed(counted(lost, "message") + " lost: nobody listened at " + options.contacts);
    }
    return kPlayed;
  }

  /// Waits in short steps, so that a stop signal is noticed.
  int wait_for_recognizer(client::ContactPublisher& publisher) const {
    constexpr double kStepS = 0.05;
    for (double waited_s = 0.0;; waited_s += kStepS) {
      if (publisher.wait_for_recognizer(std::chrono::milliseconds(50))) return kPlayed;
      if (!publisher.refusal().empty()) {
        return failed("the recognizer at " + options.contacts + " " + publisher.refusal());
      }
      if (stop_requested(stop_fd)) return kPlayed;
      if (waited_s >= options.wait_s) {
        return failed("no recognizer listens at " + options.contacts + " (start palpate-node)");
      }
    }
  }

  static void complain(const std::string& why) { std::cerr << "palpate-sim: " << why << "\n"; }

  static int failed(const std::string& why) {
    complain(why);
    return kFailed;
  }
};

int run(const CLI::App& app, const CommandLine& options) {
  const std::vector<std::string> written{options.csv, options.truth};
  std::string why = overwrites_output(written);
  for (const std::string& path : written) {
    if (why.empty()) why = overwrites_input(path, options.scenes);
  }
  if (why.empty() && options.repeat == 0 && !options.csv.empty()) {
    why = "--repeat 0 is for ever, and --csv writes a file";
  }
  if (!why.empty()) {
    std::cerr << "palpate-sim: " << why << "\n";
    return kUsage;
  }
  std::vector<sim::Scene> scenes;
  for (const std::string& path : options.scenes) {
    Result<sim::Scene> scene = sim::read_scene(path);
    if (!scene) {
      std::cerr << scene.error << "\n";
      return kUsage;
    }
    scenes.push_back(std::move(*scene.value));
  }
  Player player{options, ObjectNumbers(app, options), {}, take_stop_signals()};
  if (why = player.truth.open(options.truth); !why.empty()) return Player::failed(why);
  return options.csv.empty() ? player.publish(scenes) : player.export_csv(scenes);
}

}  // namespace

int main(int argc, char** argv) {
  silence_protobuf();
  CLI::App app(
      "Simulates touch probes: publishes the contacts of scenes, or writes them to a file.\n"
      "Exit codes: 0 all played (or stopped as asked), 1 failed at run time, 2 usage or bad input.",
      "palpate-sim");
  app.set_version_flag("--version", PALPATE_VERSION);
  CommandLine options;
  app.option_defaults()->disable_flag_override();  // --quiet=maybe is a mistake
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kPlayed : kUsage;
  }
  try {
    return run(app, options);
  } catch (const std::exception& error) {
    return Player::failed(error.what());
  }
}
