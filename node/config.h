// Where options come from: flag, else environment, else file, else default.
#pragma once

#include <cstdint>
#include <string>

#include "node/files/result.h"
#include "node/options.h"
#include "palpate/v1/node_config.pb.h"

namespace palpate {

/// Sets the option `name` (as in the table) from text. Returns an empty string, or what is wrong:
/// an unknown name, or no value of the option's type.
std::string set_option(v1::NodeConfig& config, const std::string& name, const std::string& text);

/// Reads a configuration file; unknown fields are errors.
Result<v1::NodeConfig> read_config_file(const std::string& path);

/// What the environment sets: PALPATE_<NAME IN CAPITALS>. Lists are separated by commas.
Result<v1::NodeConfig> config_from_environment();

/// `over` where it says something, else `under`.
v1::NodeConfig merge(const v1::NodeConfig& under, const v1::NodeConfig& over);

/// The defaults with `config` upon them, checked: each value within its range, and all together
/// (endpoints, CURVE, nothing open to the network unless that is said aloud).
Result<NodeOptions> make_options(const v1::NodeConfig& config);

/// All options as a configuration file says them.
v1::NodeConfig to_config(const NodeOptions& options);
/// The same in protobuf text format.
std::string to_text(const v1::NodeConfig& config);

}  // namespace palpate
