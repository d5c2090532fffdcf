#include "tests/bench/options/bench_options.h"

#include <CLI/CLI.hpp>

namespace palpate::bench {

BenchOptions::BenchOptions(const std::string& about) : app_(std::make_unique<CLI::App>(about)) {}

BenchOptions::~BenchOptions() = default;

BenchOptions& BenchOptions::number(const std::string& name, int& value, const std::string& help) {
  app_->add_option(name, value, help)->capture_default_str()->check(CLI::PositiveNumber);
  return *this;
}

BenchOptions& BenchOptions::number(const std::string& name, double& value,
                                   const std::string& help) {
  app_->add_option(name, value, help)->capture_default_str()->check(CLI::PositiveNumber);
  return *this;
}

BenchOptions& BenchOptions::seed(std::uint64_t& value) {
  app_->add_option("--seed", value, "Of the random numbers")->capture_default_str();
  return *this;
}

BenchOptions& BenchOptions::text(const std::string& name, std::string& value,
                                 const std::string& help) {
  app_->add_option(name, value, help)->capture_default_str();
  return *this;
}

BenchOptions& BenchOptions::one_of(std::initializer_list<const char*> members,
                                   const std::string& name, std::string& value,
                                   const std::string& help) {
  app_->add_option(name, value, help)
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(members.begin(), members.end())));
  return *this;
}

BenchOptions& BenchOptions::flag(const std::string& name, bool& value, const std::string& help) {
  app_->add_flag(name, value, help);
  return *this;
}

BenchOptions& BenchOptions::files(std::vector<std::string>& value, const std::string& help) {
  app_->add_option("files", value, help);
  return *this;
}

std::optional<int> BenchOptions::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error);
  }
  return std::nullopt;
}

}  // namespace palpate::bench
