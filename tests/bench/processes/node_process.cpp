#include "tests/bench/processes/node_process.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace palpate::bench {
namespace {

constexpr double kRadius_m = 0.02;
constexpr double kStep_rad = 0.01;
constexpr double kSigma_m = 2e-5;

}  // namespace

TemporaryFolder::TemporaryFolder() {
  char name[] = "/tmp/palpate-bench-XXXXXX";
  if (mkdtemp(name) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

NodeProcess::NodeProcess(const std::string& contacts, const std::string& results,
                         const std::vector<std::string>& further_arguments) {
  std::vector<std::string> words{"palpate-node", "--contacts",  contacts, "--results",
                                 results,        "--log-level", "off"};
  words.insert(words.end(), further_arguments.begin(), further_arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    execv(PALPATE_NODE, arguments.data());
    std::_Exit(127);
  }
}

NodeProcess::~NodeProcess() {
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

double NodeProcess::cpu_seconds() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
  std::string text;
  std::getline(file, text);
  // proc(5): fields after the name in parentheses; user and system time are the 14th and 15th.
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double NodeProcess::resident_bytes() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/statm");
  double pages = 0.0;
  double resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

namespace {

/// Repeatable scatter of variance 1, independent between neighbours: SplitMix64's mixing (G.
/// Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014).
double scatter_of(int i) {
  std::uint64_t bits = 0x9e3779b97f4a7c15U * (static_cast<std::uint64_t>(i) + 1);
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  bits ^= bits >> 31U;
  return std::sqrt(12.0) * (std::ldexp(static_cast<double>(bits), -64) - 0.5);
}

}  // namespace

v1::ContactBatch batch_of(int first, int count, std::uint64_t object) {
  v1::ContactBatch batch;
  batch.set_object(object);
  for (int i = first; i < first + count; ++i) {
    v1::ContactSample& sample = *batch.add_samples();
    const double radius = kRadius_m + kSigma_m * scatter_of(i);
    sample.set_x_m(radius * std::cos(kStep_rad * i));
    sample.set_y_m(radius * std::sin(kStep_rad * i));
    sample.set_sigma_m(kSigma_m);
    sample.set_stamp_ns(1);
  }
  return batch;
}

double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

double quantile(std::vector<double>& values, double fraction) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

}  // namespace palpate::bench
