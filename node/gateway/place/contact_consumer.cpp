#include "node/gateway/place/contact_consumer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "node/files/printable.h"
#include "node/gateway/place/delivered_contact.h"
#include "node/gateway/plant/streams.h"

namespace palpate::gateway {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

// Maximum of contacts delivered and not answered yet. Beyond it the plant waits, which bounds our
// memory. A second of the busiest cell.
constexpr int kMostUnacknowledged = 8192;
// The server sends this heartbeat for a consumer. After kSilence without one we ask for it.
constexpr milliseconds kHeartbeat{500};
constexpr milliseconds kSilence{1500};
// How often contacts in no partition are looked for: the mapping is the servers', and may change.
constexpr std::chrono::seconds kLook{5};
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
// Practically never: nothing is delivered twice, because each new beginning creates its own
// consumer.
constexpr std::int64_t kAckWaitNs = std::int64_t{3600} * 1000 * kNanosecondsPerMillisecond;

// The server's error code JSConsumerNotFoundErr.
constexpr int kNoConsumer = 10014;

}  // namespace

ContactConsumer::ContactConsumer(Plant& plant, PlaceName place, Events events)
    : plant_(plant),
      place_(std::move(place)),
      events_(std::move(events)),
      name_("recognise" +
            (place_.partition.empty() ? std::string() : "-" + to_token(place_.partition))) {}

/// The position of the previous consumer only saves work. Contacts delivered although they are
/// answered are recognised by the stored answers.
void ContactConsumer::begin() {
  const std::string consumer = contact_stream(place_.cell) + "." + name_;
  plant_.api(this, "CONSUMER.INFO." + consumer, nullptr, [this, consumer](const json* answer) {
    if (answer == nullptr) return events_.failed("the plant has no answer for its consumer");
    const auto error = answer->find("error");
    if (error != answer->end() && error->value("err_code", 0) != kNoConsumer) {
      return events_.failed("its consumer: " + error->value("description", std::string()));
    }
    std::uint64_t floor = 0;
    if (const auto found = answer->find("ack_floor"); found != answer->end()) {
      floor = found->value("stream_seq", std::uint64_t{0});
    }
    if (error != answer->end() || floor < floor_) events_.anew();
    floor_ = floor;
    plant_.api(this, "CONSUMER.DELETE." + consumer, nullptr, [this, floor](const json* deleted) {
      if (deleted == nullptr) return events_.failed("its consumer cannot be replaced");
      make(floor + 1);
    });
  });
}

void ContactConsumer::make(std::uint64_t start_seq) {
  deliver_subject_ = plant_.private_subject();
  subscription_ = plant_.connection().subscribe(
      deliver_subject_, [this](const PlantMessage& message) { take(message); });
  heard_ = now_steady();
  const json config{{"durable_name", name_},
                    {"deliver_subject", deliver_subject_},
                    {"deliver_policy", "by_start_sequence"},
                    {"opt_start_seq", start_seq},
                    {"ack_policy", "all"},
                    {"ack_wait", kAckWaitNs},
                    {"max_ack_pending", kMostUnacknowledged},
                    {"filter_subject", contact_filter(place_)},
                    {"idle_heartbeat", kHeartbeat.count() * kNanosecondsPerMillisecond}};
  const std::string stream = contact_stream(place_.cell);
  plant_.api(
      this, "CONSUMER.DURABLE.CREATE." + stream + "." + name_,
      {{"stream_name", stream}, {"config", config}}, [this, start_seq](const json* answer) {
        if (answer == nullptr) return events_.failed("its consumer cannot be made");
        if (const auto error = answer->find("error"); error != answer->end()) {
          return events_.failed("its consumer: " + error->value("description", std::string()));
        }
        spdlog::info("{}: from contact {} on", printable(place_.text()), start_seq);
      });
}

void ContactConsumer::forget() {
  plant_.forget(this);
  plant_.connection().unsubscribe(subscription_);
  subscription_ = 0;
  consumer_seq_ = stream_seq_ = 0;
  delivered_.clear();
  ack_reply_.clear();
}

void ContactConsumer::take(const PlantMessage& message) {
  heard_ = now_steady();
  // A message of the server itself; contacts have their own subjects.
  if (message.subject() == deliver_subject_) {
    if (message.number("Nats-Last-Consumer") > consumer_seq_) {
      events_.failed("contacts were lost on the way");
    }
    return;
  }
  const DeliveryNumbers numbers = numbers_of(message.reply());
  const bool is_gap = numbers.consumer_seq > consumer_seq_ + 1;
  consumer_seq_ = numbers.consumer_seq;
  // Delivered again after the consumer's leader changed.
  if (numbers.stream_seq <= stream_seq_) return;
  if (is_gap) return events_.failed("contacts were lost on the way");
  stream_seq_ = numbers.stream_seq;
  delivered_.push_back({stream_seq_, std::string(message.reply()), false});
  events_.contact(message, stream_seq_);
}

void ContactConsumer::done(std::uint64_t stream_seq) {
  const auto found = std::lower_bound(
      delivered_.begin(), delivered_.end(), stream_seq,
      [](const Delivered& each, std::uint64_t seq) { return each.stream_seq < seq; });
  if (found != delivered_.end() && found->stream_seq == stream_seq) found->is_done = true;
  while (!delivered_.empty() && delivered_.front().is_done) {
    ack_reply_ = std::move(delivered_.front().reply);
    delivered_.pop_front();
  }
}

/// Acknowledging one contact acknowledges all before it.
void ContactConsumer::acknowledge() {
  if (!ack_reply_.empty() && plant_.connection().publish(ack_reply_, "+ACK")) ack_reply_.clear();
}

void ContactConsumer::tend(SteadyTime now) {
  acknowledge();
  if (subscription_ != 0 && plant_.is_connected() && now - heard_ > kSilence) {
    heard_ = now;
    check();
  }
  const bool may_be_unmapped = !place_.partition.empty() && !is_unmapped_told_;
  if (may_be_unmapped && subscription_ != 0 && plant_.is_connected() && now >= next_look_) {
    next_look_ = now + kLook;
    look_for_unmapped();
  }
}

/// Contacts that no mapping of the servers has divided are stored under their first subjects, which
/// no place with a partition receives.
void ContactConsumer::look_for_unmapped() {
  plant_.api(this, "STREAM.INFO." + contact_stream(place_.cell),
             {{"subjects_filter", contact_filter({place_.cell, {}})}}, [this](const json* answer) {
               if (answer == nullptr) return;
               const auto state = answer->find("state");
               if (state == answer->end() || !state->contains("subjects")) return;
               is_unmapped_told_ = true;
               spdlog::warn(
                   "{}: contacts of {} subjects of the cell are in no partition, and no place with "
                   "a partition recognises them: the server's mappings did not divide them",
                   printable(place_.text()), (*state)["subjects"].size());
             });
}

/// After silence: the consumer may be without a leader, it may be gone, or a message may be lost.
void ContactConsumer::check() {
  plant_.api(this, "CONSUMER.INFO." + contact_stream(place_.cell) + "." + name_, nullptr,
             [this](const json* answer) {
               if (answer == nullptr) return;
               const auto config = answer->find("config");
               if (config == answer->end() ||
                   config->value("deliver_subject", std::string()) != deliver_subject_) {
                 events_.failed("its consumer is another's, or gone");
               }
             });
}

}  // namespace palpate::gateway
