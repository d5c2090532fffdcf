// What is wrong with a command line, in a sentence.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace palpate {

/// For complain(): what CLI11 found, without its line breaks. Of an unknown command or option the
/// known one that is spelled most alike, if one is, and in any case who lists them all.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace palpate
