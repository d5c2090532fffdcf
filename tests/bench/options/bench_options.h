// The command line of a benchmark: a small interface to CLI11, because every file that includes
// CLI11 compiles it.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace palpate::bench {

/// A value keeps its content, which --help prints, unless the command line sets it.
class BenchOptions {
 public:
  explicit BenchOptions(const std::string& about);
  ~BenchOptions();

  /// Numbers above zero; a seed may be 0.
  BenchOptions& number(const std::string& name, int& value, const std::string& help);
  BenchOptions& number(const std::string& name, double& value, const std::string& help);
  BenchOptions& seed(std::uint64_t& value);
  BenchOptions& text(const std::string& name, std::string& value, const std::string& help);
  /// A text that must be one of `members`.
  BenchOptions& one_of(std::initializer_list<const char*> members, const std::string& name,
                       std::string& value, const std::string& help);
  BenchOptions& flag(const std::string& name, bool& value, const std::string& help);
  /// Arguments without a name.
  BenchOptions& files(std::vector<std::string>& value, const std::string& help);

  /// The exit code if the program should end: after --help, or after printing an error.
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace palpate::bench
