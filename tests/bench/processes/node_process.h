// A palpate-node as a child process, started and observed by the benchmarks of the running system.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/v1/contact.pb.h"

namespace palpate::bench {

using Clock = std::chrono::steady_clock;

/// A folder for sockets, removed with this object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Killed with this object, or with this process.
class NodeProcess {
 public:
  NodeProcess(const std::string& contacts, const std::string& results,
              const std::vector<std::string>& further_arguments = {});
  ~NodeProcess();
  NodeProcess(const NodeProcess&) = delete;
  NodeProcess& operator=(const NodeProcess&) = delete;

  double cpu_seconds() const;     ///< used so far, user and system
  double resident_bytes() const;  ///< memory in use now

 private:
  pid_t pid_;
};

/// Samples `first` to `first + count` of an arc of a circle of 20 mm, 0.2 mm apart, at 20 um noise.
v1::ContactBatch batch_of(int first, int count, std::uint64_t object);

double microseconds(Clock::duration duration);

/// The q-quantile of the values; sorts them.
double quantile(std::vector<double>& values, double fraction);

}  // namespace palpate::bench
