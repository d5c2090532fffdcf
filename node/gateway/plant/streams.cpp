#include "node/gateway/plant/streams.h"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace palpate::gateway {
namespace {

using nlohmann::json;

constexpr double kNanosecondsPerSecond = 1e9;
// The status of one node or gateway over the last hour, at one message per second.
constexpr int kStatusMessages = 3600;
// JSStreamNameExistErr: the stream exists with other limits. Whoever created it decides them.
constexpr int kExistsOtherwise = 10058;
constexpr std::chrono::milliseconds kLookupTimeout{500};

std::string stream(std::string_view cell, const char* kind) {
  return "palpate-" + to_token(cell) + "-" + kind;
}

void read(Plant& plant, const void* owner, const std::string& stream, const json& query,
          Plant::Handler handler) {
  plant.request(owner, "$JS.API.DIRECT.GET." + stream, query.dump(), {}, kLookupTimeout,
                std::move(handler));
}

json common(const std::string& name, json subjects, const StreamLimits& limits) {
  return {{"name", name},
          {"subjects", std::move(subjects)},
          {"retention", "limits"},
          {"discard", "old"},
          {"storage", "file"},
          {"num_replicas", limits.replicas},
          {"max_bytes", limits.max_bytes},
          {"max_msgs", -1},
          {"max_consumers", -1},
          {"allow_direct", true},
          {"duplicate_window",
           static_cast<std::int64_t>(limits.duplicate_window_s * kNanosecondsPerSecond)}};
}

}  // namespace

std::string contact_stream(std::string_view cell) { return stream(cell, "contact"); }
std::string recognition_stream(std::string_view cell) { return stream(cell, "recognition"); }
std::string status_stream(std::string_view cell) { return stream(cell, "status"); }

void make_streams(Plant& plant, const void* owner, const std::string& cell,
                  const StreamLimits& limits, const std::function<void(const std::string&)>& done) {
  json contacts = common(contact_stream(cell), {make_subject(cell, "contact") + ".>"}, limits);
  constexpr double kSecondsPerHour = 3600.0;
  contacts["max_age"] = static_cast<std::int64_t>(limits.contacts_max_age_h * kSecondsPerHour *
                                                  kNanosecondsPerSecond);
  // No maximum age: the last answer of a group shows how far its recognition has come.
  json recognitions =
      common(recognition_stream(cell), {make_subject(cell, "recognition") + ".>"}, limits);
  json status =
      common(status_stream(cell),
             {make_subject(cell, "status") + ".>", make_subject(cell, "gateway") + ".>"}, limits);
  status["max_msgs_per_subject"] = kStatusMessages;
  struct Count {
    int left = 3;
    std::string error;
  };
  const auto count = std::make_shared<Count>();
  for (const json& config : {contacts, recognitions, status}) {
    plant.api(owner, "STREAM.CREATE." + config["name"].get<std::string>(), config,
              [count, done, name = config["name"].get<std::string>()](const json* answer) {
                if (answer == nullptr) {
                  count->error = name + ": no answer";
                } else if (answer->contains("error")) {
                  const json& error = (*answer)["error"];
                  if (error.value("err_code", 0) != kExistsOtherwise) {
                    count->error = name + ": " + error.value("description", "refused");
                  }
                }
                if (--count->left == 0) done(count->error);
              });
  }
}

void read_last_answer(Plant& plant, const void* owner, std::string_view cell,
                      std::string_view group, Plant::Handler handler) {
  read(plant, owner, recognition_stream(cell),
       {{"last_by_subj", make_subject(cell, "recognition", group)}}, std::move(handler));
}

void read_contact_from(Plant& plant, const void* owner, const PlaceName& place,
                       std::string_view group, std::uint64_t seq, Plant::Handler handler) {
  read(plant, owner, contact_stream(place.cell),
       {{"seq", seq}, {"next_by_subj", contact_filter(place, to_token(group))}},
       std::move(handler));
}

}  // namespace palpate::gateway
