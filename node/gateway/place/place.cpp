#include "node/gateway/place/place.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "node/files/printable.h"
#include "node/gateway/place/delivered_contact.h"
#include "node/gateway/plant/streams.h"
#include "node/gateway/plant/subjects.h"
#include "node/wire/parse.h"

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

// With more groups than this, and nothing to do, a place begins anew, with none: where each part
// has a group of its own, all but a few are over.
constexpr std::size_t kManyGroups = 1024;
// But not more often than this: where so many groups are in use, each is replayed after it.
constexpr std::chrono::seconds kBetweenClearings{60};
constexpr milliseconds kTend{50};
constexpr milliseconds kRetry{300};
// Attempts of a replay that stops before its last contact: a replica of the stream that is behind
// will have it soon.
constexpr int kReplayTries = 20;

constexpr const char* kFrom = "Palpate-From";
constexpr const char* kThrough = "Palpate-Through";
constexpr const char* kBegin = "Palpate-Begin";

}  // namespace

Place::Place(zmq::context_t& context, Plant& plant, PlaceName name, const FedNodeOptions& node,
             SteadyTime begin_at)
    : plant_(plant),
      name_(std::move(name)),
      max_message_bytes_(node.max_message_bytes),
      most_groups_(node.most_groups),
      consumer_(
          plant, name_,
          {[this](const PlantMessage& message, std::uint64_t seq) { take_contact(message, seq); },
           [this] { ledger_.forget(); }, [this](const std::string& why) { fail(why); }}),
      feed_(context, node,
            {[this](const std::string& group, const FedContact& contact) {
               node_rejected(group, contact);
             },
             [this](const v1::Recognition& recognition, const AnsweredSpan& span,
                    std::string_view payload) { node_answered(recognition, span, payload); },
             [this](const std::string& why) { fail(why); }}),
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
    feed_.begin(name_.partition.empty() ? name_.cell : name_.cell + "-" + name_.partition, now);
  } catch (const std::exception& error) {
    fail(error.what());
    return;
  }
  consumer_.begin();
}

void Place::forget_all() {
  plant_.forget(this);
  consumer_.forget();
  feed_.forget();
  has_contact_ = false;
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
  if (!has_contact_) ledger_.begin_at(stream_seq);
  has_contact_ = true;
  if (ledger_.is_refused(stream_seq)) return consumer_.done(stream_seq);
  std::optional<GroupContact> read;
  if (message.payload().size() <= max_message_bytes_) {
    read = read_contact(message.subject(), message.payload(), stream_seq);
  }
  if (!read) {
    status_.set_hostile(status_.hostile() + 1);
    return refuse(stream_seq);
  }
  // (More groups than the plant delivers contacts ahead: so some were done since the last time.)
  if (groups_.size() >= most_groups_ && !groups_.contains(read->group)) {
    return fail("it has " + std::to_string(groups_.size()) + " groups");
  }
  const auto found = groups_.try_emplace(std::move(read->group)).first;
  Group& group = found->second;
  if (group.state == Group::State::Live) {
    return add_new(found->first, group, std::move(read->contact));
  }
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
      if (message != nullptr && message->status() == "404") return end_replay(name, asked);
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
      return end_replay(name, asked);
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
        if (!message->status().empty() || seq > group.through) return end_replay(name, group);
        auto read = read_contact(message->header("Nats-Subject"), message->payload(), seq);
        // A contact that the node did not accept then is not replayed.
        if (read && read->contact.object == object && read->group == name) {
          read->contact.is_new = false;
          group.replayed.push_back(std::move(read->contact));
        }
        if (seq == group.through) return end_replay(name, group);
        replay(name, object, seq + 1);
      });
}

void Place::end_replay(const std::string& name, Group& group) {
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
  for (FedContact& contact : group.replayed) feed_.add(name, std::move(contact));
  group.replayed.clear();
  for (FedContact& contact : group.arrived) add_new(name, group, std::move(contact));
  group.arrived.clear();
}

void Place::add_new(const std::string& name, Group& group, FedContact contact) {
  if (contact.stream_seq <= group.through) return answered_before(contact.stream_seq);
  if (ledger_.take(contact.stream_seq)) status_.set_contacts(status_.contacts() + 1);
  group.unanswered.push_back(contact.stream_seq);
  feed_.add(name, std::move(contact));
}

void Place::refuse(std::uint64_t stream_seq) {
  ledger_.refuse(stream_seq);
  consumer_.done(stream_seq);
}

/// The answer was stored before this place began anew, and nobody told.
void Place::answered_before(std::uint64_t stream_seq) {
  if (ledger_.answered(stream_seq)) status_.set_answered(status_.answered() + 1);
  consumer_.done(stream_seq);
}

// --- Between the node and the plant

void Place::node_rejected(const std::string& name, const FedContact& contact) {
  if (!contact.is_new) return;
  status_.set_rejected(status_.rejected() + 1);
  std::erase(groups_[name].unanswered, contact.stream_seq);
  refuse(contact.stream_seq);
}

void Place::node_answered(const v1::Recognition& recognition, const AnsweredSpan& span,
                          std::string_view payload) {
  const std::string& name = recognition.group();
  Group& group = groups_[name];
  const v1::Header& header = recognition.header();
  Answer answer{span, {}, std::string(payload)};
  answer.id = name + "/" + std::to_string(header.epoch()) + "/" + std::to_string(header.seq());
  // While the plant stores one answer, the later ones of the same object are merged: fewer answers,
  // but none is delayed.
  const bool may_replace = group.answers.size() > (group.is_first_sent ? 1U : 0U);
  if (may_replace && group.answers.back().span.object == span.object) {
    answer.span.from = group.answers.back().span.from;
    answer.span.contacts += group.answers.back().span.contacts;
    group.answers.back() = std::move(answer);
  } else {
    group.answers.push_back(std::move(answer));
  }
  store_next(name, group);
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
    ledger_.answered(seq);
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
  return feed_.in_flight_count() > 0 ||
         std::any_of(groups_.begin(), groups_.end(), [](const auto& entry) {
           const Group& group = entry.second;
           return group.state == Group::State::Asking || !group.arrived.empty() ||
                  !group.unanswered.empty() || !group.answers.empty();
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
  feed_.serve(now);
  if (has_begun_ && now >= next_tend_) tend(now);
}

}  // namespace palpate::gateway
