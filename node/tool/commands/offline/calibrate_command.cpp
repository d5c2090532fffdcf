// palpate calibrate: what a probe does to positions, from touches of a known artefact.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "core/recognition/samples/joined_runs.h"
#include "node/files/overwritten_input.h"
#include "node/files/printable.h"
#include "node/files/probe_file.h"
#include "node/files/quantity.h"
#include "node/files/written_file.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/file_flags.h"
#include "node/tool/contact_groups.h"
#include "node/tool/drawing/svg/lobes_plot.h"
#include "node/tool/qualification_answer.h"
#include "node/tool/text/message_json.h"

namespace palpate {
namespace {

struct CalibrateCommand {
  std::vector<std::string> files;
  std::string format = "text";
  std::string output;
  std::string plot;
  std::vector<std::vector<double>> parameters = std::vector<std::vector<double>>(9);  // by class
  FileFlags file;
  QualificationOptions options;
};

/// The one artefact that was named.
Result<Curve> artefact_of(const CalibrateCommand& calibrate, std::string& name) {
  const auto named = std::count_if(calibrate.parameters.begin(), calibrate.parameters.end(),
                                   [](const auto& values) { return !values.empty(); });
  if (named > 1)
    return Result<Curve>::fail("one artefact at a time, here are " + std::to_string(named));
  for (const CurveClass curve_class : kCurveClasses) {
    const std::vector<double>& values = calibrate.parameters[static_cast<std::size_t>(curve_class)];
    if (values.empty()) continue;
    Eigen::Vector3d shape = Eigen::Vector3d::Zero();
    name = std::string(name_of(curve_class));
    for (std::size_t i = 0; i < values.size(); ++i) {
      shape[static_cast<Eigen::Index>(i)] = values[i];
      name += " " + number(values[i]);
    }
    std::optional<Curve> curve = make_curve(curve_class, shape);
    if (!curve) {
      return Result<Curve>::fail(
          name +
          ": out of the range of its class (core/README.md, \"Curves\": an ellipse has a >= b)");
    }
    return Result<Curve>::ok(*curve);
  }
  return Result<Curve>::fail("the artefact's class and parameters are needed: --circle A, ...");
}

/// Each object of each file is a recording, with a pose of its own.
Result<std::vector<ArtefactRecording>> read_recordings(const CalibrateCommand& calibrate,
                                                       std::set<std::string>& probes) {
  using Read = Result<std::vector<ArtefactRecording>>;
  std::vector<ArtefactRecording> recordings;
  for (const std::string& file : calibrate.files) {
    const Result<ContactFile> read = read_contact_file(file, options_of(calibrate.file));
    if (!read) return Read::fail(read.error);
    for (const std::string& note : read.value->notes) complain(file + ": " + note, kDone);
    for (const ContactGroup& group : contact_groups(file, read.value->table)) {
      probes.insert(group.probes.begin(), group.probes.end());
      if (const std::string note = note_of_unused_detail(group); !note.empty()) {
        complain(file + ": " + note, kDone);
      }
      ArtefactRecording& recording = recordings.emplace_back();
      for (const ContactRun& run : joined_runs(group.runs).runs) {
        recording.strokes.push_back({run.samples, run.context.tip_radius_m});
      }
    }
  }
  return Read::ok(std::move(recordings));
}

int write(const std::string& path, const std::string& text) {
  const std::string why = write_file(path, text);
  return why.empty() ? kDone : complain(why, kFailed);
}

/// Tips touch from outside of the material. Samples that lie within it, by more than their noise
/// and the lobes, say that it is the other side, or that the artefact has another size.
std::string note_of_depth(const Qualification& result) {
  constexpr double kSure = 5.0;  // deviations
  const NormalOffset& offset = result.probe.offset;
  const double tip_m = result.probe.tip_radius_m + offset.coefficients_m[0];
  const double lobes_m = offset.coefficients_m.tail(offset.coefficients_m.size() - 1).norm();
  const double set_up_m = std::hypot(result.probe.setup_m.value, result.probe.setup_m.deviation);
  const double deviation_m = std::hypot(std::sqrt(offset.covariance_m2(0, 0)), set_up_m);
  if (!(tip_m < -kSure * deviation_m - lobes_m)) {
    return "";
  }
  return "the samples lie " + text_of_length(-tip_m) + " within the material: " +
         (result.bore ? "touch it from within the bore, or leave out --bore"
                      : "if a bore is touched, say --bore") +
         "; or the artefact has another size, or the tip radius is not that";
}

int run(const CalibrateCommand& calibrate) {
  QualificationOrigin origin;
  const Result<Curve> artefact = artefact_of(calibrate, origin.artefact);
  if (!artefact) return complain(artefact.error, kUsage);
  const std::vector<std::string> written{calibrate.output, calibrate.plot};
  if (const std::string why = overwrites_output(written); !why.empty()) {
    return complain(why, kUsage);
  }
  for (const std::string& path : written) {
    if (const std::string why = overwrites_input(path, calibrate.files); !why.empty()) {
      return complain(why, kUsage);
    }
  }
  std::set<std::string> probes;
  const Result<std::vector<ArtefactRecording>> recordings = read_recordings(calibrate, probes);
  if (!recordings) return complain(recordings.error, kUsage);
  if (probes.size() > 1) {
    std::string names;
    for (const std::string& name : probes) names += " " + printable(name);
    return complain("the files have several probes, one is qualified at a time:" + names, kUsage);
  }
  origin.recordings = calibrate.files;
  if (!probes.empty()) origin.probe = *probes.begin();
  const Qualification result = qualify(*artefact.value, *recordings.value, calibrate.options);
  if (!is_estimate(result.status)) return complain(why_not(result.status), kFailed);
  if (calibrate.options.bore && !result.bore) {
    complain("--bore is not used: the tips lie outside of a ring, not within a bore", kDone);
  }
  if (const std::string note = note_of_depth(result); !note.empty()) complain(note, kDone);
  const v1::Probe probe = probe_message(result, origin);
  std::cout << (calibrate.format == "json" ? json_line(probe) : qualification_text(result, origin));
  if (!calibrate.output.empty()) {
    if (const int code = write(calibrate.output, probe_text(probe)); code != kDone) return code;
  }
  if (!calibrate.plot.empty()) {
    const std::string title = "Probe " + origin.probe + " on " + origin.artefact;
    if (const int code = write(calibrate.plot, lobes_plot(result, title)); code != kDone) {
      return code;
    }
  }
  if (result.rather_another_size) {
    return complain("the artefact or the tip has rather another size than " + origin.artefact +
                        " and a tip radius of " + text_of_length(result.probe.tip_radius_m) +
                        "; what the samples tell is said and written all the same",
                    kFailed);
  }
  if (result.status == QualificationStatus::Insufficient) {
    return complain("the samples do not suffice; what they tell is said and written all the same",
                    kFailed);
  }
  return kDone;
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto calibrate = std::make_shared<CalibrateCommand>();
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Qualify a probe on a known artefact: its effective tip radius, its offset by the direction\n"
      "of the surface's normal (lobes), noise, drift, spikes and lag, each with its deviation.\n"
      "Every object of every file is a recording of its own, in a pose of its own. A ring touched\n"
      "all around tells the most; with an ellipse lay it in several directions.\n"
      "Exit code 1: the samples do not suffice, or are not of that artefact, or of rather another\n"
      "size of it or of the tip: the offset is more than a tenth of the stated tip radius.");
  command->add_option("FILE", calibrate->files, "Files of points; - is standard input")
      ->required()
      ->type_name("");
  for (const CurveClass curve_class : kCurveClasses) {
    const std::string_view letters = parameter_letters(curve_class);
    if (letters.empty()) continue;
    std::string flag(name_of(curve_class));
    std::replace(flag.begin(), flag.end(), '_', '-');
    std::string parameters;
    for (const char letter : letters) {
      parameters +=
          (parameters.empty() ? "" : ",") + std::string(1, static_cast<char>(letter - 'a' + 'A'));
    }
    command
        ->add_option("--" + flag, calibrate->parameters[static_cast<std::size_t>(curve_class)],
                     curve_class == CurveClass::Circle ? "Ring or bore of radius A [m]"
                     : curve_class == CurveClass::Ellipse
                         ? "Ellipse of semi-axes A >= B [m]"
                         : "The canonical form's parameters, in powers of metres")
        ->delimiter(',')
        ->expected(static_cast<int>(letters.size()))
        ->type_name(parameters)
        ->group("Artefact, exactly one");
  }
  command
      ->add_option("--output", calibrate->output, "Write the probe file (palpate/v1/probe.proto)")
      ->type_name("FILE");
  command->add_option("--plot", calibrate->plot, "Draw the probe's lobes and the residuals as SVG")
      ->check(svg_file())
      ->type_name("FILE");
  command
      ->add_option("--format", calibrate->format,
                   "text or json: what --output writes, as one line of JSON")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->type_name("FORMAT");
  command->add_flag("--bore", calibrate->options.bore,
                    "The material lies around the curve, not within it; a tip radius tells it too");
  command->add_flag(
      "--same-setup", calibrate->options.same_setup,
      "Parts will be touched in the very set-up of these recordings: the offset's\n"
      "constant is the same. Without it every recording is a set-up of its own, and what\n"
      "their constants differ by is what another set-up's may");
  add_file_flags(*command, calibrate->file);
  command->callback([calibrate, &exit_code] { exit_code = run(*calibrate); });
}

}  // namespace palpate
