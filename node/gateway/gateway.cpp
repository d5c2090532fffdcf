#include "node/gateway/gateway.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "node/files/printable.h"
#include "node/gateway/plant/subjects.h"
#include "node/process/clock.h"
#include "node/process/stop_signals.h"

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

// Longest poll, for work that depends on time; everything else wakes the poll at once.
constexpr milliseconds kTick{20};
constexpr milliseconds kStatusPeriod{1000};
// How long the plant may take at the end to confirm what it has been sent.
constexpr milliseconds kLongestEnd{1000};
// Owners announce a place on "palpate.<cell>.place", with the partition behind it if there is one.
constexpr const char* kPlaceKind = "place";

std::vector<std::string> texts_of(const std::vector<PlaceName>& places) {
  std::vector<std::string> texts;
  texts.reserve(places.size());
  for (const PlaceName& place : places) texts.push_back(place.text());
  return texts;
}

}  // namespace

Gateway::Gateway(const GatewayOptions& options)
    : options_(options),
      context_(1),
      plant_(options.plant),
      claims_(random_epoch(), texts_of(options.places), options.most_places, now_steady()) {
  if (options_.up) {
    up_.emplace(context_, plant_, *options_.up);
    cells_[options_.up->cell] = false;
  }
  for (const PlaceName& place : options_.places) {
    cells_[place.cell] = false;
    plant_.connection().subscribe(make_subject(place.cell, kPlaceKind, place.partition),
                                  [this, text = place.text()](const PlantMessage& message) {
                                    if (const auto id = whole_number(message.payload())) {
                                      claims_.hear(text, *id, now_steady());
                                    }
                                  });
  }
  v1::Header& header = *status_.mutable_header();
  header.set_source(options_.name);
  header.set_epoch(random_epoch());
  status_.set_version(PALPATE_VERSION);
}

void Gateway::run(int stop_fd) {
  service_manager_.ready("carries");
  while (!stop_requested(stop_fd)) {
    std::vector<zmq::pollitem_t> items{{nullptr, stop_fd, ZMQ_POLLIN, 0},
                                       {nullptr, plant_.connection().fd(), ZMQ_POLLIN, 0}};
    if (up_) items.push_back({up_->socket().handle(), 0, ZMQ_POLLIN, 0});
    for (const auto& [text, place] : places_) {
      if (zmq::socket_t* socket = place->socket()) {
        items.push_back({socket->handle(), 0, ZMQ_POLLIN, 0});
      }
    }
    poll(items, static_cast<int>(kTick.count()));
    const SteadyTime now = now_steady();
    serve_plant(now);
    if (up_) {
      up_->serve(now);
      if (!up_->refusal().empty()) {
        keep_unsent();
        throw std::runtime_error(to_string(options_.up->endpoint) + " " + up_->refusal());
      }
    }
    serve_places(now);
    tell(now);
    service_manager_.alive(now);
  }
  service_manager_.stopping();
  send_rest();
  keep_unsent();
  places_.clear();
}

/// What the plant confirms now is stored once, however late this gateway is started again.
void Gateway::send_rest() {
  if (!up_) return;
  const SteadyTime end = now_steady() + kLongestEnd;
  for (SteadyTime now = now_steady(); now < end; now = now_steady()) {
    serve_plant(now);
    if (!plant_.is_connected() || up_->send_rest(now)) return;
    std::vector<zmq::pollitem_t> items{{nullptr, plant_.connection().fd(), ZMQ_POLLIN, 0}};
    poll(items, static_cast<int>(kTick.count()));
  }
}

void Gateway::keep_unsent() {
  if (up_) up_->keep_unsent();
  log_changes();
}

void Gateway::serve_plant(SteadyTime now) {
  plant_.serve(now);
  if (plant_.is_connected() != was_connected_) {
    was_connected_ = plant_.is_connected();
    spdlog::info("{} the plant", was_connected_ ? "connected to" : "no connection to");
    if (was_connected_) complaint_told_.clear();
  }
  // Each failed attempt repeats the complaint.
  if (std::string complaint = plant_.connection().take_complaint();
      !complaint.empty() && complaint != complaint_told_) {
    spdlog::warn("the plant: {}", printable(complaint));
    complaint_told_ = std::move(complaint);
  }
}

void Gateway::serve_places(SteadyTime now) {
  const Claims::Changes changes = claims_.decide(plant_.is_connected(), now);
  for (const std::string& text : changes.release) {
    spdlog::warn("{}: left to another", printable(text));
    places_.erase(text);
  }
  for (const PlaceName& name : options_.places) {
    if (std::find(changes.take.begin(), changes.take.end(), name.text()) == changes.take.end()) {
      continue;
    }
    spdlog::info("{}: taken", printable(name.text()));
    places_[name.text()] =
        std::make_unique<Place>(context_, plant_, name, options_.node, now + Claims::kSettle);
    next_word_ = now;
  }
  for (const auto& [text, place] : places_) place->serve(now);
}

void Gateway::tell(SteadyTime now) {
  if (now >= next_word_) {
    next_word_ = now + Claims::kPeriod;
    for (const auto& [text, place] : places_) {
      const PlaceName& name = place->name();
      plant_.connection().publish(make_subject(name.cell, kPlaceKind, name.partition),
                                  std::to_string(claims_.id()));
    }
  }
  if (now < next_status_) return;
  next_status_ = now + kStatusPeriod;
  log_changes();
  if (!plant_.is_connected()) return;
  if (plant_.connection().connection_count() != connection_) {
    connection_ = plant_.connection().connection_count();
    for (auto& [cell, is_made] : cells_) is_made = false;
  }
  for (auto& [cell, is_made] : cells_) {
    if (is_made) continue;
    make_streams(plant_, this, cell, options_.streams,
                 [this, &made = is_made](const std::string& error) {
                   made = error.empty();
                   if (error == stream_error_told_) return;
                   stream_error_told_ = error;
                   if (!error.empty()) {
                     spdlog::error("a stream cannot be made: {}", printable(error));
                   }
                 });
  }
  publish_status();
}

void Gateway::publish_status() {
  status_.set_connections(plant_.connection().connection_count());
  if (up_) up_->fill(*status_.mutable_up());
  status_.clear_places();
  for (const auto& [text, place] : places_) *status_.add_places() = place->status();
  v1::Header& header = *status_.mutable_header();
  header.set_stamp_ns(unix_time_ns());
  for (const auto& [cell, is_made] : cells_) {
    plant_.connection().publish(make_subject(cell, "gateway", options_.name),
                                status_.SerializeAsString());
  }
  header.set_seq(header.seq() + 1);
}

/// Logs what has been lost since the last call, at most once a second.
void Gateway::log_changes() {
  if (const std::uint64_t dropped = plant_.connection().dropped(); dropped > dropped_told_) {
    spdlog::warn("{} messages of the plant dropped, {} in all: this gateway cannot keep up",
                 dropped - dropped_told_, dropped);
    dropped_told_ = dropped;
  }
  if (!up_) return;
  v1::GatewayUpStatus up;
  up_->fill(up);
  if (up.lost() > told_.lost()) {
    spdlog::error("{} messages lost, {} in all: the spool is full, damaged or cannot be written",
                  up.lost() - told_.lost(), up.lost());
  }
  if (up.missing() > told_.missing()) {
    spdlog::warn("{} messages were lost before they came here, {} in all",
                 up.missing() - told_.missing(), up.missing());
  }
  if (up.refused() > told_.refused()) {
    spdlog::error("{} messages refused by the plant for good, {} in all: longer than max_payload",
                  up.refused() - told_.refused(), up.refused());
  }
  if (up.malformed() > told_.malformed()) {
    spdlog::warn("{} messages are none of the contract, {} in all",
                 up.malformed() - told_.malformed(), up.malformed());
  }
  if ((up.spooled() > 0) != (told_.spooled() > 0)) {
    if (up.spooled() > 0) {
      spdlog::info("messages wait on disk");
    } else {
      spdlog::info("no message waits on disk any more");
    }
  }
  if (up_->disk_error() != disk_error_told_) {
    disk_error_told_ = up_->disk_error();
    if (!disk_error_told_.empty()) spdlog::error("{}", disk_error_told_);
  }
  told_ = up;
}

}  // namespace palpate::gateway
