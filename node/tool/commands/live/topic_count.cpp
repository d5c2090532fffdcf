#include "node/tool/commands/live/topic_count.h"

#include <google/protobuf/io/coded_stream.h>

#include <algorithm>

namespace palpate {

bool header_of(std::string_view payload, v1::Header& header) {
  google::protobuf::io::CodedInputStream stream(
      reinterpret_cast<const std::uint8_t*>(payload.data()), static_cast<int>(payload.size()));
  constexpr std::uint32_t kFirstField = 1U << 3U | 2U;  // number 1, of stated length
  int bytes = 0;
  if (stream.ReadTag() != kFirstField || !stream.ReadVarintSizeAsInt(&bytes)) return false;
  stream.PushLimit(bytes);
  return header.ParseFromCodedStream(&stream);
}

namespace {

double seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void TopicCount::take(std::string_view payload, Time now) {
  bytes += payload.size();
  last_of_all_ = now;
  if (v1::Header header; header_of(payload, header)) {
    if (messages > 0 && header.epoch() == epoch_ && header.seq() == seq_) {
      ++repeats;
      return;
    }
    epoch_ = header.epoch();
    seq_ = header.seq();
  }
  if (messages == 0) {
    first_ = now;
  } else {
    const double interval = seconds(now - last_);
    shortest_s = messages == 1 ? interval : std::min(shortest_s, interval);
    longest_s = std::max(longest_s, interval);
  }
  last_ = now;
  ++messages;
}

bool TopicCount::has_stopped(Time since, Time now) const {
  // Status messages come once a second: of them, or of a slower topic, two at least are missing.
  constexpr double kLeast_s = 2.0;
  constexpr double kIntervals = 3.0;
  const double mean_s =
      messages > 1 ? seconds(last_ - first_) / static_cast<double>(messages - 1) : 0.0;
  return messages > 0 && seconds(now - since) > std::max(kLeast_s, kIntervals * mean_s);
}

double TopicCount::rate_hz(Time now) const {
  const double span = seconds(last_ - first_);
  if (messages < 2 || span <= 0.0 || has_stopped(last_, now)) return 0.0;
  return static_cast<double>(messages - 1) / span;
}

double TopicCount::silence_s(Time now) const {
  return has_stopped(last_of_all_, now) ? seconds(now - last_of_all_) : 0.0;
}

}  // namespace palpate
