#include "node/security/open_files.h"

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>

namespace palpate {
namespace {

// The rest of kKeptFromPeers is for peers that come faster than others are cut.
constexpr std::size_t kNeverForPeers = kKeptFromPeers / 2;

std::atomic<int> first_kept{std::numeric_limits<int>::max()};
std::atomic<std::uint64_t> turned_away{0};

}  // namespace

std::size_t raise_open_files_limit() {
  constexpr rlim_t kMost = std::numeric_limits<int>::max();
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return kMost;  // a sandbox may not tell it
  const rlimit raised{limit.rlim_max, limit.rlim_max};
  const bool is_raised = ::setrlimit(RLIMIT_NOFILE, &raised) == 0;
  return static_cast<std::size_t>(std::min(is_raised ? raised.rlim_cur : limit.rlim_cur, kMost));
}

std::size_t count_open_files() {
  std::error_code error;
  const std::filesystem::directory_iterator files("/proc/self/fd", error);
  if (error) return 0;
  // One of them is that of the folder itself.
  return static_cast<std::size_t>(std::distance(begin(files), end(files))) - 1;
}

std::size_t peers_within(std::size_t limit, std::size_t in_use, std::size_t sockets) {
  const std::size_t taken = in_use + kKeptFromPeers;
  return limit <= taken || sockets == 0 ? 0 : (limit - taken) / sockets;
}

void turn_peers_away_at(std::size_t limit) {
  first_kept = static_cast<int>(limit) - static_cast<int>(kNeverForPeers);
}

std::uint64_t peers_turned_away() { return turned_away; }

}  // namespace palpate

/// In the place of the C library's, for libzmq calls it by this name. The system gives the lowest
/// free descriptor, so one this high tells that hardly any are left.
extern "C" int accept4(int listener, sockaddr* address, socklen_t* length, int flags) {
  const auto accepted = static_cast<int>(::syscall(SYS_accept4, listener, address, length, flags));
  if (accepted < palpate::first_kept.load(std::memory_order_relaxed)) return accepted;
  (void)::close(accepted);
  palpate::turned_away.fetch_add(1, std::memory_order_relaxed);
  errno = ECONNABORTED;  // as of a peer that has left meanwhile, which libzmq expects
  return -1;
}
