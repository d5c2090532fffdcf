// A place: a partition of a cell's groups that this process has taken. It sends contacts from the
// plant to a node of its own and stores the node's answers on the plant.
//
// Every contact is answered exactly once, because the plant stores an answer only as the next one
// after the answer that its recognizer knows as the group's last
// (Nats-Expected-Last-Subject-Sequence). The headers of an answer say up to which contact of the
// stream it covers, and where its object begins. So the stored answers are the ledger. A process
// that takes the place reads the last answer of a group, sends the contacts of its object to a
// fresh node again, and continues with the contact after it. A recognizer that was believed dead
// and still answers is refused, and begins anew. All other failures (the node ends, a message is
// missing, the consumer is gone) are handled in the same way: begin anew.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "node/gateway/place/contact_consumer.h"
#include "node/gateway/place/contact_ledger.h"
#include "node/gateway/place/group_feed.h"
#include "node/gateway/place/node_feed.h"
#include "node/gateway/plant/plant.h"
#include "palpate/v1/gateway_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::gateway {

class Place {
 public:
  /// Does nothing on the plant before `begin_at`.
  Place(zmq::context_t& context, Plant& plant, PlaceName name, const FedNodeOptions& node,
        SteadyTime begin_at);
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Reads what the node has sent, and sends it what may go. Call it often; plant.serve() calls the
  /// rest.
  void serve(SteadyTime now);

  /// The socket of the node's results, to be polled; nullptr if there is no node at present.
  zmq::socket_t* socket() { return feed_.socket(); }

  const PlaceName& name() const { return name_; }
  const v1::GatewayPlaceStatus& status() const { return status_; }

 private:
  // An answer that waits to be stored, or is being stored.
  struct Answer {
    AnsweredSpan span;
    std::string id;
    std::string payload;
  };

  struct Group {
    enum class State { Unknown, Asking, Live };
    State state = State::Unknown;
    std::deque<FedContact> arrived;        // received before we know which of them are answered
    std::deque<FedContact> replayed;       // answered contacts of the present object
    int tries = 0;                         // attempts to read them all
    std::deque<std::uint64_t> unanswered;  // stream_seq of the new contacts
    std::uint64_t through = 0;             // last contact covered by a stored answer
    std::uint64_t last_answer_seq = 0;     // in the stream of recognitions; 0 = none
    std::deque<Answer> answers;
    bool is_storing = false;
    // The first of `answers` may be stored already, so it must not change.
    bool is_first_sent = false;
  };

  void begin(SteadyTime now);
  void fail(const std::string& why);
  void begin_anew();
  bool is_waiting() const;
  void forget_all();
  void take_contact(const PlantMessage& message, std::uint64_t stream_seq);

  // Finds out which contacts of a group are answered, and replays its present object.
  void ask(const std::string& name, Group& group);
  void replay(const std::string& name, std::uint64_t object, std::uint64_t next_seq);
  void end_replay(const std::string& name, Group& group);
  void add_new(const std::string& name, Group& group, FedContact contact);
  void refuse(std::uint64_t stream_seq);
  void answered_before(std::uint64_t stream_seq);

  // Between the node and the plant.
  void node_rejected(const std::string& name, const FedContact& contact);
  void node_answered(const v1::Recognition& recognition, const AnsweredSpan& span,
                     std::string_view payload);
  void store_next(const std::string& name, Group& group);
  void stored(const std::string& name, const Stored& stored);
  void is_it_ours(const std::string& name);
  void tend(SteadyTime now);

  Plant& plant_;
  PlaceName name_;
  std::size_t max_message_bytes_;
  std::size_t most_groups_;
  ContactConsumer consumer_;
  NodeFeed feed_;
  v1::GatewayPlaceStatus status_;
  ContactLedger ledger_;

  // State that is discarded when the place begins anew.
  bool has_contact_ = false;
  std::map<std::string, Group, std::less<>> groups_;

  SteadyTime begin_at_;
  bool has_begun_ = false;
  SteadyTime begun_;
  SteadyTime next_tend_;
};

}  // namespace palpate::gateway
