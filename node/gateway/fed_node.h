// An ordinary palpate-node as a child process, fed with contacts of the plant.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "node/wire/socket.h"

namespace palpate::gateway {

struct FedNodeOptions {
  std::string program = "palpate-node";
  std::string config;  ///< its configuration file; empty = none
  std::string folder;  ///< of its two endpoints, which tools may use as any node's
  /// Longest contact message: a longer one would cost us the connection. [bytes]
  std::size_t max_message_bytes = 65536;
};

/// Fresh: it knows of no sequence and no object. Ends with this, and with this process.
class FedNode {
 public:
  /// Endpoints are ipc://FOLDER/NAME.contacts and .results. Throws std::runtime_error where it
  /// cannot be started.
  FedNode(zmq::context_t& context, const FedNodeOptions& options, const std::string& name);
  ~FedNode();
  FedNode(const FedNode&) = delete;
  FedNode& operator=(const FedNode&) = delete;

  /// Whether it hears us, and we hear all that it says. `heard`: a status has been received.
  bool is_ready(bool heard);

  /// Whether its process has ended.
  bool has_ended();

  /// Never lost: our queue has no bound, and what may be in it has (GroupFeed).
  void send(std::string_view topic, std::string_view payload);

  /// What it has said; false where nothing waits.
  bool receive(TwoFrames& message) { return receive_now(results_, message); }
  zmq::socket_t& results() { return results_; }

 private:
  std::string contacts_path_;
  std::string results_path_;
  pid_t process_ = -1;
  zmq::socket_t contacts_;
  zmq::socket_t results_;
  bool is_heard_ = false;
};

}  // namespace palpate::gateway
