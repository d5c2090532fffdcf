// What the environment says of the node's options.
#pragma once

#include <string>
#include <vector>

#include "node/files/result.h"
#include "palpate/v1/node_config.pb.h"

namespace palpate {

/// Reads the options set in the environment: PALPATE_<NAME IN CAPITALS>, where the name is any
/// spelling of the option's flag (PALPATE_SIGMA, PALPATE_SIGMA_M, PALPATE_NO_INSECURE). Lists are
/// separated by commas. Fails if a value is none of the option's type, and if two spellings of one
/// option say different things.
Result<v1::NodeConfig> config_from_environment();

/// The configuration file that PALPATE_CONFIG names; empty = none.
std::string config_file_from_environment();

/// A sentence on each variable PALPATE_... that no option reads, with the one that may be meant.
std::vector<std::string> unread_variables();

}  // namespace palpate
