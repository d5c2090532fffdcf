#include "node/node.h"

#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "node/process/clock.h"
#include "node/process/reload_signal.h"
#include "node/publish/status.h"
#include "node/security/open_files.h"
#include "node/wire/socket.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

// How often liveness is checked. With the default timeout a frozen probe is noticed within 0.6 s.
constexpr milliseconds kTick{100};
// Longest time, since the poll, until no further contact is taken in this turn and everything else
// is served. The answers that have come are published first, within this time.
constexpr milliseconds kDrainTime{1};
constexpr int kSubscriptionsPerTurn = 100;
// libzmq reads all waiting messages before it hands us the first. A small limit makes sure that a
// peer that subscribes to too much is noticed early and that nobody waits meanwhile.
constexpr int kSubscriptionsWaiting = 4;
// Upper limit of a subscription message: a topic plus one byte. libzmq's own commands fit too.
constexpr std::int64_t kMaxSubscriptionBytes = 1024;
// Time to finish what has been received; the rest is given up. Together with the sockets' linger,
// the process ends within half a second, even on busy cores.
constexpr milliseconds kFinishTime{200};
constexpr milliseconds kFinishDrainTime{100};

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
  settings.receive_high_water_mark = kSubscriptionsWaiting;
  settings.max_message_bytes = kMaxSubscriptionBytes;
  settings.curve_server = keys.own;
  return settings;
}

// Additional workers, so that unexpectedly slow recognitions (such as the first ones of new groups)
// do not keep quick ones waiting.
constexpr std::size_t kSpareWorkers = 4;

std::size_t recognitions_at_a_time(const NodeOptions& options) {
  return options.workers > 0 ? options.workers : std::max(std::thread::hardware_concurrency(), 1U);
}

// Raises the limit of open files, and lets as many peers in as it has room for; says so where they
// are fewer than wanted. Throws if there is room for none.
NodeOptions within_open_files(NodeOptions options) {
  constexpr std::size_t kSockets = 2;
  constexpr std::size_t kOfLibzmq = 32;  // with some to spare
  const std::size_t limit = raise_open_files_limit();
  const std::size_t own =
      count_open_files() + kOfLibzmq + 3 * recognitions_at_a_time(options) + kSpareWorkers;
  const std::size_t room = peers_within(limit, own, kSockets);
  if (room == 0) {
    throw std::runtime_error("the limit of open files is " + std::to_string(limit) +
                             " (ulimit -Hn), and this node needs " +
                             std::to_string(own + kKeptFromPeers + kSockets));
  }
  if (room < options.peers.max_peers) {
    spdlog::warn(
        "max_peers of {}: the limit of open files is {} (ulimit -Hn) and has room for {} peers of "
        "each socket",
        options.peers.max_peers, limit, room);
    options.peers.max_peers = room;
  }
  turn_peers_away_at(limit);
  return options;
}

}  // namespace

Node::Node(const NodeOptions& options, const NodeKeys& keys, ProbeFiles probe_files)
    : options_(within_open_files(options)),
      context_(1),
      zap_(make_zap_handler(context_, keys)),
      contacts_(open(zmq::socket_type::sub, options.contacts, contacts_settings(options, keys))),
      results_(open(zmq::socket_type::xpub, options.results, results_settings(options, keys))),
      probe_files_(probe_files.all().empty()
                       ? nullptr
                       : std::make_shared<const ProbeFiles>(std::move(probe_files))),
      intake_(options.intake),
      publisher_(results_, options.name),
      at_a_time_(recognitions_at_a_time(options)),
      workers_(2 * at_a_time_ + kSpareWorkers, at_a_time_),
      in_work_(workers_.size()),
      started_(now_steady()),
      next_tick_(started_),
      next_status_(started_) {
  contact_peers_ = guard(contacts_, options.contacts, "contacts");
  result_peers_ = guard(results_, options.results, "results");
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
    socket.set(zmq::sockopt::xpub_verboser, true);
  }
  for (const std::string& text : endpoints) {
    const Result<Endpoint> endpoint = parse_endpoint(text, /*bind_by_default=*/true);
    if (!endpoint) throw std::runtime_error(endpoint.error);
    if (const std::string error = attach(socket, *endpoint.value, &locks_.emplace_back());
        !error.empty()) {
      throw std::runtime_error(error);
    }
  }
  return socket;
}

std::unique_ptr<PeerGuard> Node::guard(zmq::socket_t& socket,
                                       const std::vector<std::string>& endpoints,
                                       const char* what) {
  std::vector<std::string> connected;
  for (const std::string& text : endpoints) {
    const Result<Endpoint> endpoint = parse_endpoint(text, /*bind_by_default=*/true);
    if (endpoint && !endpoint.value->bind) connected.push_back(endpoint.value->address);
  }
  // libzmq reports a socket's events to one listener only. A socket that connects chooses its peers
  // itself, so it needs no PeerGuard and its events go to the ReconnectGuard.
  if (connected.empty()) {
    return std::make_unique<PeerGuard>(context_, socket, options_.peers, what);
  }
  guards_.push_back(std::make_unique<ReconnectGuard>(context_, socket, std::move(connected)));
  return nullptr;
}

void Node::run(int stop_fd, int reload_fd) {
  std::vector<zmq::pollitem_t> items{{nullptr, stop_fd, ZMQ_POLLIN, 0},
                                     {contacts_.handle(), 0, ZMQ_POLLIN, 0},
                                     {results_.handle(), 0, ZMQ_POLLIN, 0},
                                     {nullptr, workers_.finished_fd(), ZMQ_POLLIN, 0}};
  for (PeerGuard* peers : {contact_peers_.get(), result_peers_.get()}) {
    if (peers != nullptr) items.push_back({peers->events().handle(), 0, ZMQ_POLLIN, 0});
  }
  if (zap_) items.push_back({zap_->socket().handle(), 0, ZMQ_POLLIN, 0});
  service_manager_.ready("contacts on " + contacts_address() + ", results on " + results_address());
  for (;;) {
    const SteadyTime before = now_steady();
    const auto until_tick =
        std::chrono::ceil<milliseconds>(std::max(next_tick_ - before, SteadyTime::duration(0)));
    // If a quick group waits for a worker, time alone can free one (see slow_count()).
    const bool waits = intake_.groups().next_waiting() != nullptr;
    const auto timeout = waits ? std::min(until_tick, Group::kQuickCompute) : until_tick;
    poll(items, static_cast<int>(timeout.count()));
    if (items[0].revents != 0) break;
    const SteadyTime now = now_steady();
    if (items[3].revents != 0) take_answers();
    if (items[1].revents != 0) drain_contacts(now + kDrainTime);
    if (contact_peers_) contact_peers_->tend(now);
    if (result_peers_) result_peers_->tend(now);
    publisher_.serve_subscriptions(items[2].revents != 0 ? kSubscriptionsPerTurn : 0,
                                   result_peers_.get(), now);
    if (zap_ && items.back().revents != 0) zap_->serve();
    give_out_work(now_steady());
    if (now >= next_tick_) {
      // What has come since the poll is not from the future.
      tick(now_steady());
      // Not urgent: once per tick is often enough.
      if (reload_fd >= 0 && reload_requested(reload_fd)) {
        reload_clients();
        reload_probe_files();
      }
    }
  }
  finish();
}

// Returns false if no message is left.
bool Node::drain_contacts(SteadyTime deadline) {
  SteadyTime now = now_steady();
  bool more = true;
  while (now < deadline && (more = receive_now(contacts_, incoming_))) {
    const std::string_view key = zap_ ? key_of(incoming_.topic) : std::string_view();
    if (contact_peers_) contact_peers_->hear(descriptor_of(incoming_.topic), key);
    const v1::RejectReason reason =
        intake_.take(incoming_.frame_count, view_of(incoming_.topic), view_of(incoming_.payload),
                     now, unix_time_ns(), zap_ ? zap_->sender_of(key) : Sender());
    if (reason == v1::REJECT_REASON_UNSPECIFIED) publisher_.forward(incoming_);
    now = now_steady();
  }
  forget_evicted();
  return more;
}

void Node::forget_evicted() {
  const Intake::Forgotten forgotten = intake_.take_forgotten();
  for (const std::string& group : forgotten.groups) {
    publisher_.forget(TopicKind::Recognition, group);
  }
  for (const std::string& probe : forgotten.probes) publisher_.forget(TopicKind::Estimate, probe);
}

// Number of recognitions that are slow: expected to be, or already computing for longer than
// kQuickCompute.
std::size_t Node::slow_count(SteadyTime now) const {
  return static_cast<std::size_t>(
      std::count_if(in_work_.begin(), in_work_.end(), [&](const InWork& work) {
        return work.group != nullptr && (work.is_slow || now - work.since > Group::kQuickCompute);
      }));
}

// Starts as many recognitions as there are cores, and one more for each slow one. Quick
// recognitions thus continue beside slow ones and share the cores with them.
void Node::give_out_work(SteadyTime now) {
  while (workers_.has_idle(Workers::Pace::Quick)) {
    const std::size_t slow = slow_count(now);
    if (workers_.busy_count() >= at_a_time_ + slow) return;
    Group* group = intake_.groups().next_waiting(/*only_quick=*/slow >= at_a_time_);
    if (group == nullptr) return;
    const auto pace = group->is_quick() ? Workers::Pace::Quick : Workers::Pace::Slow;
    std::shared_ptr<GroupRecognizer> recognizer = intake_.groups().begin_work(*group);
    recognizer->probe_files = probe_files_;
    recognizer->wants_estimates = options_.publish_estimates && publisher_.estimates_are_wanted();
    const std::size_t worker =
        workers_.start(std::move(recognizer), pace, group->expected_compute());
    in_work_[worker] = {group, pace == Workers::Pace::Slow, now};
  }
}

void Node::take_answers() {
  while (const std::optional<std::size_t> worker = workers_.take_finished()) {
    Group& group = *std::exchange(in_work_[*worker].group, nullptr);
    publish(group);
  }
}

void Node::publish(Group& group) {
  GroupRecognizer::Answer& answer = intake_.groups().end_work(group);
  intake_.count_refused(answer.samples_refused);
  compute_times_.add(answer.compute_ns);
  v1::Recognition& recognition = answer.recognition;
  publisher_.publish(TopicKind::Recognition, group.name(), *recognition.mutable_header(),
                     recognition);
  ++recognitions_published_;
  for (v1::LocalEstimate& estimate : answer.estimates) {
    publisher_.publish(TopicKind::Estimate, estimate.probe(), *estimate.mutable_header(), estimate);
  }
}

void Node::tick(SteadyTime now) {
  next_tick_ = now + kTick;
  service_manager_.alive(now);
  for (const auto& reconnect : guards_) reconnect->tend(now);
  const int changes = update_liveness(intake_.probes(),
                                      std::chrono::duration<double>(options_.probe_timeout_s), now);
  if (now >= next_status_) {
    operator_log_.tell(intake_, zap_ ? &*zap_ : nullptr, now);
    log_cuts();
    give_memory_back();
    publisher_.repeat_all();
    publish_status(now);
    compute_times_.clear();
    next_status_ = now + std::chrono::duration_cast<SteadyTime::duration>(
                             std::chrono::duration<double>(options_.status_period_s));
  } else if (changes > 0) {
    publish_status(now);
  }
}

std::uint64_t Node::connections_cut() const {
  std::uint64_t count = peers_turned_away();
  for (const PeerGuard* peers : {contact_peers_.get(), result_peers_.get()}) {
    if (peers != nullptr) count += peers->cut_count();
  }
  return count;
}

// The memory that libzmq used for a peer until it was cut is fragmented, and the allocator would
// keep it. Trimmed in two status periods, because libzmq frees a peer some time after it was cut.
void Node::give_memory_back() {
  const std::uint64_t cuts = connections_cut();
  if (cuts != cuts_before_last_status_) ::malloc_trim(0);
  cuts_before_last_status_ = std::exchange(cuts_at_last_status_, cuts);
}

void Node::publish_status(SteadyTime now) {
  NodeVitals vitals;
  vitals.uptime_s = std::chrono::duration<double>(now - started_).count();
  vitals.version = PALPATE_VERSION;
  vitals.recognitions_published = recognitions_published_;
  vitals.clients_denied = zap_ ? zap_->denied_count() : 0;
  vitals.connections_cut = connections_cut();
  fill_status(intake_, compute_times_, vitals, now, status_message_);
  publisher_.publish(TopicKind::Status, options_.name, *status_message_.mutable_header(),
                     status_message_);
}

void Node::log_cuts() {
  for (PeerGuard* peers : {contact_peers_.get(), result_peers_.get()}) {
    const std::string report = peers == nullptr ? std::string() : peers->take_report();
    if (!report.empty()) spdlog::warn("{}", report);
  }
  const std::uint64_t turned_away = peers_turned_away();
  const std::uint64_t before = std::exchange(turned_away_told_, turned_away);
  if (turned_away > before) {
    spdlog::warn("{} connections closed as they came: no open files are left for them",
                 turned_away - before);
  }
}

void Node::reload_clients() {
  if (!zap_) {
    spdlog::info("asked to reread the allowed clients: without CURVE there are none");
    return;
  }
  const Result<std::vector<AllowedClient>> keys = read_allowed_clients(options_.allow_clients);
  if (!keys) {
    spdlog::error("allowed clients stay as they were: {}", keys.error);
    return;
  }
  ClientList clients(*keys.value);
  const bool somebody_left = !clients.allows_all_of(zap_->clients());
  zap_->allow(std::move(clients));
  spdlog::info("{} allowed clients reread", keys.value->size());
  for (PeerGuard* peers : {contact_peers_.get(), result_peers_.get()}) {
    if (somebody_left && peers != nullptr) peers->cut_others_than(zap_->clients());
  }
}

// Recognitions in progress finish with the files that they started with.
void Node::reload_probe_files() {
  if (!probe_files_) return;
  Result<ProbeFiles> files = ProbeFiles::read(options_.probe_files);
  if (!files) {
    spdlog::error("probe files stay as they were: {}", files.error);
    return;
  }
  probe_files_ = std::make_shared<const ProbeFiles>(*std::move(files.value));
  spdlog::info("{} probe files reread", probe_files_->all().size());
}

void Node::finish() {
  service_manager_.stopping();
  const SteadyTime deadline = now_steady() + kFinishTime;
  // Messages that keep coming after this were sent after the stop.
  const SteadyTime drained = now_steady() + kFinishDrainTime;
  while (now_steady() < drained && drain_contacts(now_steady() + kDrainTime)) {
    give_out_work(now_steady());
  }
  std::vector<zmq::pollitem_t> items{{nullptr, workers_.finished_fd(), ZMQ_POLLIN, 0}};
  for (;;) {
    take_answers();
    give_out_work(now_steady());
    const auto left = std::chrono::ceil<milliseconds>(deadline - now_steady());
    if (!intake_.groups().has_work() || left.count() <= 0) break;
    poll(items, static_cast<int>(left.count()));
  }
  publish_status(now_steady());
  spdlog::info("stopped: {} messages received, {} recognitions published",
               intake_.counters().messages_received, recognitions_published_);
  if (intake_.groups().has_work()) spdlog::warn("stopped before all recognitions had ended");
}

}  // namespace palpate
