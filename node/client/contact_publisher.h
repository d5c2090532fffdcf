// The client of a probe: publishes contact samples.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
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
  /// The recognizer's contacts endpoint. An address without "bind:" or "connect:" is connected to.
  std::string endpoint{kDefaultContactsEndpoint};
  std::optional<CurveClient> curve;
  /// Messages that may wait for a slow recognizer. publish() refuses further ones.
  int high_water_mark = 1000;
  /// Several readers may connect to an endpoint that is bound. False: one that is behind loses
  /// messages alone, holds up no other, and sees it in seq; publish() does not tell. True:
  /// publish() refuses a message for all of them as long as one has no room. A publisher that
  /// connects has one reader, and always refuses.
  bool all_readers_or_none = false;
};

/// Publishes contacts of one or more probes. publish() never blocks: messages that cannot be
/// delivered are lost and leave a gap in seq. Reconnects by itself. Not thread-safe.
class ContactPublisher {
 public:
  /// Throws std::invalid_argument if the endpoint is malformed and std::runtime_error if it cannot
  /// be attached.
  explicit ContactPublisher(const ContactPublisherOptions& options = {});

  /// Waits until a recognizer listens. Returns false after `timeout`, or at once if the recognizer
  /// refuses this client (see refusal()). Messages published before a recognizer listens are lost.
  bool wait_for_recognizer(std::chrono::milliseconds timeout);

  /// Why the recognizer refuses this client, worded to follow its name: "refuses our key: ...".
  /// Empty if it does not refuse. libzmq does not try again; create a new publisher.
  const std::string& refusal() { return handshakes_.refusal(); }

  /// Publishes the batch on `contact/<probe>/`. Sets source, epoch, seq and stamp of its header;
  /// the frame stays as given. Returns false if the probe's name is invalid (nothing is sent) or if
  /// the message was dropped at the high-water mark. A message that has no listener yet is lost,
  /// and counts as published.
  bool publish(std::string_view probe, v1::ContactBatch& batch);

  /// Like publish(), for samples that can wait, as those of a file: waits at the high-water mark
  /// until there is room, for `longest` at most or until is_stopped(), which it asks every
  /// millisecond, returns true. The message is lost only then.
  bool publish_when_room(std::string_view probe, v1::ContactBatch& batch,
                         std::chrono::duration<double> longest,
                         const std::function<bool()>& is_stopped);

  /// Leaves so many numbers out before the probe's next message, for messages that are known to be
  /// lost: a recognizer counts them as missing. Nothing if the probe's name is invalid.
  void leave_out(std::string_view probe, std::uint64_t messages);

  /// Longest time that the destructor waits for messages that are published but not sent; 0.1 s if
  /// never called. A slow recognizer then still gets them; a recognizer that has gone is not waited
  /// for.
  void finish_within(std::chrono::milliseconds longest = std::chrono::seconds(5));

  /// Whether the recognizer was there and has gone, as far as is known by now: what is published
  /// since is lost unless it comes back, and what was on its way to it may be.
  bool recognizer_has_gone();

  /// That the recognizer has gone or come back since the last call, and what that means for what is
  /// published; worded to follow its name. Empty if it has not.
  std::string news_of_recognizer();

  /// Messages lost because nobody listened. Only a publisher that binds has them: one that connects
  /// keeps messages for a recognizer that comes back, or refuses them.
  std::uint64_t published_to_nobody() const { return published_to_nobody_; }

  /// The random number in the header of every message of this publisher.
  std::uint64_t epoch() const { return epoch_; }

 private:
  struct Probe {
    std::string topic;
    std::uint64_t next_seq = 0;
  };

  /// nullptr if the name is invalid.
  Probe* state_of(std::string_view probe);
  void take_subscriptions();

  zmq::context_t context_;
  zmq::socket_t socket_;
  HandshakeWatch handshakes_;
  std::uint64_t epoch_;
  bool binds_ = false;
  bool had_listeners_ = false;
  int listeners_ = 0;
  std::uint64_t departures_ = 0;  // of the last listener; if we bind
  std::uint64_t departures_told_ = 0;
  bool is_gone_told_ = false;
  std::uint64_t published_to_nobody_ = 0;
  std::map<std::string, Probe, std::less<>> probes_;
  std::string buffer_;
};

}  // namespace palpate::client
