#include "node/gateway/place/fed_node.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "node/wire/topics.h"

namespace palpate::gateway {
namespace {

// Messages that may wait for us in the node, which drops further ones: many times what can be in
// flight.
constexpr const char* kNodesHighWaterMark = "100000";
// The most that the node's option takes: only the number of groups is to bound what is held.
constexpr const char* kNodesProbes = "100000";

SocketSettings unbounded() {
  SocketSettings settings;
  settings.send_high_water_mark = 0;
  settings.receive_high_water_mark = 0;
  return settings;
}

/// Exit code of a child that could not become the node, as of a shell.
constexpr int kNotStarted = 127;

}  // namespace

FedNode::FedNode(zmq::context_t& context, const FedNodeOptions& options, const std::string& name)
    : contacts_path_(options.folder + "/" + name + ".contacts"),
      results_path_(options.folder + "/" + name + ".results"),
      program_(options.program),
      contacts_(make_socket(context, zmq::socket_type::xpub, unbounded())),
      results_(make_socket(context, zmq::socket_type::sub, unbounded())) {
  std::vector<std::string> arguments{options.program,
                                     "--name",
                                     name.substr(0, kMaxNameLength),
                                     "--contacts",
                                     "bind:ipc://" + contacts_path_,
                                     "--results",
                                     "bind:ipc://" + results_path_,
                                     "--results-high-water-mark",
                                     kNodesHighWaterMark,
                                     "--contacts-high-water-mark",
                                     kNodesHighWaterMark,
                                     "--max-message-bytes",
                                     std::to_string(options.max_message_bytes),
                                     "--max-groups",
                                     std::to_string(options.most_groups),
                                     "--max-groups-per-probe",
                                     std::to_string(options.most_groups),
                                     "--sequence-by-group",
                                     "--max-probes",
                                     kNodesProbes};
  if (!options.config.empty()) {
    arguments.emplace_back("--config");
    arguments.push_back(options.config);
  }
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  // Nothing of an earlier node may be mistaken for this one's.
  std::error_code ignored;
  for (const std::string& path : {contacts_path_, results_path_}) {
    std::filesystem::remove(path, ignored);
  }
  // Before there is a process: what throws leaves none behind.
  // Status last: when it arrives, the other subscriptions are active too.
  for (const TopicKind kind : {TopicKind::Contact, TopicKind::Recognition, TopicKind::Status}) {
    results_.set(zmq::sockopt::subscribe, topic_prefix(kind));
  }
  for (const auto& [socket, path] :
       {std::pair(&contacts_, &contacts_path_), std::pair(&results_, &results_path_)}) {
    const std::string error = attach(*socket, Endpoint{false, "ipc://" + *path});
    if (!error.empty()) throw std::runtime_error(error);
  }
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("no process for a node");
  if (process_ == 0) {
    // Only calls that are safe after fork() in a process with several threads.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::execvp(pointers.front(), pointers.data());
    ::_exit(kNotStarted);
  }
}

FedNode::~FedNode() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  std::error_code ignored;
  for (const std::string& path : {contacts_path_, results_path_}) {
    std::filesystem::remove(path, ignored);
    std::filesystem::remove(path + ".lock", ignored);
  }
}

bool FedNode::is_ready(bool heard) {
  TwoFrames message;
  // The only messages here are the node's subscriptions, which show that it listens.
  while (receive_now(contacts_, message)) is_heard_ = true;
  return is_heard_ && heard;
}

const std::string& FedNode::how_ended() {
  int status = 0;
  if (process_ > 0 && ::waitpid(process_, &status, WNOHANG) == process_) {
    process_ = -1;
    if (WIFSIGNALED(status)) {
      end_ = "was ended by signal " + std::to_string(WTERMSIG(status));
    } else if (WEXITSTATUS(status) == kNotStarted) {
      end_ = "cannot be started: " + program_;
    } else {
      end_ = "has ended with exit code " + std::to_string(WEXITSTATUS(status));
    }
  }
  return end_;
}

void FedNode::send(std::string_view topic, std::string_view payload) {
  send_now(contacts_, topic, payload);
}

}  // namespace palpate::gateway
