// palpate keygen: a CURVE key pair, as files.
#include <iostream>
#include <memory>

#include "node/tool/commands/command.h"
#include "node/wire/curve_keys.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

/// For the example: the file's name, as people call a key as its probe.
std::string probe_name(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  return is_valid_name(name) ? name : "NAME";
}

int run(const std::string& name) {
  if (name.empty() || name.back() == '/') {
    return complain("\"" + name + "\" names no file: NAME.secret and NAME.public are made", kUsage);
  }
  if (!curve_available()) {
    return complain("libzmq was built without CURVE", kFailed);
  }
  const Result<CurveKeyPair> keys = generate_curve_keys();
  if (!keys) {
    return complain(keys.error, kFailed);
  }
  const std::string secret = name + ".secret";
  const std::string shared = name + ".public";
  if (const std::string error = write_curve_keys(*keys.value, secret, shared); !error.empty()) {
    return complain(error, kFailed);
  }
  std::cout
      << secret << ": keep it to yourself\n"
      << shared << ": give it to the other side\n"
      << "In a recognizer's list of clients (--allow-clients) it is " << shared
      << " as it is, or one line with the\nprobes as which it may publish, none for a planner:\n"
      << keys.value->public_key << " probes=" << probe_name(name) << "\n";
  return kDone;
}

}  // namespace

void add_keygen_command(CLI::App& app, int& exit_code) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "keygen",
      "Make a CURVE key pair: NAME.secret (mode 0600) and NAME.public. Nothing is overwritten.\n"
      "palpate-node takes its own secret file and a file of the clients' public lines, each "
      "perhaps\n"
      "with the probes as which the client may publish: KEY probes=left,right. A probe or planner\n"
      "takes its own secret file and the node's public one.");
  command->add_option("NAME", *name, "Path without the endings")->required()->type_name("");
  command->callback([name, &exit_code] { exit_code = run(*name); });
}

}  // namespace palpate
