#include "tests/bench/real/recording.h"

#include <stdexcept>

#include "node/csv/contact_csv.h"
#include "node/files/bounded_file.h"

namespace palpate::bench {

Recording read_recording(const std::filesystem::path& path) {
  const Result<std::string> text = read_bounded(path.string(), kMostContactFileBytes);
  if (!text) {
    throw std::runtime_error(text.error);
  }
  const Result<ContactTable> table = parse_contact_csv(*text.value, path.string());
  if (!table) {
    throw std::runtime_error(table.error);
  }
  if (table.value->rows.empty()) {
    throw std::runtime_error(path.string() + ": no contacts");
  }
  const ContactRow& first = table.value->rows.front();
  Recording recording{first.context, {}};
  for (const ContactRow& row : table.value->rows) {
    if (row.probe != first.probe || row.context.patch != first.context.patch) {
      throw std::runtime_error(path.string() + ": more than one patch");
    }
    recording.points.push_back(row.sample.position_m);
  }
  return recording;
}

Recognition recognise(const PatchContext& context, const std::vector<Vec2>& points,
                      const RecognizerOptions& options) {
  std::vector<ContactSample> samples;
  for (const Vec2& point : points) {
    samples.push_back({point, 0.0, 0});
  }
  Recognizer recognizer(options);
  recognizer.add(context, samples);
  return recognizer.recognize();
}

Recognition recognise_touches(const PatchContext& context, const std::vector<Vec2>& points,
                              const RecognizerOptions& options) {
  Recognizer recognizer(options);
  PatchContext touch = context;
  for (const Vec2& point : points) {
    const ContactSample sample{point, 0.0, 0};
    recognizer.add(touch, {&sample, 1});
    ++touch.patch;
  }
  return recognizer.recognize();
}

std::string_view name_of(RecognitionStatus status) {
  switch (status) {
    case RecognitionStatus::Recognized:
      return "RECOGNIZED";
    case RecognitionStatus::Ambiguous:
      return "AMBIGUOUS";
    default:
      return "COLLECTING";
  }
}

}  // namespace palpate::bench
