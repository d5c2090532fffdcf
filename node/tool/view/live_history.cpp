#include "node/tool/view/live_history.h"

#include <cstdlib>

namespace palpate {
namespace {

std::size_t bytes_of(const Moment& moment) {
  return sizeof moment + moment.answer.size() + moment.counts.size() * sizeof(std::uint32_t);
}

std::size_t bytes_of(const ContactGroup& samples) {
  std::size_t bytes = sizeof samples;
  for (const ContactRun& run : samples.runs) {
    bytes += sizeof run + run.samples.size() * sizeof(ContactSample) +
             run.details.size() * sizeof(SampleDetail);
  }
  return bytes;
}

}  // namespace

void LiveHistory::add(Moment moment) {
  bytes_ += bytes_of(moment);
  const std::int64_t now_ms = moment.time_ms;
  moments_.push_back(std::move(moment));
  while (!moments_.empty() &&
         (bytes_ > kMostBytes || now_ms - moments_.front().time_ms > kLongest_ms)) {
    drop_oldest();
  }
}

void LiveHistory::seal(std::shared_ptr<SampleEra> era, const ContactGroup& samples) {
  if (era.use_count() == 1) return;  // no moment needs them
  era->past = samples;
  bytes_ += bytes_of(samples);
  era.reset();
  while (!moments_.empty() && bytes_ > kMostBytes) drop_oldest();
}

void LiveHistory::drop_oldest() {
  Moment& oldest = moments_.front();
  bytes_ -= bytes_of(oldest);
  // The samples of an object go with the last moment that needs them.
  if (oldest.era->past && oldest.era.use_count() == 1) bytes_ -= bytes_of(*oldest.era->past);
  moments_.pop_front();
}

std::vector<std::int64_t> LiveHistory::times(std::string_view group) const {
  std::vector<std::int64_t> times;
  for (const Moment& moment : moments_) {
    if (moment.group == group) times.push_back(moment.time_ms);
  }
  return times;
}

const Moment* LiveHistory::nearest(std::string_view group, std::int64_t time_ms) const {
  const Moment* nearest = nullptr;
  // As doubles, because a request may name any time.
  const auto distance = [time_ms](const Moment& moment) {
    return std::abs(static_cast<double>(moment.time_ms) - static_cast<double>(time_ms));
  };
  for (const Moment& moment : moments_) {
    if (moment.group != group) continue;
    if (nearest == nullptr || distance(moment) <= distance(*nearest)) nearest = &moment;
  }
  return nearest;
}

}  // namespace palpate
