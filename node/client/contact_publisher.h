// A probe's side: publishes contact samples.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "node/wire/endpoint.h"
#include "node/wire/handshake_watch.h"
#include "node/wire/socket.h"
#include "palpate/v1/contact.pb.h"

namespace palpate::client {

struct ContactPublisherOptions {
  /// The recognizer's contacts endpoint; a bare address is connected to.
  std::string endpoint{kDefaultContactsEndpoint};
  std::optional<CurveClient> curve;
  /// Messages that wait for a recognizer that does not keep up before further ones are lost.
  int high_water_mark = 1000;
};

/// Publishes for one probe or several. Never blocks: what nobody takes is lost, and shows as a hole
/// in seq. Reconnects by itself. Belongs to one thread.
class ContactPublisher {
 public:
  /// Throws std::invalid_argument on a bad endpoint and zmq::error_t where it cannot be attached.
  explicit ContactPublisher(const ContactPublisherOptions& options = {});

  /// Waits until a recognizer listens; false after `timeout`, or at once where it refuses us: see
  /// refusal(). Before that, messages are lost.
  bool wait_for_recognizer(std::chrono::milliseconds timeout);

  /// Why the recognizer refuses this client, to be read after its name: "refuses our key: ...".
  /// Empty where it does not. libzmq does not try again: only a new publisher can.
  const std::string& refusal() { return handshakes_.refusal(); }

  /// Publishes the batch on `contact/<probe>/` after filling in its header's source, epoch, seq and
  /// stamp; the frame stays as given. Returns false where the probe's name is invalid (nothing is
  /// sent) or the high-water mark has dropped the message.
  bool publish(std::string_view probe, v1::ContactBatch& batch);

  /// Lets the destructor wait so long at most for what has been published and is not sent yet;
  /// without it a tenth of a second. A recognizer that is behind gets the rest; one that has gone
  /// is not waited for longer.
  void finish_within(std::chrono::milliseconds longest = std::chrono::seconds(5));

  /// Random number of this publisher, in every header.
  std::uint64_t epoch() const { return epoch_; }

 private:
  struct Probe {
    std::string topic;
    std::uint64_t next_seq = 0;
  };

  void take_subscriptions();

  zmq::context_t context_;
  zmq::socket_t socket_;
  HandshakeWatch handshakes_;
  std::uint64_t epoch_;
  int listeners_ = 0;
  std::map<std::string, Probe, std::less<>> probes_;
  std::string buffer_;
};

}  // namespace palpate::client
