// An ordinary palpate-node as a child process. It receives contacts from the plant.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "node/wire/ingest_limits.h"
#include "node/wire/socket.h"

namespace palpate::gateway {

struct FedNodeOptions {
  std::string program = "palpate-node";
  std::string config;  ///< configuration file of the node; empty = none
  std::string folder;  ///< holds its two endpoints; tools may use them like those of any node
  /// Longest contact message: the node would cut our connection for a longer one. [bytes]
  std::size_t max_message_bytes = IngestLimits{}.max_message_bytes;
  /// Groups that the node holds. It must forget none that we do not forget: it would go on with a
  /// part of its object.
  std::size_t most_groups = 16'384;
};

/// Starts without any sequence or object. The node ends with this object and with this process.
class FedNode {
 public:
  /// The endpoints are ipc://FOLDER/NAME.contacts and .results. Throws std::runtime_error if the
  /// node cannot be started.
  FedNode(zmq::context_t& context, const FedNodeOptions& options, const std::string& name);
  ~FedNode();
  FedNode(const FedNode&) = delete;
  FedNode& operator=(const FedNode&) = delete;

  /// True if the node receives what we send and we receive all that it publishes. `heard`: a status
  /// has been received.
  bool is_ready(bool heard);

  /// How the node's process has ended, to follow "its node "; empty while it runs.
  const std::string& how_ended();

  /// Nothing is lost: our queue has no bound, but GroupFeed bounds what can be in it.
  void send(std::string_view topic, std::string_view payload);

  /// Receives a message of the node; false if none waits.
  bool receive(TwoFrames& message) { return receive_now(results_, message); }
  zmq::socket_t& results() { return results_; }

 private:
  std::string contacts_path_;
  std::string results_path_;
  std::string program_;
  pid_t process_ = -1;
  std::string end_;
  zmq::socket_t contacts_;
  zmq::socket_t results_;
  bool is_heard_ = false;
};

}  // namespace palpate::gateway
