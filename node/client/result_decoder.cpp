#include "node/client/result_decoder.h"

#include <optional>

#include "node/wire/parse.h"
#include "node/wire/topics.h"

namespace palpate::client {
namespace {

/// An empty source is the topic's (header.proto), which whoever gets the message does not see.
template <typename Message>
void complete_source(std::string_view topic_name, Message& message) {
  if (message.has_header() && message.header().source().empty()) {
    message.mutable_header()->set_source(std::string(topic_name));
  }
}

}  // namespace

/// The message's topic; nullptr if the message is not to be used.
template <typename Message>
ResultDecoder::Feed* ResultDecoder::take_fresh(const Message& message, std::string_view topic,
                                               SteadyTime now) {
  Feed* const feed = feeds_.hear(topic, now);
  if (feed == nullptr) {
    ++counters_.over_bound;
    return nullptr;
  }
  const SequenceTracker before = feed->sequence;
  const SequenceEvent event = feed->sequence.take(message.header().epoch(), message.header().seq());
  counters_.gaps += feed->sequence.gaps() - before.gaps();
  counters_.missing += feed->sequence.missing() - before.missing();
  counters_.restarts += feed->sequence.restarts() - before.restarts();
  if (is_news(event)) {
    ++counters_.received;
    return feed;
  }
  ++counters_.duplicates;
  return nullptr;
}

ReceivedResult ResultDecoder::take(std::string_view text, std::string_view payload,
                                   SteadyTime now) {
  ReceivedResult result;
  const std::optional<Topic> topic = parse_topic(text);
  if (topic && topic->kind == TopicKind::Recognition && parse(recognition_, payload)) {
    Feed* const feed = take_fresh(recognition_, text, now);
    if (feed == nullptr) return result;
    feed->recognition.Swap(&recognition_);
    result.recognition = &feed->recognition;
  } else if (topic && topic->kind == TopicKind::Estimate && parse(estimate_, payload)) {
    if (take_fresh(estimate_, text, now) != nullptr) result.estimate = &estimate_;
  } else if (topic && topic->kind == TopicKind::Status && parse(status_, payload)) {
    complete_source(topic->name, status_);
    if (take_fresh(status_, text, now) != nullptr) result.status = &status_;
  } else if (topic && topic->kind == TopicKind::Contact && parse(contact_, payload)) {
    complete_source(topic->name, contact_);
    if (take_fresh(contact_, text, now) != nullptr) result.contact = &contact_;
  } else {
    count_malformed();
  }
  return result;
}

const v1::Recognition* ResultDecoder::latest(std::string_view group) const {
  if (!is_valid_name(group)) return nullptr;
  const Feed* const feed = feeds_.find(make_topic(TopicKind::Recognition, group));
  return feed == nullptr ? nullptr : &feed->recognition;
}

std::vector<std::string> ResultDecoder::groups() const {
  std::vector<std::string> names;
  feeds_.for_each([&](const std::string& topic) {
    const std::optional<Topic> parsed = parse_topic(topic);
    if (parsed && parsed->kind == TopicKind::Recognition) names.emplace_back(parsed->name);
  });
  return names;
}

}  // namespace palpate::client
