// palpate check: listens to probes in the recognizer's place and says what is wrong with their
// streams.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "node/check/approach_check.h"
#include "node/check/group_check.h"
#include "node/files/counted.h"
#include "node/process/clock.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/check/stream_check.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/file_flags.h"
#include "node/tool/commands/listening_place.h"
#include "node/tool/contact_groups.h"
#include "node/wire/ingest_limits.h"

namespace palpate {
namespace {

struct CheckCommand {
  ListeningFlags place{std::string(kDefaultContactsEndpoint), "", "", false};
  double seconds = 5.0;
  std::string file;
  FileFlags flags;
};

/// Worst first; gives the exit code. `unit_note`: what was assumed of a file's unit.
int print(const std::vector<Finding>& findings, const std::string& unit_note = "") {
  bool good = true;
  bool doubtful = false;
  for (const Finding& finding : findings) {
    std::cout << name_of(finding.severity) << "  " << whose(finding) << finding.what
              << (finding.cure.empty() ? "" : "\n         " + finding.cure) << "\n";
    good = good && finding.severity != Severity::Error;
    doubtful = doubtful || (finding.severity == Severity::Warning && finding.spoils_answer);
  }
  std::string verdict = good ? "fit for the recognizer" : "not fit for the recognizer yet";
  if (good && doubtful) verdict += ", but see the warnings: its answer may be wrong";
  if (good && !unit_note.empty()) verdict += "; check the unit: " + unit_note;
  std::cout << verdict << "\n";
  return good ? kDone : kFailed;
}

/// The note of a unit that was assumed, by the option that it offers.
std::string unit_note_of(const ContactFile& file) {
  const auto found = std::find_if(
      file.notes.begin(), file.notes.end(),
      [](const std::string& note) { return note.find("(else --unit") != std::string::npos; });
  return found == file.notes.end() ? "" : *found;
}

int check_file(const CheckCommand& command) {
  const Result<ContactFile> file = read_contact_file(command.file, options_of(command.flags));
  if (!file) {
    return complain(file.error, kUsage);
  }
  std::vector<Finding> findings;
  for (const std::string& note : file.value->notes) {
    findings.push_back({Severity::Note, "", note, ""});
  }
  const std::vector<ContactGroup> groups = contact_groups(command.file, file.value->table);
  for (const ContactGroup& group : groups) {
    std::size_t samples = 0;
    std::set<std::pair<std::uint32_t, std::uint32_t>> patches;
    for (const ContactRun& run : group.runs) {
      samples += run.samples.size();
      patches.insert({run.context.probe, run.context.patch});
    }
    findings.push_back({Severity::Note, "",
                        object_of(group) + counted(samples, "sample") + " in " +
                            counted(patches.size(), "patch", "patches"),
                        ""});
    const bool is_alone = groups.size() == 1;
    const auto say = [&](Finding finding) {
      finding.object = object_of(group, is_alone);
      findings.push_back(std::move(finding));
    };
    if (auto few = too_few_places(group, patches.size())) say(*std::move(few));
    for (Finding& finding : check_group(group)) say(std::move(finding));
    if (auto approach = judge_approaches(group, is_alone)) say(*std::move(approach));
  }
  sort_findings(&findings);
  return print(findings, unit_note_of(*file.value));
}

int run(const CheckCommand& command) {
  if (!command.file.empty()) return check_file(command);
  const int stop_fd = take_stop_signals();
  ListeningPlace place;
  if (const int code = place.open_as_recognizer(command.place); code != kDone) {
    return code;
  }
  std::cerr << "listening on " << command.place.endpoint << " for " << command.seconds
            << " s: touch something\n";
  StreamCheck check;
  place.listen(stop_fd,
               std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(command.seconds)),
               [&](const TwoFrames& frames) {
                 check.take(frames.frame_count, frames.topic.to_string_view(),
                            frames.payload.to_string_view(), unix_time_ns(),
                            place.sender_of(frames.topic));
                 return true;
               });
  if (place.denied_count() > 0) {
    std::cout << name_of(Severity::Error) << "  " << place.denied_count()
              << " connections turned away: their keys are not in " << command.place.allow_clients
              << "\n";
  }
  if (check.messages() == 0) {
    return complain("no message came: does the probe connect to " + command.place.endpoint +
                        " with a PUB socket? A message of more than " +
                        std::to_string(IngestLimits{}.max_message_bytes) +
                        " bytes does not arrive: split longer strokes (contact.proto)",
                    kFailed);
  }
  return print(check.findings());
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto check = std::make_shared<CheckCommand>();
  CLI::App* command = app.add_subcommand("check",
                                         "Listen to a probe's stream in the recognizer's place and "
                                         "tell its author what is wrong with it:\n"
                                         "format, units, spacing, noise, lift-offs, gaps, stamps. "
                                         "Exit code 1 where there is an error.\n"
                                         "With FILE: the same of a file of points.");
  command->add_option("FILE", check->file, "File of points, as fit reads it; - is standard input")
      ->type_name("");
  add_file_flags(*command, check->flags);
  command->add_option("--contacts", check->place.endpoint, "Bind here, as the recognizer would")
      ->capture_default_str()
      ->type_name("ENDPOINT");
  CLI::Option* secret = command->add_option("--curve-secret-key", check->place.curve_secret_key,
                                            "CURVE: the recognizer's secret key file");
  secret->check(key_file_name())->type_name("FILE");
  CLI::Option* allowed = command->add_option("--allow-clients", check->place.allow_clients,
                                             "CURVE: file of the public keys that may connect");
  allowed->check(key_file_name())->type_name("FILE");
  secret->needs(allowed);
  allowed->needs(secret);
  command->add_flag("--insecure", check->place.insecure,
                    "Permit a bind beyond this machine without CURVE");
  command->add_option("--seconds", check->seconds, "How long to listen [s]")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  command->callback([check, &exit_code] { exit_code = run(*check); });
}

}  // namespace palpate
