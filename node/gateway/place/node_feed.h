// Sends the contacts of a place's groups to its node, and hears which of them the node rejects and
// answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "node/gateway/place/fed_node.h"
#include "node/gateway/place/group_feed.h"
#include "node/process/clock.h"
#include "palpate/v1/header.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::gateway {

class NodeFeed {
 public:
  struct Events {
    std::function<void(const std::string& group, const FedContact& contact)> rejected;
    /// May end this feed.
    std::function<void(const v1::Recognition& recognition, const AnsweredSpan& span,
                       std::string_view payload)>
        answered;
    /// The node must be begun anew.
    std::function<void(const std::string& why)> failed;
  };

  NodeFeed(zmq::context_t& context, FedNodeOptions node, Events events);

  /// Starts a node, which knows nothing. Throws std::runtime_error if it cannot be started.
  void begin(const std::string& name, SteadyTime now);
  /// Ends the node and forgets all contacts.
  void forget();

  /// In the stream's order within a group.
  void add(const std::string& group, FedContact contact);

  /// Reads what the node has sent, and sends it what may go. Call it often.
  void serve(SteadyTime now);

  /// Number of contacts sent, and neither answered nor rejected yet.
  std::size_t in_flight_count() const { return in_flight_count_; }

  /// The socket of the node's results, to be polled; nullptr if there is no node at present.
  zmq::socket_t* socket() { return node_ ? &node_->results() : nullptr; }

 private:
  struct Group {
    GroupFeed feed;
    bool is_ready = false;  // it is in ready_
  };
  using Groups = std::map<std::string, Group, std::less<>>;
  using Entry = Groups::value_type;

  struct Given {
    Entry* group = nullptr;
    FedContact contact;  // without its payload
  };

  void make_ready(Entry& group);
  void give();
  void hear(const TwoFrames& message);
  void took(const v1::Header& header, std::string_view probe);
  void rejected();
  void answered(const v1::Recognition& recognition, std::string_view payload);

  zmq::context_t& context_;
  FedNodeOptions options_;
  Events events_;

  // State that forget() discards.
  std::unique_ptr<FedNode> node_;
  bool has_spoken_ = false;
  SteadyTime heard_;
  Groups groups_;
  std::deque<Entry*> ready_;
  std::deque<Given> given_;  // sent to the node, which has not shown yet whether it accepts them
  std::uint64_t given_count_ = 0;
  std::size_t in_flight_count_ = 0;
  std::size_t in_flight_bytes_ = 0;
};

}  // namespace palpate::gateway
