#include "node/environment.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <utility>

#include "node/config.h"
#include "node/files/nearest_word.h"
#include "node/files/printable.h"
#include "node/files/trimmed.h"
#include "node/options.h"

namespace palpate {
namespace {

constexpr std::string_view kPrefix = "PALPATE_";
constexpr const char* kConfigFile = "PALPATE_CONFIG";

// "--max-groups" is set by PALPATE_MAX_GROUPS.
std::string variable_of(const std::string& flag) {
  std::string name = flag.substr(std::strlen("--"));
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return std::string(kPrefix) + name;
}

// set_option() says what is wrong with what is neither.
std::string opposite(const std::string& text) {
  if (text == "true" || text == "1") return "false";
  return text == "false" || text == "0" ? "true" : text;
}

// Sets an option to what a variable says; a list is separated by commas. Returns an empty string or
// an error.
std::string set_as_said(v1::NodeConfig& config, const std::string& option,
                        const std::string& said) {
  const bool is_list = v1::NodeConfig::descriptor()->FindFieldByName(option)->is_repeated();
  std::istringstream parts(said);
  std::string part;
  if (!is_list || !std::getline(parts, part, ',')) {
    return set_option(config, option, said);
  }
  std::string error;
  do {
    if (error.empty()) error = set_option(config, option, std::string(trimmed(part)));
  } while (std::getline(parts, part, ','));
  return error;
}

// Sets options as the environment says. Every spelling of an option's flag is a variable too:
// nobody is to believe that an option is set by one that is not read.
class EnvironmentReader {
 public:
  template <typename Field>
  void operator()(const OptionInfo& info, const Field&) {
    const std::string flag = flag_of(info.name);
    const std::string also = info.also;
    read_by_.clear();
    read(info.name, variable_of(flag), /*takes_back=*/false);
    if (!also.empty()) read(info.name, variable_of(also), /*takes_back=*/false);
    if constexpr (is_switch<Field>) {
      read(info.name, variable_of("--no-" + flag.substr(std::strlen("--"))), /*takes_back=*/true);
    }
  }

  const v1::NodeConfig& config() const { return config_; }
  const std::string& error() const { return error_; }

  // Of all options, set or not.
  const std::vector<std::string>& variables() const { return variables_; }

 private:
  void read(const std::string& option, const std::string& variable, bool takes_back) {
    variables_.push_back(variable);
    const char* text = std::getenv(variable.c_str());
    if (text == nullptr || !error_.empty()) return;
    v1::NodeConfig said;
    if (const std::string why = set_as_said(said, option, takes_back ? opposite(text) : text);
        !why.empty()) {
      error_ = "environment variable " + variable + ": " + why;
    } else if (read_by_.empty()) {
      config_.MergeFrom(said);
      read_by_ = variable;
      said_ = std::move(said);
    } else if (said.SerializeAsString() != said_.SerializeAsString()) {
      error_ = "environment variables " + read_by_ + " and " + variable +
               " set one option to different values";
    }
  }

  v1::NodeConfig config_;
  std::string read_by_;  // the variable that has set the present option; empty = none
  v1::NodeConfig said_;  // what it said
  std::string error_;
  std::vector<std::string> variables_;
};

EnvironmentReader read_environment() {
  EnvironmentReader reader;
  const NodeOptions options;
  for_each_option(options, reader);
  return reader;
}

}  // namespace

Result<v1::NodeConfig> config_from_environment() {
  const EnvironmentReader reader = read_environment();
  if (!reader.error().empty()) return Result<v1::NodeConfig>::fail(reader.error());
  return Result<v1::NodeConfig>::ok(reader.config());
}

std::string config_file_from_environment() {
  const char* path = std::getenv(kConfigFile);
  return path == nullptr ? std::string() : path;
}

std::vector<std::string> unread_variables() {
  std::vector<std::string> known = read_environment().variables();
  known.emplace_back(kConfigFile);
  // Compared without what they all begin with, which would make any two alike.
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const std::string& variable : known) names.push_back(variable.substr(kPrefix.size()));
  std::vector<std::string> sentences;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view setting = *entry;
    const std::string variable(setting.substr(0, setting.find('=')));
    if (!variable.starts_with(kPrefix) ||
        std::find(known.begin(), known.end(), variable) != known.end()) {
      continue;
    }
    const std::string nearest = nearest_word(variable.substr(kPrefix.size()), names);
    sentences.push_back("environment variable " + printable(variable) +
                        " is not read: no option has that name" +
                        (nearest.empty() ? "" : ", did you mean PALPATE_" + nearest + "?"));
  }
  return sentences;
}

}  // namespace palpate
