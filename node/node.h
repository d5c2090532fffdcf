// The recognizer as a process: contacts in, recognitions out. One thread polls and serves all
// sockets; worker threads compute.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "node/files/probe_files.h"
#include "node/files/result.h"
#include "node/groups/compute_times.h"
#include "node/groups/intake.h"
#include "node/groups/workers.h"
#include "node/options.h"
#include "node/process/service_manager.h"
#include "node/publish/operator_log.h"
#include "node/publish/result_publisher.h"
#include "node/security/node_keys.h"
#include "node/security/peer_guard.h"
#include "node/security/zap_handler.h"
#include "node/wire/path_lock.h"
#include "node/wire/reconnect_guard.h"
#include "node/wire/socket.h"
#include "palpate/v1/node_status.pb.h"

namespace palpate {

class Node {
 public:
  /// Opens all sockets. `options` must come from make_options(); `probe_files` are those that the
  /// options name. Throws std::runtime_error if an endpoint cannot be opened.
  Node(const NodeOptions& options, const NodeKeys& keys, ProbeFiles probe_files = {});

  /// Serves until `stop_fd` is readable. Then recognises and publishes what has been received, for
  /// at most 0.2 s, and returns. When `reload_fd` (take_reload_signal) signals, reads the list of
  /// allowed clients and the probe files again.
  void run(int stop_fd, int reload_fd = -1);
  /// Number of recognitions that still computed when run() gave up waiting for them.
  std::size_t unfinished_count() const { return workers_.busy_count(); }

  /// Address of the last endpoint bound. For "tcp://127.0.0.1:*" it holds the port that the system
  /// chose.
  std::string contacts_address() const { return contacts_.get(zmq::sockopt::last_endpoint); }
  std::string results_address() const { return results_.get(zmq::sockopt::last_endpoint); }

 private:
  // What one worker computes; group is nullptr if it is idle.
  struct InWork {
    Group* group = nullptr;
    bool is_slow = false;  // by its last answer
    SteadyTime since;
  };

  zmq::socket_t open(zmq::socket_type type, const std::vector<std::string>& endpoints,
                     const SocketSettings& settings);
  std::unique_ptr<PeerGuard> guard(zmq::socket_t& socket, const std::vector<std::string>& endpoints,
                                   const char* what);
  bool drain_contacts(SteadyTime deadline);
  void give_out_work(SteadyTime now);
  std::size_t slow_count(SteadyTime now) const;
  void take_answers();
  void publish(Group& group);
  void forget_evicted();
  void tick(SteadyTime now);
  void publish_status(SteadyTime now);
  void log_cuts();
  std::uint64_t connections_cut() const;
  void give_memory_back();
  void reload_clients();
  void reload_probe_files();
  void finish();

  NodeOptions options_;
  zmq::context_t context_;
  std::vector<PathLock> locks_;
  std::optional<ZapHandler> zap_;
  zmq::socket_t contacts_;
  zmq::socket_t results_;
  std::vector<std::unique_ptr<ReconnectGuard>> guards_;
  std::unique_ptr<PeerGuard> contact_peers_;  // nullptr if the socket connects
  std::unique_ptr<PeerGuard> result_peers_;
  std::shared_ptr<const ProbeFiles> probe_files_;  // nullptr if the options name none
  Intake intake_;
  ResultPublisher publisher_;
  ComputeTimes compute_times_;
  std::uint64_t recognitions_published_ = 0;
  std::uint64_t cuts_at_last_status_ = 0;
  std::uint64_t cuts_before_last_status_ = 0;
  std::uint64_t turned_away_told_ = 0;
  std::size_t at_a_time_;  // recognitions computed at the same time, without the slow ones
  Workers workers_;
  std::vector<InWork> in_work_;  // indexed by worker
  ServiceManager service_manager_;
  SteadyTime started_;
  SteadyTime next_tick_;
  SteadyTime next_status_;
  OperatorLog operator_log_;

  // Kept between messages so that parsing and filling allocate nothing.
  TwoFrames incoming_;
  v1::NodeStatus status_message_;
};

}  // namespace palpate
