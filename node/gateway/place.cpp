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

using nlohmann::json;
using std::chrono::milliseconds;

// Contacts that the plant has delivered and that have no stored answer yet. Beyond it the plant
// waits, which bounds our memory: a second of the busiest cell.
constexpr int kMostUnacknowledged = 8192;
// Given to the node and unanswered. The node lets 16 MiB wait (max_waiting_bytes, half of it for
// whoever has most) before it would reject any.
constexpr std::size_t kMostInFlight = 512;
constexpr std::size_t kMostBytesInFlight = std::size_t{4} << 20;
// Of a place: as many as half of the most that a node may be given (kMostThings in node/options.h).
// Further names, which only a stranger invents, are not taken.
constexpr std::size_t kMostGroups = 50'000;
constexpr milliseconds kTend{50};
constexpr milliseconds kRetry{300};
// The engine says this often that a consumer lives; without it for so long we ask.
constexpr milliseconds kHeartbeat{500};
constexpr milliseconds kConsumerSilence{1500};
// A node says each second that it lives.
constexpr milliseconds kNodeSilence{5000};
constexpr milliseconds kLookupTimeout{500};
// Of a replay that stops before its last contact: a replica of the stream that is behind has it
// soon.
constexpr int kReplayTries = 20;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
// It delivers nothing twice: a new beginning has a consumer of its own.
constexpr std::int64_t kAckWaitNs = std::int64_t{3600} * 1000 * kNanosecondsPerMillisecond;

// The engine's number of an error (JSConsumerNotFoundErr).
constexpr int kNoConsumer = 10014;

constexpr const char* kFrom = "Palpate-From";
constexpr const char* kThrough = "Palpate-Through";
constexpr const char* kBegin = "Palpate-Begin";

template <typename Message>
bool parse(Message& message, std::string_view payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

std::string contact_filter(const PlaceName& name, std::string_view group_token) {
  std::string filter = make_subject(name.cell, "contact", name.partition);
  return filter.append(".").append(group_token).append(".*");
}

}  // namespace

Place::Place(zmq::context_t& context, Plant& plant, PlaceName name, FedNodeOptions node,
             SteadyTime begin_at)
    : context_(context),
      plant_(plant),
      name_(std::move(name)),
      node_options_(std::move(node)),
      consumer_("recognise" +
                (name_.partition.empty() ? std::string() : "-" + to_token(name_.partition))),
      begin_at_(begin_at) {
  status_.set_cell(name_.cell);
  status_.set_partition(name_.partition);
}

Place::~Place() {
  acknowledge();
  forget_all();
}

// --- Beginning

void Place::begin(SteadyTime now) {
  has_begun_ = true;
  try {
    node_ = std::make_unique<FedNode>(
        context_, node_options_,
        name_.partition.empty() ? name_.cell : name_.cell + "-" + name_.partition);
  } catch (const std::exception& error) {
    fail(error.what());
    return;
  }
  node_heard_ = now;
  find_start();
}

void Place::forget_all() {
  plant_.forget(this);
  plant_.unsubscribe(subscription_);
  subscription_ = 0;
  node_.reset();
  node_has_spoken_ = false;
  consumer_seq_ = stream_seq_ = 0;
  ready_.clear();
  given_.clear();
  given_count_ = in_flight_count_ = in_flight_bytes_ = 0;
  groups_.clear();
  delivered_.clear();
  ack_reply_.clear();
}

void Place::fail(const std::string& why) {
  spdlog::warn("{}: begins anew: {}", printable(name_.text()), why);
  status_.set_restarts(status_.restarts() + 1);
  forget_all();
  has_begun_ = false;
  begin_at_ = std::chrono::steady_clock::now() + kRetry;
}

/// After the last contact acknowledged by a former consumer. It only spares work: what is delivered
/// though it is answered, is known to be by the answers.
void Place::find_start() {
  plant_.api(this, "CONSUMER.INFO." + contact_stream(name_.cell) + "." + consumer_, nullptr,
             [this](const json* answer) {
               if (answer == nullptr) return fail("the plant has no answer for its consumer");
               const auto error = answer->find("error");
               if (error != answer->end() && error->value("err_code", 0) != kNoConsumer) {
                 return fail("its consumer: " + error->value("description", std::string()));
               }
               std::uint64_t floor = 0;
               if (const auto found = answer->find("ack_floor"); found != answer->end()) {
                 floor = found->value("stream_seq", std::uint64_t{0});
               }
               plant_.api(this, "CONSUMER.DELETE." + contact_stream(name_.cell) + "." + consumer_,
                          nullptr, [this, floor](const json* deleted) {
                            if (deleted == nullptr) return fail("its consumer cannot be replaced");
                            make_consumer(floor + 1);
                          });
             });
}

void Place::make_consumer(std::uint64_t start_seq) {
  deliver_subject_ = plant_.private_subject();
  subscription_ = plant_.subscribe(deliver_subject_,
                                   [this](const PlantMessage& message) { delivered(message); });
  if (subscription_ == 0) return fail("no subscription");
  consumer_heard_ = std::chrono::steady_clock::now();
  const json config{{"durable_name", consumer_},
                    {"deliver_subject", deliver_subject_},
                    {"deliver_policy", "by_start_sequence"},
                    {"opt_start_seq", start_seq},
                    {"ack_policy", "all"},
                    {"ack_wait", kAckWaitNs},
                    {"max_ack_pending", kMostUnacknowledged},
                    {"filter_subject", contact_filter(name_, "*")},
                    {"idle_heartbeat", kHeartbeat.count() * kNanosecondsPerMillisecond}};
  const std::string stream = contact_stream(name_.cell);
  plant_.api(this, "CONSUMER.DURABLE.CREATE." + stream + "." + consumer_,
             {{"stream_name", stream}, {"config", config}}, [this, start_seq](const json* answer) {
               if (answer == nullptr) return fail("its consumer cannot be made");
               if (const auto error = answer->find("error"); error != answer->end()) {
                 return fail("its consumer: " + error->value("description", std::string()));
               }
               spdlog::info("{}: from contact {} on", printable(name_.text()), start_seq);
             });
}

void Place::delivered(const PlantMessage& message) {
  consumer_heard_ = std::chrono::steady_clock::now();
  if (message.subject() == deliver_subject_) {  // the engine's own word; contacts have their own
    if (message.number("Nats-Last-Consumer") > consumer_seq_) fail("contacts were lost on the way");
    return;
  }
  const DeliveryNumbers numbers = numbers_of(message.reply());
  const bool is_gap = numbers.consumer_seq > consumer_seq_ + 1;
  consumer_seq_ = numbers.consumer_seq;
  if (numbers.stream_seq <= stream_seq_) return;  // again, after a change of the consumer's leader
  if (is_gap) return fail("contacts were lost on the way");
  stream_seq_ = numbers.stream_seq;
  delivered_.push_back({stream_seq_, std::string(message.reply()), false});
  take_contact(message, stream_seq_);
}

void Place::take_contact(const PlantMessage& message, std::uint64_t stream_seq) {
  std::optional<GroupContact> read;
  if (message.payload().size() <= node_options_.max_message_bytes) {
    read = read_contact(message.subject(), message.payload(), stream_seq);
  }
  if (!read || (groups_.size() >= kMostGroups && !groups_.contains(read->group))) {
    status_.set_hostile(status_.hostile() + 1);
    mark_done(stream_seq);
    return;
  }
  const auto found = groups_.try_emplace(std::move(read->group)).first;
  Group& group = found->second;
  if (group.state == Group::State::Live) return add_new(group, std::move(read->contact));
  group.arrived.push_back(std::move(read->contact));
  if (group.state == Group::State::Unknown) ask(found->first, group);
}

/// Silence may be a consumer that looks for a leader, one that is gone, or a message lost.
void Place::check_consumer() {
  plant_.api(this, "CONSUMER.INFO." + contact_stream(name_.cell) + "." + consumer_, nullptr,
             [this](const json* answer) {
               if (answer == nullptr) return;
               const auto config = answer->find("config");
               if (config == answer->end() ||
                   config->value("deliver_subject", std::string()) != deliver_subject_) {
                 fail("its consumer is another's, or gone");
               }
             });
}

// --- What of a group is answered

void Place::ask(const std::string& name, Group& group) {
  group.state = Group::State::Asking;
  const json query{{"last_by_subj", make_subject(name_.cell, "recognition", name)}};
  plant_.request(
      this, "$JS.API.DIRECT.GET." + recognition_stream(name_.cell), query.dump(), {},
      kLookupTimeout, [this, name](const PlantMessage* message) {
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
        // Nothing new: nothing to go on with.
        const bool is_new = std::any_of(
            asked.arrived.begin(), asked.arrived.end(),
            [&](const FedContact& contact) { return contact.stream_seq > asked.through; });
        if (!is_new) {
          for (const FedContact& contact : asked.arrived) mark_done(contact.stream_seq);
          asked.arrived.clear();
          asked.state = Group::State::Unknown;
          return;
        }
        replay(name, last.object(), begin);
      });
}

void Place::replay(const std::string& name, std::uint64_t object, std::uint64_t next_seq) {
  const json query{{"seq", next_seq}, {"next_by_subj", contact_filter(name_, to_token(name))}};
  plant_.request(
      this, "$JS.API.DIRECT.GET." + contact_stream(name_.cell), query.dump(), {}, kLookupTimeout,
      [this, name, object](const PlantMessage* message) {
        Group& group = groups_[name];
        if (message == nullptr || (!message->status().empty() && message->status() != "404")) {
          group.state = Group::State::Unknown;
          return;
        }
        const std::uint64_t seq = message->number("Nats-Sequence");
        if (!message->status().empty() || seq > group.through) return end_replay(group);
        auto read = read_contact(message->header("Nats-Subject"), message->payload(), seq);
        // What the node did not take then, it does not get now.
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
  if (contact.stream_seq <= group.through) return mark_done(contact.stream_seq);
  status_.set_contacts(status_.contacts() + 1);
  group.unanswered.push_back(contact.stream_seq);
  group.feed.add(std::move(contact));
  make_ready(group);
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
    node_heard_ = std::chrono::steady_clock::now();
    // It has judged so many; what it took of them it has shown before.
    while (!given_.empty() && given_count_ - given_.size() < node.messages_received()) {
      node_rejected();
    }
  }
}

/// It shows what it takes, in the order in which it was given; what it passes over it has rejected.
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
      mark_done(out->stream_seq);
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
  // While the plant stores one, the next ones of an object become one: coarser, never later.
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
      return;  // tend() tries again, under the same id
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
    mark_done(group.unanswered.front());
    group.unanswered.pop_front();
  }
  group.answers.pop_front();
  group.is_first_sent = false;
  store_next(name, group);
}

/// Something has been stored after the answer that we know as the last: another's, or ours, of
/// which a server that died has not told us.
void Place::is_it_ours(const std::string& name) {
  const json query{{"last_by_subj", make_subject(name_.cell, "recognition", name)}};
  plant_.request(
      this, "$JS.API.DIRECT.GET." + recognition_stream(name_.cell), query.dump(), {},
      kLookupTimeout, [this, name](const PlantMessage* message) {
        const std::string& id = groups_[name].answers.front().id;
        if (message != nullptr && message->header("Nats-Msg-Id") == id) {
          return stored(name, {Stored::Verdict::Before, message->number("Nats-Sequence")});
        }
        status_.set_answers_refused(status_.answers_refused() + 1);
        fail("another recogniser has answered for group " + printable(name));
      });
}

void Place::mark_done(std::uint64_t stream_seq) {
  const auto found = std::lower_bound(
      delivered_.begin(), delivered_.end(), stream_seq,
      [](const Delivered& each, std::uint64_t seq) { return each.stream_seq < seq; });
  if (found != delivered_.end() && found->stream_seq == stream_seq) found->is_done = true;
  while (!delivered_.empty() && delivered_.front().is_done) {
    ack_reply_ = std::move(delivered_.front().reply);
    delivered_.pop_front();
  }
}

/// One acknowledges all before it.
void Place::acknowledge() {
  if (!ack_reply_.empty() && plant_.publish(ack_reply_, "+ACK")) ack_reply_.clear();
}

void Place::tend(SteadyTime now) {
  next_tend_ = now + kTend;
  acknowledge();
  for (auto& [name, group] : groups_) {
    if (group.state == Group::State::Unknown && !group.arrived.empty()) ask(name, group);
    store_next(name, group);
  }
  if (subscription_ != 0 && plant_.is_connected() && now - consumer_heard_ > kConsumerSilence) {
    consumer_heard_ = now;
    check_consumer();
  }
}

void Place::serve(SteadyTime now) {
  if (!has_begun_) {
    if (now >= begin_at_ && plant_.is_connected()) begin(now);
    return;
  }
  TwoFrames message;
  // (What is heard may make all begin anew.)
  while (node_ && node_->receive(message)) hear(message);
  if (!node_) return;
  if (node_->has_ended()) return fail("its node has ended");
  if (now - node_heard_ > kNodeSilence) return fail("its node says nothing");
  if (node_->is_ready(node_has_spoken_)) give();
  if (now >= next_tend_) tend(now);
}

}  // namespace palpate::gateway
