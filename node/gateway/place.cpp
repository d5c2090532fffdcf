#include "node/gateway/place.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "node/files/printable.h"
#include "node/gateway/delivered_contact.h"
#include "node/gateway/streams.h"
#include "node/gateway/subjects.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/node_status.pb.h"

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

// Maximum of contacts sent to the node and unanswered. The node would reject only beyond 16 MiB
// (one group may use half of max_waiting_bytes).
constexpr std::size_t kMostInFlight = 512;
constexpr std::size_t kMostBytesInFlight = std::size_t{4} << 20;
// With more groups than this, and nothing to do, a place begins anew, with none: where each part
// has a group of its own, all but a few are over.
constexpr std::size_t kManyGroups = 1024;
// But not more often than this: where so many groups are in use, each is replayed after it.
constexpr std::chrono::seconds kBetweenClearings{60};
// Refused contacts that are remembered. They may be delivered again until all contacts before them
// are done, and the plant delivers 8,192 contacts ahead (contact_consumer.cpp).
constexpr std::size_t kMostRefused = 16'384;
constexpr milliseconds kTend{50};
constexpr milliseconds kRetry{300};
// A node publishes its status every second.
constexpr milliseconds kNodeSilence{5000};
// Attempts of a replay that stops before its last contact: a replica of the stream that is behind
// will have it soon.
constexpr int kReplayTries = 20;

constexpr const char* kFrom = "Palpate-From";
constexpr const char* kThrough = "Palpate-Through";
constexpr const char* kBegin = "Palpate-Begin";

template <typename Message>
bool parse(Message& message, std::string_view payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace

Place::Place(zmq::context_t& context, Plant& plant, PlaceName name, FedNodeOptions node,
             SteadyTime begin_at)
    : context_(context),
      plant_(plant),
      name_(std::move(name)),
      node_options_(std::move(node)),
      consumer_(
          plant, name_,
          {[this](const PlantMessage& message, std::uint64_t seq) { take_contact(message, seq); },
           [this] { forget_contacts(); }, [this](const std::string& why) { fail(why); }}),
      begin_at_(begin_at) {
  status_.set_cell(name_.cell);
  status_.set_partition(name_.partition);
}

Place::~Place() {
  consumer_.acknowledge();
  forget_all();
}

// --- Beginning

void Place::begin(SteadyTime now) {
  has_begun_ = true;
  begun_ = now;
  try {
    node_ = std::make_unique<FedNode>(
        context_, node_options_,
        name_.partition.empty() ? name_.cell : name_.cell + "-" + name_.partition);
  } catch (const std::exception& error) {
    fail(error.what());
    return;
  }
  node_heard_ = now;
  consumer_.begin();
}

void Place::forget_all() {
  plant_.forget(this);
  consumer_.forget();
  node_.reset();
  node_has_spoken_ = has_contact_ = false;
  ready_.clear();
  given_.clear();
  given_count_ = in_flight_count_ = in_flight_bytes_ = 0;
  groups_.clear();
}

void Place::fail(const std::string& why) {
  spdlog::warn("{}: begins anew: {}", printable(name_.text()), why);
  begin_anew();
}

void Place::begin_anew() {
  status_.set_restarts(status_.restarts() + 1);
  forget_all();
  has_begun_ = false;
  begin_at_ = now_steady() + kRetry;
}

void Place::take_contact(const PlantMessage& message, std::uint64_t stream_seq) {
  // Of the contacts before the first one none comes again: they are done, or the stream has lost
  // them at its limit.
  if (!has_contact_) counted_.erase(counted_.begin(), counted_.lower_bound(stream_seq));
  has_contact_ = true;
  if (refused_.contains(stream_seq)) return consumer_.done(stream_seq);
  std::optional<GroupContact> read;
  if (message.payload().size() <= node_options_.max_message_bytes) {
    read = read_contact(message.subject(), message.payload(), stream_seq);
  }
  if (!read) {
    status_.set_hostile(status_.hostile() + 1);
    return refuse(stream_seq);
  }
  // (More groups than the plant delivers contacts ahead: so some were done since the last time.)
  if (groups_.size() >= node_options_.most_groups && !groups_.contains(read->group)) {
    return fail("it has " + std::to_string(groups_.size()) + " groups");
  }
  const auto found = groups_.try_emplace(std::move(read->group)).first;
  Group& group = found->second;
  if (group.state == Group::State::Live) return add_new(group, std::move(read->contact));
  group.arrived.push_back(std::move(read->contact));
  if (group.state == Group::State::Unknown) ask(found->first, group);
}

// --- Which contacts of a group are answered

void Place::ask(const std::string& name, Group& group) {
  group.state = Group::State::Asking;
  read_last_answer(plant_, this, name_.cell, name, [this, name](const PlantMessage* message) {
    Group& asked = groups_[name];
    asked.replayed.clear();
    asked.last_answer_seq = message == nullptr ? 0 : message->number("Nats-Sequence");
    if (asked.last_answer_seq == 0) {
      if (message != nullptr && message->status() == "404") return end_replay(asked);
      asked.state = Group::State::Unknown;  // tend() asks again
      return;
    }
    asked.through = message->number(kThrough);
    const std::uint64_t begin = message->number(kBegin);
    v1::Recognition last;
    if (asked.through == 0 || begin == 0 || !parse(last, message->payload())) {
      asked.through = 0;
      spdlog::warn("{}: the last answer of group {} is none of a recogniser of the plant",
                   printable(name_.text()), printable(name));
      return end_replay(asked);
    }
    // Nothing new has arrived, so there is nothing to continue.
    const bool is_new =
        std::any_of(asked.arrived.begin(), asked.arrived.end(),
                    [&](const FedContact& contact) { return contact.stream_seq > asked.through; });
    if (!is_new) {
      for (const FedContact& contact : asked.arrived) answered_before(contact.stream_seq);
      asked.arrived.clear();
      asked.state = Group::State::Unknown;
      return;
    }
    replay(name, last.object(), begin);
  });
}

void Place::replay(const std::string& name, std::uint64_t object, std::uint64_t next_seq) {
  read_contact_from(
      plant_, this, name_, name, next_seq, [this, name, object](const PlantMessage* message) {
        Group& group = groups_[name];
        if (message == nullptr || (!message->status().empty() && message->status() != "404")) {
          group.state = Group::State::Unknown;
          return;
        }
        const std::uint64_t seq = message->number("Nats-Sequence");
        if (!message->status().empty() || seq > group.through) return end_replay(group);
        auto read = read_contact(message->header("Nats-Subject"), message->payload(), seq);
        // A contact that the node did not accept then is not replayed.
        if (read && read->contact.object == object && read->group == name) {
          read->contact.is_new = false;
          group.replayed.push_back(std::move(read->contact));
        }
        if (seq == group.through) return end_replay(group);
        replay(name, object, seq + 1);
      });
}

void Place::end_replay(Group& group) {
  const std::uint64_t last = group.replayed.empty() ? 0 : group.replayed.back().stream_seq;
  if (last != group.through && group.through != 0) {
    if (++group.tries < kReplayTries) {
      group.state = Group::State::Unknown;
      return;
    }
    status_.set_replays_incomplete(status_.replays_incomplete() + 1);
  }
  group.state = Group::State::Live;
  status_.set_replayed(status_.replayed() + group.replayed.size());
  for (FedContact& contact : group.replayed) group.feed.add(std::move(contact));
  group.replayed.clear();
  for (FedContact& contact : group.arrived) add_new(group, std::move(contact));
  group.arrived.clear();
}

void Place::add_new(Group& group, FedContact contact) {
  if (contact.stream_seq <= group.through) return answered_before(contact.stream_seq);
  if (counted_.insert(contact.stream_seq).second) status_.set_contacts(status_.contacts() + 1);
  group.unanswered.push_back(contact.stream_seq);
  group.feed.add(std::move(contact));
  make_ready(group);
}

/// A stream that was made again counts from 1: a contact of it may have the number of one that was
/// refused.
void Place::forget_contacts() {
  counted_.clear();
  refused_.clear();
}

void Place::refuse(std::uint64_t stream_seq) {
  counted_.erase(stream_seq);
  refused_.insert(stream_seq);
  if (refused_.size() > kMostRefused) refused_.erase(refused_.begin());
  consumer_.done(stream_seq);
}

/// The answer was stored before this place began anew, and nobody told.
void Place::answered_before(std::uint64_t stream_seq) {
  if (counted_.erase(stream_seq) > 0) status_.set_answered(status_.answered() + 1);
  consumer_.done(stream_seq);
}

// --- Between the node and the plant

void Place::make_ready(Group& group) {
  if (group.is_ready) return;
  group.is_ready = true;
  ready_.push_back(&group);
}

void Place::give() {
  while (!ready_.empty()) {
    Group& group = *ready_.front();
    while (const FedContact* contact = group.feed.next()) {
      if (in_flight_count_ >= kMostInFlight || in_flight_bytes_ >= kMostBytesInFlight) return;
      node_->send(make_topic(TopicKind::Contact, contact->probe), contact->payload);
      given_.push_back({&group, *contact});
      given_.back().contact.payload = std::string();
      ++given_count_;
      ++in_flight_count_;
      in_flight_bytes_ += contact->bytes;
      group.feed.given();
    }
    ready_.pop_front();
    group.is_ready = false;
  }
}

void Place::hear(const TwoFrames& message) {
  const std::optional<Topic> topic = parse_topic(view_of(message.topic));
  if (!topic || message.frame_count != 2) return;
  const std::string_view payload = view_of(message.payload);
  if (topic->kind == TopicKind::Contact) {
    v1::ContactBatch batch;
    if (parse(batch, payload)) node_took(batch.header(), topic->name);
  } else if (topic->kind == TopicKind::Recognition) {
    v1::Recognition recognition;
    if (parse(recognition, payload)) node_answered(recognition, payload);
  } else if (topic->kind == TopicKind::Status) {
    v1::NodeStatus node;
    if (!parse(node, payload)) return;
    node_has_spoken_ = true;
    node_heard_ = now_steady();
    // The node has judged this many contacts, and has already shown those that it accepted; the
    // rest are rejected.
    while (!given_.empty() && given_count_ - given_.size() < node.messages_received()) {
      node_rejected();
    }
  }
}

/// The node shows the contacts that it accepts in the order in which they were sent. Those that it
/// skips it has rejected.
void Place::node_took(const v1::Header& header, std::string_view probe) {
  while (!given_.empty()) {
    const FedContact& first = given_.front().contact;
    if (first.seq == header.seq() && first.epoch == header.epoch() && first.probe == probe) {
      given_.front().group->feed.accepted(first.stream_seq);
      given_.pop_front();
      return;
    }
    node_rejected();
  }
}

void Place::node_rejected() {
  const Given given = std::move(given_.front());
  given_.pop_front();
  Group& group = *given.group;
  const std::optional<FedContact> out = group.feed.rejected(given.contact.stream_seq);
  if (out) {
    --in_flight_count_;
    in_flight_bytes_ -= out->bytes;
    if (out->is_new) {
      status_.set_rejected(status_.rejected() + 1);
      std::erase(group.unanswered, out->stream_seq);
      refuse(out->stream_seq);
    }
  }
  make_ready(group);
}

void Place::node_answered(const v1::Recognition& recognition, std::string_view payload) {
  const auto found = groups_.find(recognition.group());
  if (found == groups_.end()) return;
  Group& group = found->second;
  const std::size_t count = group.feed.in_flight_count();
  const std::size_t bytes = group.feed.in_flight_bytes();
  const std::optional<AnsweredSpan> span =
      group.feed.answered(recognition.newest_batch_source(), recognition.newest_batch_epoch(),
                          recognition.newest_batch_seq());
  in_flight_count_ -= count - group.feed.in_flight_count();
  in_flight_bytes_ -= bytes - group.feed.in_flight_bytes();
  make_ready(group);
  if (!span) return;
  const v1::Header& header = recognition.header();
  Answer answer{*span, {}, std::string(payload)};
  answer.id =
      found->first + "/" + std::to_string(header.epoch()) + "/" + std::to_string(header.seq());
  // While the plant stores one answer, the later ones of the same object are merged: fewer answers,
  // but none is delayed.
  const bool may_replace = group.answers.size() > (group.is_first_sent ? 1U : 0U);
  if (may_replace && group.answers.back().span.object == span->object) {
    answer.span.from = group.answers.back().span.from;
    answer.span.contacts += group.answers.back().span.contacts;
    group.answers.back() = std::move(answer);
  } else {
    group.answers.push_back(std::move(answer));
  }
  store_next(found->first, group);
}

void Place::store_next(const std::string& name, Group& group) {
  if (group.is_storing || group.answers.empty()) return;
  group.is_storing = group.is_first_sent = true;
  const Answer& answer = group.answers.front();
  plant_.store(this, make_subject(name_.cell, "recognition", name), answer.payload,
               {{"Nats-Msg-Id", answer.id},
                {"Nats-Expected-Last-Subject-Sequence", std::to_string(group.last_answer_seq)},
                {kFrom, std::to_string(answer.span.from)},
                {kThrough, std::to_string(answer.span.through)},
                {kBegin, std::to_string(answer.span.begin)}},
               [this, name](const Stored& answered) { stored(name, answered); });
}

void Place::stored(const std::string& name, const Stored& stored) {
  Group& group = groups_[name];
  group.is_storing = false;
  const AnsweredSpan span = group.answers.front().span;
  switch (stored.verdict) {
    case Stored::Verdict::NotNow:
      return;  // tend() tries again, with the same id
    case Stored::Verdict::NotTheLast:
      group.is_storing = true;
      return is_it_ours(name);
    case Stored::Verdict::TooLong:
      spdlog::error("{}: an answer of group {} is longer than the plant's max_payload",
                    printable(name_.text()), printable(name));
      status_.set_answers_refused(status_.answers_refused() + 1);
      break;
    case Stored::Verdict::Yes:
    case Stored::Verdict::Before:
      group.last_answer_seq = stored.seq;
      group.through = span.through;
      status_.set_answers(status_.answers() + 1);
      status_.set_answered(status_.answered() + span.contacts);
      break;
  }
  while (!group.unanswered.empty() && group.unanswered.front() <= span.through) {
    const std::uint64_t seq = group.unanswered.front();
    group.unanswered.pop_front();
    if (stored.verdict ==
        Stored::Verdict::TooLong) {  // it has no answer, also where it comes again
      refuse(seq);
      continue;
    }
    counted_.erase(seq);
    consumer_.done(seq);
  }
  group.answers.pop_front();
  group.is_first_sent = false;
  store_next(name, group);
}

/// Something was stored after the answer that we know as the last: either another process's answer,
/// or ours, whose confirmation a dying server did not send.
void Place::is_it_ours(const std::string& name) {
  read_last_answer(plant_, this, name_.cell, name, [this, name](const PlantMessage* message) {
    Group& group = groups_[name];
    if (message == nullptr || (!message->status().empty() && message->status() != "404")) {
      group.is_storing = false;  // not told: tend() stores again, with the same id
      return;
    }
    if (message->header("Nats-Msg-Id") == group.answers.front().id) {
      return stored(name, {Stored::Verdict::Before, message->number("Nats-Sequence")});
    }
    status_.set_answers_refused(status_.answers_refused() + 1);
    fail("another recogniser has answered for group " + printable(name));
  });
}

bool Place::is_waiting() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const auto& entry) {
    const Group& group = entry.second;
    return group.state == Group::State::Asking || !group.arrived.empty() ||
           !group.unanswered.empty() || group.feed.in_flight_count() > 0 || !group.answers.empty();
  });
}

void Place::tend(SteadyTime now) {
  next_tend_ = now + kTend;
  consumer_.tend(now);
  for (auto& [name, group] : groups_) {
    if (group.state == Group::State::Unknown && !group.arrived.empty()) ask(name, group);
    store_next(name, group);
  }
  if (groups_.size() > kManyGroups && now >= begun_ + kBetweenClearings && !is_waiting()) {
    spdlog::info("{}: begins anew: of its {} groups none waits", printable(name_.text()),
                 groups_.size());
    consumer_.acknowledge();
    begin_anew();
  }
}

void Place::serve(SteadyTime now) {
  if (!has_begun_) {
    if (now >= begin_at_ && plant_.is_connected()) begin(now);
    return;
  }
  TwoFrames message;
  // (Handling a message may begin everything anew.)
  while (node_ && node_->receive(message)) hear(message);
  if (!node_) return;
  if (node_->has_ended()) return fail("its node has ended");
  if (now - node_heard_ > kNodeSilence) return fail("its node says nothing");
  if (node_->is_ready(node_has_spoken_)) give();
  if (now >= next_tend_) tend(now);
}

}  // namespace palpate::gateway
