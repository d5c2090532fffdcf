// Reads the node's options. A flag overrides the environment (environment.h), which overrides the
// file, which overrides the default.
#pragma once

#include <cstdint>
#include <string>

#include "node/files/result.h"
#include "node/options.h"
#include "palpate/v1/node_config.pb.h"

namespace palpate {

/// Sets the option `name` (a name of the table in options.h) from text. Returns an empty string, or
/// an error: the name is unknown, or the text is not a value of the option's type.
std::string set_option(v1::NodeConfig& config, const std::string& name, const std::string& text);

/// Reads a configuration file in protobuf text format. An unknown field is an error.
Result<v1::NodeConfig> read_config_file(const std::string& path);

/// Returns `over`, completed by `under` where `over` sets nothing. A list in `over` replaces the
/// one in `under`.
v1::NodeConfig merge(const v1::NodeConfig& under, const v1::NodeConfig& over);

/// Returns the defaults overridden by `config`, or an error. Checks each value against its range,
/// and all together: endpoints, CURVE, and that no endpoint is open to the network without CURVE
/// unless `insecure` is set.
Result<NodeOptions> make_options(const v1::NodeConfig& config);

/// The inverse of make_options(): all options as a configuration message.
v1::NodeConfig to_config(const NodeOptions& options);
/// The same in protobuf text format.
std::string to_text(const v1::NodeConfig& config);

}  // namespace palpate
