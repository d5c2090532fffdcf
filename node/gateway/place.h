// A partition of a cell's groups, taken by this process: contacts from the plant to a node of its
// own, the node's answers back.
//
// What makes it exact: an answer is stored only as the next one after the answer that its
// recogniser knows as the last of the group (Nats-Expected-Last-Subject-Sequence). It says in its
// headers up to which contact of the stream it answers, and where its object begins. So the answers
// themselves are the ledger: whoever takes the place reads the last one of a group, gives its
// object's contacts to a fresh node again, and goes on with the contact after it. A recogniser that
// was believed dead and still answers is refused, and begins anew. Whatever else goes wrong (the
// node ends, a message is missing, the consumer is gone) has the same cure: begin anew.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "node/gateway/contact_consumer.h"
#include "node/gateway/fed_node.h"
#include "node/gateway/group_feed.h"
#include "node/gateway/plant.h"
#include "palpate/v1/gateway_status.pb.h"
#include "palpate/v1/header.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::gateway {

class Place {
 public:
  /// Touches nothing of the plant's before `begin_at`.
  Place(zmq::context_t& context, Plant& plant, PlaceName name, FedNodeOptions node,
        SteadyTime begin_at);
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Takes what has come from the node, gives it what may go. Call it often; plant.serve() calls
  /// the rest.
  void serve(SteadyTime now);

  /// The node's results, to be polled; nullptr where there is none at present.
  zmq::socket_t* socket() { return node_ ? &node_->results() : nullptr; }

  const PlaceName& name() const { return name_; }
  const v1::GatewayPlaceStatus& status() const { return status_; }

 private:
  // An answer that is to be stored, or is being.
  struct Answer {
    AnsweredSpan span;
    std::string id;
    std::string payload;
  };

  struct Group {
    enum class State { Unknown, Asking, Live };
    State state = State::Unknown;
    std::deque<FedContact> arrived;   // before it is known what of them is answered
    std::deque<FedContact> replayed;  // of the present object, answered
    int tries = 0;                    // to have them all
    GroupFeed feed;
    std::deque<std::uint64_t> unanswered;  // stream_seq of the contacts that are new
    std::uint64_t through = 0;             // contacts answered by what is stored
    std::uint64_t last_answer_seq = 0;     // in the stream of recognitions; 0 = none
    std::deque<Answer> answers;
    bool is_storing = false;
    bool is_first_sent = false;  // answers' first may be stored already: it stays as it is
    bool is_ready = false;       // in ready_
  };

  struct Given {
    Group* group = nullptr;
    FedContact contact;  // without its payload
  };

  void begin(SteadyTime now);
  void fail(const std::string& why);
  void forget_all();
  void take_contact(const PlantMessage& message, std::uint64_t stream_seq);

  // What of a group is answered already, and its present object again.
  void ask(const std::string& name, Group& group);
  void replay(const std::string& name, std::uint64_t object, std::uint64_t next_seq);
  void end_replay(Group& group);
  void add_new(Group& group, FedContact contact);

  // Between the node and the plant.
  void make_ready(Group& group);
  void give();
  void hear(const TwoFrames& message);
  void node_took(const v1::Header& header, std::string_view probe);
  void node_rejected();
  void node_answered(const v1::Recognition& recognition, std::string_view payload);
  void store_next(const std::string& name, Group& group);
  void stored(const std::string& name, const Stored& stored);
  void is_it_ours(const std::string& name);
  void tend(SteadyTime now);

  zmq::context_t& context_;
  Plant& plant_;
  PlaceName name_;
  FedNodeOptions node_options_;
  ContactConsumer consumer_;
  v1::GatewayPlaceStatus status_;

  // All that a new beginning forgets.
  std::unique_ptr<FedNode> node_;
  bool node_has_spoken_ = false;
  SteadyTime node_heard_;
  std::map<std::string, Group, std::less<>> groups_;
  std::deque<Group*> ready_;
  std::deque<Given> given_;  // to the node, which has not yet shown whether it takes them
  std::uint64_t given_count_ = 0;
  std::size_t in_flight_count_ = 0;
  std::size_t in_flight_bytes_ = 0;

  SteadyTime begin_at_;
  bool has_begun_ = false;
  SteadyTime next_tend_;
};

}  // namespace palpate::gateway
