#include "node/node.h"

#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "node/clock.h"
#include "node/convert.h"
#include "node/socket.h"
#include "node/status.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

// Liveness is looked at this often; with the default timeout a frozen probe shows within 0.6 s.
constexpr milliseconds kTick{100};
// Under a flood, recognition gets its turn after this long.
constexpr milliseconds kDrainTime{5};
constexpr int kSubscriptionsPerTurn = 1000;
// Subscriptions are a topic and a byte; libzmq's own commands fit too.
constexpr std::int64_t kMaxSubscriptionBytes = 1024;
// What has been received is finished within this, or given up: with the sockets' linger the
// process ends within half a second.
constexpr milliseconds kFinishTime{300};

SteadyTime now_steady() { return std::chrono::steady_clock::now(); }

std::string_view view_of(const zmq::message_t& frame) { return {frame.data<char>(), frame.size()}; }

SocketSettings contacts_settings(const NodeOptions& options, const NodeKeys& keys) {
  SocketSettings settings;
  settings.receive_high_water_mark = static_cast<int>(options.contacts_high_water_mark);
  settings.max_message_bytes = static_cast<std::int64_t>(options.intake.limits.max_message_bytes);
  settings.curve_server = keys.own;
  return settings;
}

SocketSettings results_settings(const NodeOptions& options, const NodeKeys& keys) {
  SocketSettings settings;
  settings.send_high_water_mark = static_cast<int>(options.results_high_water_mark);
  settings.max_message_bytes = kMaxSubscriptionBytes;
  settings.curve_server = keys.own;
  return settings;
}

}  // namespace

Node::Node(const NodeOptions& options, const NodeKeys& keys)
    : options_(options),
      context_(1),
      zap_(make_zap_handler(context_, keys)),
      contacts_(open(zmq::socket_type::sub, options.contacts, contacts_settings(options, keys))),
      results_(open(zmq::socket_type::xpub, options.results, results_settings(options, keys))),
      intake_(options.intake),
      publisher_(results_, options.name),
      started_(now_steady()),
      next_tick_(started_),
      next_status_(started_) {
  guard(contacts_, options.contacts);
  guard(results_, options.results);
}

zmq::socket_t Node::open(zmq::socket_type type, const std::vector<std::string>& endpoints,
                         const SocketSettings& settings) {
  zmq::socket_t socket = make_socket(context_, type, settings);
  if (type == zmq::socket_type::sub) {
    const std::string all(topic_prefix(TopicKind::Contact));
    for (const std::string& prefix : options_.probe_prefixes) {
      socket.set(zmq::sockopt::subscribe, all + prefix);
    }
    if (options_.probe_prefixes.empty()) socket.set(zmq::sockopt::subscribe, all);
  } else {
    socket.set(zmq::sockopt::xpub_verbose, true);
  }
  for (const std::string& text : endpoints) {
    const Result<Endpoint> endpoint = parse_endpoint(text, /*bind_by_default=*/true);
    if (!endpoint) throw std::runtime_error(endpoint.error);
    if (const std::string path = ipc_path(endpoint.value->address);
        endpoint.value->bind && !path.empty()) {
      Result<PathLock> lock = PathLock::acquire(path);
      if (!lock) throw std::runtime_error(lock.error);
      locks_.push_back(std::move(*lock.value));
    }
    if (const std::string error = attach(socket, *endpoint.value); !error.empty()) {
      throw std::runtime_error(error);
    }
  }
  return socket;
}

void Node::guard(zmq::socket_t& socket, const std::vector<std::string>& endpoints) {
  std::vector<std::string> connected;
  for (const std::string& text : endpoints) {
    const Result<Endpoint> endpoint = parse_endpoint(text, /*bind_by_default=*/true);
    if (endpoint && !endpoint.value->bind) connected.push_back(endpoint.value->address);
  }
  if (connected.empty()) return;
  guards_.push_back(std::make_unique<ReconnectGuard>(context_, socket, std::move(connected)));
}

void Node::run(const std::stop_token& stop) {
  const int fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (fd < 0) throw std::runtime_error("no eventfd");
  {
    const std::stop_callback wake(stop, [fd] { (void)::eventfd_write(fd, 1); });
    run(fd);
  }
  ::close(fd);
}

void Node::run(int stop_fd) {
  std::vector<zmq::pollitem_t> items{{nullptr, stop_fd, ZMQ_POLLIN, 0},
                                     {contacts_.handle(), 0, ZMQ_POLLIN, 0},
                                     {results_.handle(), 0, ZMQ_POLLIN, 0}};
  if (zap_) items.push_back({zap_->socket().handle(), 0, ZMQ_POLLIN, 0});
  for (;;) {
    const SteadyTime before = now_steady();
    const auto until_tick =
        std::chrono::ceil<milliseconds>(std::max(next_tick_ - before, SteadyTime::duration(0)));
    const bool has_work = intake_.groups().next_waiting() != nullptr;
    poll(items, has_work ? 0 : static_cast<int>(until_tick.count()));
    if (items[0].revents != 0) break;
    const SteadyTime now = now_steady();
    if (items[1].revents != 0) drain_contacts(now + kDrainTime);
    if (items[2].revents != 0) publisher_.serve_subscriptions(kSubscriptionsPerTurn);
    if (zap_ && items[3].revents != 0) zap_->serve();
    recognize_next();
    if (now >= next_tick_) tick(now);
  }
  finish();
}

void Node::drain_contacts(SteadyTime deadline) {
  SteadyTime now = now_steady();
  while (now < deadline && receive_now(contacts_, incoming_)) {
    const v1::RejectReason reason =
        intake_.take(incoming_.frame_count, view_of(incoming_.topic), view_of(incoming_.payload),
                     now, unix_time_ns());
    if (reason == v1::REJECT_REASON_UNSPECIFIED) publisher_.forward(incoming_);
    now = now_steady();
  }
  forget_evicted();
}

void Node::forget_evicted() {
  const Intake::Forgotten forgotten = intake_.take_forgotten();
  for (const std::string& group : forgotten.groups) {
    publisher_.forget(TopicKind::Recognition, group);
  }
  for (const std::string& probe : forgotten.probes) publisher_.forget(TopicKind::Estimate, probe);
}

void Node::recognize_next() {
  Group* group = intake_.groups().next_waiting();
  if (group == nullptr) return;
  const SteadyTime start = now_steady();
  const Recognition recognition = group->recognize();
  const std::int64_t compute_ns = std::chrono::nanoseconds(now_steady() - start).count();
  compute_times_.add(compute_ns);
  publish(recognition, *group, compute_ns);
  if (options_.publish_estimates) publish_estimates(recognition, *group);
  intake_.groups().mark_served(*group, compute_ns);
}

void Node::publish(const Recognition& recognition, const Group& group, std::int64_t compute_ns) {
  v1::Recognition& message = recognition_message_;
  to_wire(
      recognition,
      [&](std::uint32_t probe, std::uint32_t run) { return group.source_of(probe, run); }, message);
  message.mutable_header()->set_frame(group.frame());
  message.set_group(group.name());
  message.set_object(group.object());
  message.set_newest_sample_stamp_ns(group.newest().sample_stamp_ns);
  message.set_newest_batch_seq(group.newest().seq);
  message.set_newest_batch_epoch(group.newest().epoch);
  message.set_newest_batch_source(group.newest().source);
  message.set_compute_ns(compute_ns);
  publisher_.publish(TopicKind::Recognition, group.name(), *message.mutable_header(), message);
  ++recognitions_published_;
}

// The latest place of each probe.
void Node::publish_estimates(const Recognition& recognition, const Group& group) {
  std::vector<const LocalizedContact*> latest(group.members().size(), nullptr);
  for (const LocalizedContact& contact : recognition.contacts) {
    if (contact.probe >= latest.size()) continue;
    const LocalizedContact*& known = latest[contact.probe];
    if (known == nullptr || contact.patch >= known->patch) known = &contact;
  }
  for (const LocalizedContact* contact : latest) {
    if (contact == nullptr) continue;
    const ContactSource source = group.source_of(contact->probe, contact->patch);
    to_wire(contact->estimate, source, estimate_message_);
    estimate_message_.mutable_header()->set_frame(group.frame());
    publisher_.publish(TopicKind::Estimate, source.probe, *estimate_message_.mutable_header(),
                       estimate_message_);
  }
}

void Node::tick(SteadyTime now) {
  next_tick_ = now + kTick;
  for (const auto& reconnect : guards_) reconnect->tend(now);
  const int changes = update_liveness(intake_.probes(),
                                      std::chrono::duration<double>(options_.probe_timeout_s), now);
  if (now >= next_status_) {
    log_rejections();
    publisher_.repeat_all();
    publish_status(now);
    compute_times_.clear();
    next_status_ = now + std::chrono::duration_cast<SteadyTime::duration>(
                             std::chrono::duration<double>(options_.status_period_s));
  } else if (changes > 0) {
    publish_status(now);
  }
}

void Node::publish_status(SteadyTime now) {
  NodeVitals vitals;
  vitals.uptime_s = std::chrono::duration<double>(now - started_).count();
  vitals.version = PALPATE_VERSION;
  vitals.recognitions_published = recognitions_published_;
  vitals.clients_denied = zap_ ? zap_->denied_count() : 0;
  fill_status(intake_, compute_times_, vitals, now, status_message_);
  publisher_.publish(TopicKind::Status, options_.name, *status_message_.mutable_header(),
                     status_message_);
}

// Once a status period and a line a reason, however many messages there were.
void Node::log_rejections() {
  const auto& rejected = intake_.counters().rejected;
  for (std::size_t i = 0; i < rejected.size(); ++i) {
    if (rejected[i] == rejections_logged_[i]) continue;
    spdlog::warn("{} messages rejected: {}", rejected[i] - rejections_logged_[i],
                 v1::RejectReason_Name(static_cast<v1::RejectReason>(i)));
  }
  rejections_logged_ = rejected;
}

void Node::finish() {
  const SteadyTime deadline = now_steady() + kFinishTime;
  drain_contacts(deadline);
  while (now_steady() < deadline && intake_.groups().next_waiting() != nullptr) recognize_next();
  publish_status(now_steady());
  spdlog::info("stopped: {} messages received, {} recognitions published",
               intake_.counters().messages_received, recognitions_published_);
}

}  // namespace palpate
