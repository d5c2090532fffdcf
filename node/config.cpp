#include "node/config.h"

#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <chrono>
#include <sstream>
#include <type_traits>

#include "node/files/text_format.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Reflection;
using Seconds = std::chrono::duration<double>;

template <typename Number>
bool parse_number(const std::string& text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

bool parse_bool(const std::string& text, bool& value) {
  value = text == "true" || text == "1";
  return value || text == "false" || text == "0";
}

const FieldDescriptor* field_of(const std::string& name) {
  return v1::NodeConfig::descriptor()->FindFieldByName(name);
}

std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// Copies one field of the configuration message into the options and checks its range.
class Reader {
 public:
  explicit Reader(const v1::NodeConfig& config) : config_(config) {}

  template <typename Field>
  void operator()(const OptionInfo& info, Field& field) {
    const FieldDescriptor* descriptor = field_of(info.name);
    assert(descriptor != nullptr);
    const Reflection& reflection = *v1::NodeConfig::GetReflection();
    if constexpr (std::is_same_v<Field, std::vector<std::string>>) {
      const int count = reflection.FieldSize(config_, descriptor);
      if (count > 0) field.clear();
      for (int i = 0; i < count; ++i) {
        field.push_back(reflection.GetRepeatedString(config_, descriptor, i));
      }
    } else if (reflection.HasField(config_, descriptor)) {
      if constexpr (std::is_same_v<Field, std::string>) {
        field = reflection.GetString(config_, descriptor);
      } else if constexpr (is_switch<Field>) {
        field = reflection.GetBool(config_, descriptor);
      } else if constexpr (std::is_integral_v<Field>) {
        field = reflection.GetUInt32(config_, descriptor);
        check(info, static_cast<double>(field));
      } else if constexpr (std::is_same_v<Field, Seconds>) {
        field = Seconds(reflection.GetDouble(config_, descriptor));
        check(info, field.count());
      } else {
        field = reflection.GetDouble(config_, descriptor);
        check(info, field);
      }
    }
  }

  const std::string& error() const { return error_; }

 private:
  void check(const OptionInfo& info, double value) {
    if (value >= info.lowest && value <= info.highest) return;  // false for NaN
    error_ = std::string(info.name) + ": " + number_text(value) + " is not within " +
             number_text(info.lowest) + " to " + number_text(info.highest);
  }

  const v1::NodeConfig& config_;
  std::string error_;
};

// Copies one option into the configuration message.
class Writer {
 public:
  explicit Writer(v1::NodeConfig& config) : config_(config) {}

  template <typename Field>
  void operator()(const OptionInfo& info, const Field& field) {
    const FieldDescriptor* descriptor = field_of(info.name);
    assert(descriptor != nullptr);
    const Reflection& reflection = *v1::NodeConfig::GetReflection();
    if constexpr (std::is_same_v<Field, std::vector<std::string>>) {
      for (const std::string& text : field) reflection.AddString(&config_, descriptor, text);
    } else if constexpr (std::is_same_v<Field, std::string>) {
      reflection.SetString(&config_, descriptor, field);
    } else if constexpr (std::is_same_v<Field, bool>) {
      reflection.SetBool(&config_, descriptor, field);
    } else if constexpr (std::is_same_v<Field, std::optional<bool>>) {
      if (field) reflection.SetBool(&config_, descriptor, *field);
    } else if constexpr (std::is_integral_v<Field>) {
      reflection.SetUInt32(&config_, descriptor, static_cast<std::uint32_t>(field));
    } else if constexpr (std::is_same_v<Field, Seconds>) {
      reflection.SetDouble(&config_, descriptor, field.count());
    } else {
      reflection.SetDouble(&config_, descriptor, field);
    }
  }

 private:
  v1::NodeConfig& config_;
};

std::string resolve_given_class(NodeOptions& options) {
  options.intake.group.given_class = {};
  if (options.given_class.empty()) return {};
  const std::optional<CurveClass> given = curve_class_from_name(options.given_class);
  if (!given || *given == CurveClass::Unclassified) {
    return "given_class: \"" + options.given_class + "\" is no curve class";
  }
  if (!options.words.classes.empty() || options.words.method != RecognizerWords{}.method) {
    return "given_class: no other is considered, so give neither classes nor a method beside it";
  }
  options.intake.group.given_class = given;
  return {};
}

// Checks what involves more than one option.
std::string check_together(const NodeOptions& options) {
  if (!is_valid_name(options.name)) return "name: expected 1 to 64 of [A-Za-z0-9_.-]";
  for (const std::string& prefix : options.probe_prefixes) {
    if (!is_valid_name(prefix)) return "probe_prefixes: expected 1 to 64 of [A-Za-z0-9_.-] each";
  }
  if (options.curve_secret_key.empty() != options.allow_clients.empty()) {
    return "curve_secret_key and allow_clients: give both or neither";
  }
  constexpr std::string_view kLevels[] = {"trace", "debug", "info", "warning", "error", "off"};
  if (std::find(std::begin(kLevels), std::end(kLevels), options.log_level) == std::end(kLevels)) {
    return "log_level: expected trace, debug, info, warning, error or off";
  }
  for (const std::vector<std::string>* side : {&options.contacts, &options.results}) {
    for (const std::string& text : *side) {
      const Result<Endpoint> endpoint = parse_endpoint(text, /*bind_by_default=*/true);
      if (!endpoint) return endpoint.error;
      const bool open = endpoint.value->bind && !is_local(*endpoint.value);
      if (open && options.curve_secret_key.empty() && !options.insecure) {
        return text +
               " is open to the network: give curve_secret_key and allow_clients, or say "
               "insecure";
      }
    }
  }
  return {};
}

}  // namespace

std::string set_option(v1::NodeConfig& config, const std::string& name, const std::string& text) {
  const FieldDescriptor* field = field_of(name);
  if (field == nullptr) return name + ": no such option";
  const Reflection& reflection = *v1::NodeConfig::GetReflection();
  bool good = true;
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      if (field->is_repeated()) {
        reflection.AddString(&config, field, text);
      } else {
        reflection.SetString(&config, field, text);
      }
      break;
    case FieldDescriptor::CPPTYPE_BOOL: {
      bool value = false;
      good = parse_bool(text, value);
      if (good) reflection.SetBool(&config, field, value);
      break;
    }
    case FieldDescriptor::CPPTYPE_UINT32: {
      std::uint32_t value = 0;
      good = parse_number(text, value);
      if (good) reflection.SetUInt32(&config, field, value);
      break;
    }
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      double value = 0.0;
      good = parse_number(text, value);
      if (good) reflection.SetDouble(&config, field, value);
      break;
    }
    default:
      good = false;
  }
  return good ? std::string() : name + ": \"" + text + "\" is no " + field->cpp_type_name();
}

Result<v1::NodeConfig> read_config_file(const std::string& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return Result<v1::NodeConfig>::fail(text.error);
  v1::NodeConfig config;
  if (std::string error = parse_text(*text.value, path, config); !error.empty()) {
    return Result<v1::NodeConfig>::fail(std::move(error));
  }
  return Result<v1::NodeConfig>::ok(std::move(config));
}

v1::NodeConfig merge(const v1::NodeConfig& under, const v1::NodeConfig& over) {
  v1::NodeConfig merged = under;
  // MergeFrom appends to lists, but a list set in `over` replaces the one in `under`.
  const Reflection& reflection = *v1::NodeConfig::GetReflection();
  std::vector<const FieldDescriptor*> given;
  reflection.ListFields(over, &given);
  for (const FieldDescriptor* field : given) reflection.ClearField(&merged, field);
  merged.MergeFrom(over);
  return merged;
}

Result<NodeOptions> make_options(const v1::NodeConfig& config) {
  NodeOptions options;
  Reader reader(config);
  for_each_option(options, reader);
  if (!reader.error().empty()) return Result<NodeOptions>::fail(reader.error());
  std::string error = resolve(options.words, options.intake.recognizer);
  if (error.empty()) error = resolve_given_class(options);
  if (error.empty()) error = check_together(options);
  if (!error.empty()) return Result<NodeOptions>::fail(std::move(error));
  return Result<NodeOptions>::ok(std::move(options));
}

v1::NodeConfig to_config(const NodeOptions& options) {
  v1::NodeConfig config;
  Writer writer(config);
  for_each_option(options, writer);
  return config;
}

std::string to_text(const v1::NodeConfig& config) {
  std::string text;
  google::protobuf::TextFormat::PrintToString(config, &text);
  return text;
}

}  // namespace palpate
