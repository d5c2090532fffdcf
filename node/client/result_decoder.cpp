#include "node/client/result_decoder.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "node/wire/topics.h"

namespace palpate::client {
namespace {

template <typename Message>
bool parse(Message& message, std::string_view payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace

/// At the bound the topic that is silent for longest makes room. A node repeats the latest answer
/// of every group each second, so that a group which is silent for longer is one of its past. One
/// that is still repeated must stay known, or its answer would be new again with each repeat.
bool ResultDecoder::has_room_for(std::string_view topic) {
  constexpr std::chrono::seconds kIdle{10};
  if (feeds_.size() < most_topics_) return true;
  if (const auto found = feeds_.find(topic); found != feeds_.end()) return true;
  const auto oldest = std::min_element(
      feeds_.begin(), feeds_.end(),
      [](const auto& a, const auto& b) { return a.second.heard < b.second.heard; });
  if (oldest == feeds_.end() || now_ - oldest->second.heard <= kIdle) return false;
  feeds_.erase(oldest);
  return true;
}

template <typename Message>
bool ResultDecoder::is_fresh(const Message& message, std::string_view topic) {
  if (!has_room_for(topic)) {
    ++counters_.over_bound;
    return false;
  }
  const auto found = feeds_.find(topic);
  Feed& feed = found != feeds_.end() ? found->second : feeds_[std::string(topic)];
  feed.heard = now_;
  const SequenceTracker before = feed.sequence;
  const SequenceEvent event = feed.sequence.take(message.header().epoch(), message.header().seq());
  counters_.gaps += feed.sequence.gaps() - before.gaps();
  counters_.missing += feed.sequence.missing() - before.missing();
  counters_.restarts += feed.sequence.restarts() - before.restarts();
  if (is_news(event)) {
    ++counters_.received;
    return true;
  }
  ++counters_.duplicates;
  return false;
}

ReceivedResult ResultDecoder::take(std::string_view text, std::string_view payload,
                                   SteadyTime now) {
  ReceivedResult result;
  const std::optional<Topic> topic = parse_topic(text);
  now_ = now;
  if (topic && topic->kind == TopicKind::Recognition && parse(recognition_, payload)) {
    if (!is_fresh(recognition_, text)) return result;
    Feed& feed = feeds_.find(text)->second;
    feed.recognition.Swap(&recognition_);
    result.recognition = &feed.recognition;
  } else if (topic && topic->kind == TopicKind::Estimate && parse(estimate_, payload)) {
    if (is_fresh(estimate_, text)) result.estimate = &estimate_;
  } else if (topic && topic->kind == TopicKind::Status && parse(status_, payload)) {
    if (is_fresh(status_, text)) result.status = &status_;
  } else if (topic && topic->kind == TopicKind::Contact && parse(contact_, payload)) {
    if (is_fresh(contact_, text)) result.contact = &contact_;
  } else {
    count_malformed();
  }
  return result;
}

const v1::Recognition* ResultDecoder::latest(std::string_view group) const {
  if (!is_valid_name(group)) return nullptr;
  const auto found = feeds_.find(make_topic(TopicKind::Recognition, group));
  return found == feeds_.end() ? nullptr : &found->second.recognition;
}

std::vector<std::string> ResultDecoder::groups() const {
  std::vector<std::string> names;
  for (const auto& [topic, feed] : feeds_) {
    const std::optional<Topic> parsed = parse_topic(topic);
    if (parsed && parsed->kind == TopicKind::Recognition) names.emplace_back(parsed->name);
  }
  return names;
}

}  // namespace palpate::client
