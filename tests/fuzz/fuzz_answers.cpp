// Any bytes as what a recognizer says, down to what is shown of it: the subscriber's decoder, the
// table, lines and picture of palpate watch, all that palpate view sends to a browser, the picture
// of a file. The bytes are messages, each a byte for its topic, its length in two, and so many.
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "node/client/result_decoder.h"
#include "node/process/quiet_protobuf.h"
#include "node/tool/drawing/svg/svg_plot.h"
#include "node/tool/drawing/terminal_plot.h"
#include "node/tool/text/message_json.h"
#include "node/tool/text/recognition_text.h"
#include "node/tool/text/watch_table.h"
#include "node/tool/view/downloads.h"
#include "node/tool/view/live_feed.h"
#include "node/tool/view/live_state.h"

namespace {

using namespace palpate;

constexpr std::size_t kColumns = 100;
constexpr std::size_t kRows = 30;

/// Characters of UTF-8, as a terminal counts them. An escape sequence would rule it: there may be
/// none but our own colours, which end in m.
std::size_t harmless_characters_of(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == 0x1B) {
      i = text.find_first_not_of("[0123456789;", i + 1);
      if (i == std::string_view::npos || text[i] != 'm') std::abort();
    } else if ((c < 0x20 && c != '\n') || c == 0x7F) {
      std::abort();
    } else {
      count += (c & 0xC0U) != 0x80U;
    }
  }
  return count;
}

void expect_json(std::string_view text) {
  if (!nlohmann::json::accept(text)) std::abort();
}

void show(const v1::Recognition& answer) {
  (void)harmless_characters_of(summary_text(answer));
  (void)harmless_characters_of(report_text(answer));
  expect_json(json_line(answer));
}

void show(const WatchedState& state) {
  const std::vector<std::string> lines = watch_table(state, kColumns, kRows);
  if (lines.size() > kRows) std::abort();
  for (const std::string& line : lines) {
    if (harmless_characters_of(line) > kColumns) std::abort();
  }
}

void show(LiveState& state, SteadyTime now) {
  LiveFeed feed(state);
  for (const auto& [name, group] : state.groups()) {
    Viewer viewer;
    viewer.wanted = name;
    expect_json(feed.next_message(viewer, now));
    expect_json(answer_json(group));
    expect_json(moments_json(state, name));
    const std::string moment = moment_json(state, name, 0, now);
    if (!moment.empty()) expect_json(moment);
    (void)samples_csv(group);
    (void)svg_plot(group.touched, group.answer);
    for (const std::string& line : terminal_plot(group.touched, group.answer, kColumns, kRows)) {
      if (harmless_characters_of(line) > kColumns) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  silence_protobuf();
  // Fewer than the topics below, so that one more is refused too.
  client::ResultDecoder decoder(6);
  LiveState live;
  WatchedState watched;
  SteadyTime now(std::chrono::hours(1));
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::uint64_t messages = 0;
  for (std::size_t at = 0; at + 3 <= size; ++messages) {
    static const std::string kTopics[] = {"recognition/a/", "recognition/b/", "contact/finger/",
                                          "contact/a/",     "status/node/",   "estimate/finger/",
                                          "status/other/",  "recognition//",  "no topic"};
    const std::string& topic = kTopics[data[at] % std::size(kTopics)];
    const std::size_t length = std::size_t{256} * data[at + 1] + data[at + 2];
    const std::string_view payload = text.substr(at + 3, length);
    at += 3 + payload.size();
    now += std::chrono::milliseconds(100);
    const client::ReceivedResult result = decoder.take(topic, payload);
    if (result.recognition != nullptr) {
      show(*result.recognition);
      watched.groups[result.recognition->group()] = {*result.recognition, 1.0};
      live.take(*result.recognition, now, now.time_since_epoch().count());
    }
    if (result.contact != nullptr) live.take(*result.contact, now);
    if (result.status != nullptr) {
      expect_json(json_line(*result.status));
      watched.status = *result.status;
      watched.has_status = true;
      live.take(*result.status, now);
    }
    if (result.estimate != nullptr) expect_json(json_line(*result.estimate));
  }
  const client::SubscriberCounters& counted = decoder.counters();
  if (counted.received + counted.duplicates + counted.malformed != messages) std::abort();
  show(watched);
  show(live, now);
  return 0;
}
