// All options of the node, and the one table that describes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "node/groups/intake.h"
#include "node/security/peer_guard.h"
#include "node/wire/endpoint.h"
#include "node/wire/recognizer_options.h"

namespace palpate {

struct NodeOptions {
  std::string name = "recognizer";
  std::vector<std::string> contacts{std::string(kDefaultContactsEndpoint)};
  std::vector<std::string> results{std::string(kDefaultResultsEndpoint)};
  /// Listen only to probes whose names begin with one of these; empty = all. Lets several nodes
  /// share the probes of one endpoint.
  std::vector<std::string> probe_prefixes;
  std::vector<std::string> probe_files;  ///< read by ProbeFiles
  std::string curve_secret_key;
  std::string allow_clients;
  bool insecure = false;
  std::uint32_t contacts_high_water_mark = 1000;
  std::uint32_t results_high_water_mark = 1000;
  double probe_timeout_s = 0.5;
  double status_period_s = 1.0;
  std::uint32_t workers = 0;  ///< 0 = number of cores
  bool publish_estimates = true;
  std::string given_class;  ///< resolved into intake.group.given_class
  std::string log_level = "info";
  RecognizerWords words;
  PeerBounds peers;
  IntakeOptions intake;
};

/// The table of options. Calls visit(OptionInfo, field) for every option; `field` is a reference
/// into `options` of type std::string, std::vector<std::string>, bool, std::optional<bool>,
/// std::uint32_t, std::size_t, double, or a duration in seconds (double). To add an option, add a
/// line here and a field in NodeConfig.
template <typename Options, typename Visit>
void for_each_option(Options& options, Visit&& visit) {
  constexpr double kMostMessages = 1e6;
  constexpr double kMostThings = 1e5;
  constexpr double kLongest = 1e6;
  auto& intake = options.intake;
  auto& recognizer = intake.recognizer;
  visit({"name", "Name of the node, as in the topic status/<node>/"}, options.name);
  visit({"contacts", "Endpoint for contacts, [bind:|connect:]ADDRESS; may be repeated"},
        options.contacts);
  visit({"results", "Endpoint for results, [bind:|connect:]ADDRESS; may be repeated"},
        options.results);
  visit({"probe_prefixes",
         "Beginning of the names of probes to listen to; may be repeated; none = all"},
        options.probe_prefixes);
  visit({"probe_files",
         "Probe file of palpate calibrate, for the probe that it names (all others, where it names "
         "none); may be repeated"},
        options.probe_files);
  visit({"curve_secret_key", "CURVE: this node's secret key file"}, options.curve_secret_key);
  visit({"allow_clients", "CURVE: file of the public keys that may connect"},
        options.allow_clients);
  visit({"insecure", "Permit a bind beyond this machine without CURVE"}, options.insecure);
  visit({"contacts_high_water_mark", "Messages that may wait from one probe", 1, kMostMessages},
        options.contacts_high_water_mark);
  visit({"results_high_water_mark", "Messages that may wait for one planner", 1, kMostMessages},
        options.results_high_water_mark);
  visit({"max_peers", "Most connections to each socket", 1, kMostThings}, options.peers.max_peers);
  visit({"max_subscription_bytes",
         "Subscriptions of one planner, 32 bytes counted beside each; of all 16 times as much "
         "[bytes]",
         1024, 1e8},
        options.peers.max_subscription_bytes);
  visit({"max_message_bytes", "Longest contact message [bytes]", 1024, 1e8},
        intake.limits.max_message_bytes);
  visit({"max_samples_per_batch", "Most samples of one message", 1, kMostMessages},
        intake.limits.max_samples_per_batch);
  visit({"max_probes", "Most probes known at a time", 1, kMostThings}, intake.max_probes);
  visit({"max_groups", "Most groups in memory", 1, kMostThings}, intake.groups.max_groups);
  visit({"max_groups_per_probe",
         "Groups a probe may have opened; a further one takes the place of its oldest", 1,
         kMostThings},
        intake.groups.max_groups_per_probe);
  visit({"max_probes_per_group", "Most probes that touch one object", 1, kMostThings},
        intake.group.max_probes_per_group);
  visit({"sequence_by_group",
         "Accept messages in the order of each group alone, as palpate-gateway replays them"},
        intake.sequence_by_group);
  visit({"max_waiting_bytes",
         "Memory of messages that wait for recognition, of all groups together [bytes]", 1 << 16,
         4e9},
        intake.groups.max_waiting_bytes);
  visit({"workers", "Recognitions computed at a time; 0 = as many as there are cores", 0, 1024},
        options.workers);
  visit({"max_coordinate_m", "Largest |x| and |y| [m]", 1e-9, 1e9}, intake.limits.max_coordinate_m);
  visit({"max_sigma_m", "Largest sigma of a sample [m]", 1e-9, 1e9}, intake.limits.max_sigma_m);
  visit({"max_tip_radius_m", "Largest tip radius [m]", 1e-9, 1e9}, intake.limits.max_tip_radius_m);
  visit({"probe_timeout_s", "A probe silent for longer is not alive [s]", 0.05, kLongest},
        options.probe_timeout_s);
  visit({"status_period_s", "Period of NodeStatus, and of repeating the latest results [s]", 0.1,
         3600},
        options.status_period_s);
  visit({"evict_idle_s", "Who is silent for longer may be forgotten to make room [s]", 0, kLongest},
        intake.groups.evict_idle);
  visit({"object_takeover_s",
         "A probe with another object number than its group's is heard after the others' silence "
         "of this [s]",
         0, kLongest},
        intake.group.object_takeover);
  visit({"gap_break_spacings",
         "After lost messages, the hole that breaks the arc [sample spacings]", 0, 1e9},
        intake.group.gap_break_spacings);
  visit({"publish_estimates",
         "Publish local estimates on estimate/<probe>/ while a planner subscribes to any"},
        options.publish_estimates);
  visit(
      {"given_class",
       "Class that all parts are of, e.g. circle: its least squares on all samples, with measured "
       "normals and covariances, in place of a search; empty = the class is sought"},
      options.given_class);
  visit({"log_level", "trace, debug, info, warning, error or off"}, options.log_level);
  for_each_recognizer_option(options.words, recognizer, visit);
}

}  // namespace palpate
