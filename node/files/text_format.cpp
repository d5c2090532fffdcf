#include "node/files/text_format.h"

#include <google/protobuf/io/tokenizer.h>

#include "node/files/bounded_file.h"

namespace palpate {
namespace {

/// Keeps the first error that protobuf's text parser reports.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  explicit FirstError(const std::string& name) : name_(name) {}

  void AddError(int line, int column, const std::string& message) override {
    if (text_.empty()) {
      text_ = name_ + ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1) + ": " +
              message;
    }
  }
  void AddWarning(int, int, const std::string&) override {}

  const std::string& text() const { return text_; }

 private:
  std::string name_;
  std::string text_;
};

}  // namespace

std::string parse_text(const std::string& text, const std::string& name,
                       google::protobuf::Message& message,
                       google::protobuf::TextFormat::ParseInfoTree* locations) {
  FirstError first_error(name);
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&first_error);
  parser.WriteLocationsTo(locations);
  if (parser.ParseFromString(text, &message)) {
    return {};
  }
  return first_error.text().empty() ? name + ": cannot be parsed" : first_error.text();
}

std::string in_words(std::string error, const std::string& name, std::string_view words) {
  constexpr std::string_view kPlaceEnd = ": ";
  const std::size_t said = error.find(kPlaceEnd, name.size()) + kPlaceEnd.size();
  return error.insert(said, std::string(words) + " (") + ")";
}

Result<std::string> read_file(const std::string& path) {
  // Far longer than any file that a person writes. [bytes]
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  return read_bounded(path, kMostBytes);
}

}  // namespace palpate
