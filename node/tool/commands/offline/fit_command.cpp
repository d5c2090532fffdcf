// palpate fit: the recognizer's answer for files, without a network.
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "node/check/approach_check.h"
#include "node/check/group_check.h"
#include "node/files/counted.h"
#include "node/files/overwritten_input.h"
#include "node/files/printable.h"
#include "node/files/probe_file.h"
#include "node/files/trimmed.h"
#include "node/files/written_file.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/file_flags.h"
#include "node/tool/commands/offline/answer_notes.h"
#include "node/tool/commands/offline/fit_input.h"
#include "node/tool/commands/offline/given_answer.h"
#include "node/tool/commands/offline/left_out.h"
#include "node/tool/commands/offline/measured_group.h"
#include "node/tool/commands/offline/object_answer.h"
#include "node/tool/commands/offline/placed_part.h"
#include "node/tool/contact_groups.h"
#include "node/tool/drawing/curve_export.h"
#include "node/tool/drawing/svg/invariant_plot.h"
#include "node/tool/drawing/svg/svg_plot.h"
#include "node/tool/text/given_class_text.h"
#include "node/tool/text/message_json.h"
#include "node/tool/text/report.h"
#include "node/wire/recognizer_options.h"

namespace palpate {
namespace {

struct FitCommand {
  std::vector<std::string> files;
  std::string format;
  std::string plot;
  std::string invariants_plot;
  std::string curve_file;
  std::string part;
  std::string given_class;
  std::vector<std::string> probe_files;
  std::vector<std::string> left_out;  ///< numbers, and ranges of them
  FileFlags file;
  std::vector<std::string> said;  ///< names of the recogniser's options that were given
  RecognizerWords words;
  RecognizerOptions recognizer;
};

/// For lists with commas: "circle, ellipse" is "circle,ellipse".
std::string without_blanks_around(const std::string& word) { return std::string(trimmed(word)); }

/// Flags for the recogniser's options, out of their one table.
void add_recognizer_flags(CLI::App& command, FitCommand& fit) {
  for_each_recognizer_option(fit.words, fit.recognizer, [&](const OptionInfo& info, auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (is_switch<Field>) {
      command
          .add_flag_function(
              switch_flags_of(info), [&field](std::int64_t count) { field = count > 0; }, info.help)
          ->group("Recognition");
      return;
    }
    CLI::Option* option =
        command.add_option(flags_of(info), field, info.help)->group("Recognition");
    if constexpr (std::is_same_v<Field, std::vector<std::string>>) {
      option->delimiter(',')
          ->type_name("CLASS,...")
          ->transform(without_blanks_around)
          ->check(curve_class_name());
    } else if constexpr (std::is_same_v<Field, std::string>) {
      option->capture_default_str()->type_name("NAME");
    } else {
      option->capture_default_str()->type_name("NUMBER")->check(
          number_within(info.lowest, info.highest));
    }
  });
}

bool noise_is_known(const FitInput& input, const RecognizerOptions& options,
                    const v1::Recognition& answer) {
  return input.noise_is_known || options.sigma_m > 0.0 || answer.probe_files_size() > 0;
}

/// PLOT.svg for the first group, PLOT-2.svg for the second, ...
std::string plot_path(const std::string& path, std::size_t number) {
  if (number == 1) {
    return path;
  }
  const std::size_t dot = path.rfind('.');
  const std::string stem = path.substr(0, dot);
  const std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  return stem + "-" + std::to_string(number) + ending;
}

/// What is wrong if a file that is read would be written over, or nothing.
std::string wrong_with_outputs(const FitCommand& fit, std::size_t groups) {
  std::vector<std::string> read = fit.files;
  read.insert(read.end(), fit.probe_files.begin(), fit.probe_files.end());
  read.push_back(fit.part);
  for (const std::string& path : {fit.plot, fit.invariants_plot, fit.curve_file}) {
    for (std::size_t number = 1; !path.empty() && number <= groups; ++number) {
      std::string why = overwrites_input(plot_path(path, number), read);
      if (!why.empty()) return why;
    }
  }
  return "";
}

bool is_among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What is wrong if a recogniser's option is given that does nothing for what is asked, or nothing.
std::string wrong_with_options(const FitCommand& fit) {
  const std::vector<std::string> of_class{"sigma_m", "recognized_probability",
                                          "determined_fraction", "touched_from"};
  const std::vector<std::string> of_part{"sigma_m", "recognized_probability",
                                         "false_outlier_probability"};
  if (fit.part.empty() && fit.given_class.empty()) return "";
  for (const std::string& name : fit.said) {
    if (!is_among(name, fit.part.empty() ? of_class : of_part)) {
      return flag_of(name) + ": not with " + (fit.part.empty() ? "--class" : "--part") +
             ", to which it makes no difference";
    }
  }
  return "";
}

int run(FitCommand& fit) {
  if (const std::string why = wrong_with_options(fit); !why.empty()) return complain(why, kUsage);
  if (const std::string why = resolve(fit.words, fit.recognizer); !why.empty()) {
    // It begins with the option's name in the table, which is the node's too.
    const std::size_t name = why.find(':');
    return complain(
        flag_of(why.substr(0, name)) + why.substr(name) + "; palpate fit --help says more", kUsage);
  }
  if (!fit.part.empty() && !fit.probe_files.empty()) {
    return complain(
        "--probe: not with --part, which places the samples as they are: only the normals of a "
        "curve that is recognised or given are used to take a probe's offsets off",
        kUsage);
  }
  // Nothing is answered before every file has been read: a bad one costs no half-done work.
  std::vector<QualifiedProbe> probes;
  for (const std::string& file : fit.probe_files) {
    Result<QualifiedProbe> probe = read_probe(file);
    if (!probe) return complain(probe.error, kUsage);
    probes.push_back(*std::move(probe.value));
  }
  std::vector<FitInput> inputs;
  bool bad = false;
  for (const std::string& file : fit.files) {
    Result<std::vector<FitInput>> read =
        read_fit_input(file, options_of(fit.file), fit.recognizer.sigma_m);
    if (!read) {
      complain(read.error, kUsage);
      bad = true;
      continue;
    }
    for (FitInput& input : *read.value) {
      for (const std::string& warning : input.warnings) {
        complain("WARNING: " + input.group.file + ": " + warning, kDone);
      }
      std::string note = note_of_unused_sigma(input.group, fit.recognizer.sigma_m);
      if (!note.empty()) {
        complain(input.group.file + ": " + note, kDone);
        // Placing says its notes here, not beside its answers.
        if (fit.part.empty()) input.notes.push_back(std::move(note));
      }
      inputs.push_back(std::move(input));
    }
  }
  if (bad) return kUsage;
  std::vector<std::size_t> left_out;
  if (!fit.left_out.empty()) {
    if (inputs.size() != 1) {
      return complain(
          "--leave-out: for one group and object only, here are " + std::to_string(inputs.size()),
          kUsage);
    }
    Result<std::vector<std::size_t>> numbers = left_out_of(fit.left_out, inputs.front().group);
    if (!numbers) return complain(numbers.error, kUsage);
    left_out = *std::move(numbers.value);
  }
  if (const std::string why = wrong_with_outputs(fit, inputs.size()); !why.empty()) {
    return complain(why, kUsage);
  }
  const bool json = fit.format.empty() ? isatty(STDOUT_FILENO) == 0 : fit.format == "json";
  if (!fit.part.empty()) {
    return place_part(fit.part, inputs, fit.recognizer, json);
  }
  std::size_t number = 0;
  int code = kDone;  // of what could not be written: the other answers are not lost with it
  for (FitInput& input : inputs) {
    // By the numbers that the samples have in the file, so before any is left out.
    const std::optional<Finding> approach = judge_approaches(input.group, input.is_alone, left_out);
    if (!left_out.empty() && fit.given_class.empty()) {
      input.group = without_samples(input.group, left_out);
      input.notes.push_back("left out: " + counted(left_out.size(), "sample") + " (--leave-out)");
    }
    const ContactGroup& group = input.group;
    v1::Recognition answer;
    std::string text;
    std::vector<std::string> notes;
    std::vector<Vec2> spikes;
    if (fit.given_class.empty()) {
      RecognizerOptions options = fit.recognizer;
      options.memory = memory_for(group, options.memory, is_among("most_patches", fit.said));
      Answered answered = recognise(input, options, probes, notes);
      if (!fit.invariants_plot.empty()) {
        const std::string picture =
            invariant_plot(answered.recognition, group.file + ", " + group.name + ", object " +
                                                     std::to_string(group.object));
        const std::string path = plot_path(fit.invariants_plot, number + 1);
        if (const std::string why = write_file(path, picture); !why.empty()) {
          code = complain(why, kFailed);
        }
      }
      answer = std::move(answered.wire);
      spikes = std::move(answered.recognition.outliers_m);
      text = json ? json_line(answer)
                  : report_text(answer, noise_is_known(input, fit.recognizer, answer));
    } else {
      notes = input.notes;
      const v1::GivenClassAnswer given =
          fit_given({*curve_class_from_name(fit.given_class), left_out}, group, fit.recognizer,
                    probes, notes);
      text = json ? json_line(given) : given_class_text(given);
      answer = given.recognition();
    }
    const ContactGroup measured = as_measured(group, probes, answer, fit.recognizer.touched_from);
    const Stated stated =
        stated_of(measured, fit.recognizer, noise_is_known(input, fit.recognizer, answer));
    if (std::string note = note_of_tip_side(measured, answer, fit.recognizer.touched_from);
        !note.empty()) {
      complain(group.file + ": " + note, kDone);
      notes.push_back(std::move(note));
    }
    // A probe file may know the tip.
    if (std::string note = note_of_unused_side(group, fit.recognizer.touched_from);
        probes.empty() && !note.empty()) {
      complain(group.file + ": " + note, kDone);
      notes.push_back(std::move(note));
    }
    // A class that is given is fitted to all samples: none is set aside as a spike.
    const bool is_found = answer.status() == v1::RECOGNITION_STATUS_RECOGNIZED &&
                          answer.curve_class() != v1::CURVE_CLASS_UNCLASSIFIED;
    if (approach && (!is_found || !fit.given_class.empty())) {
      std::string note = "WARNING: " + sentence_of(*approach);
      complain(group.file + ": " + note, kDone);
      notes.push_back(std::move(note));
    }
    if (json) {
      std::cout << with_notes(text, notes);
    } else {
      std::cout << (number > 0 ? "\n" : "") << printable_path(group.file) << ": " << text;
      if (fit.given_class.empty() && !is_found) {
        std::cout << "  advice       " << advice_text(answer, stated) << "\n";
      }
      for (const std::string& note : notes) std::cout << "  note         " << note << "\n";
    }
    ++number;
    if (!fit.plot.empty()) {
      const std::string path = plot_path(fit.plot, number);
      if (const std::string why = write_file(path, svg_plot(measured, answer, spikes, stated));
          !why.empty()) {
        code = complain(why, kFailed);
      }
    }
    if (!fit.curve_file.empty()) {
      const std::string path = plot_path(fit.curve_file, number);
      if (const std::string why = export_curve(measured, answer, path); !why.empty()) {
        code = complain(why, kFailed);
      }
    }
  }
  std::cout.flush();
  return std::cout ? code : complain("standard output: cannot be written", kFailed);
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  auto fit = std::make_shared<FitCommand>();
  CLI::App* command = app.add_subcommand(
      "fit",
      "Recognise the objects of CSV files, one answer a group and object.\n"
      "Columns by name, in any order: x and y (also x_mm, \"X [um]\", pos_x; z with --plane), and\n"
      "optionally probe, patch, sigma_m, stamp_ns, object, group, tip_radius_m, material_side; or\n"
      "two or three columns without names; comma, semicolon, tab or blanks between them; '#'\n"
      "starts a comment. Probe logs of LinuxCNC and grbl are read too.");
  command->add_option("FILE", fit->files, "Files of points; - is standard input")
      ->required()
      ->type_name("");
  command
      ->add_option(
          "--format", fit->format,
          "text (default on a terminal) or json (default elsewhere): one Recognition of the "
          "wire contract a line, with \"notes\" about the file where there are any")
      ->check(CLI::IsMember({"text", "json"}))
      ->type_name("FORMAT");
  CLI::Option* curve_file =
      command
          ->add_option(
              "--export", fit->curve_file,
              "Write the recognised curve, by the name's ending: .csv (points along it), .json "
              "(class, parameters, pose and points) or .dxf (for CAD, in millimetres); further "
              "groups go to FILE-2.csv, ...")
          ->check([](const std::string& path) {
            return export_kind(path) ? std::string()
                                     : "\"" + path + "\" ends in none of .csv, .json, .dxf";
          })
          ->type_name("FILE");
  CLI::Option* plot =
      command
          ->add_option(
              "--plot", fit->plot,
              "Draw samples, curve, 95 % band, rivals, enlarged residuals and frame as SVG; "
              "further groups go to FILE-2.svg, ...")
          ->check(svg_file())
          ->type_name("FILE");
  CLI::Option* invariants_plot =
      command
          ->add_option("--plot-invariants", fit->invariants_plot,
                       "Draw the recognition tree's invariants as SVG, for every class that it "
                       "asked about: what each contact says, and the value of all with its band; "
                       "conics as the line Ip = Ic2 - Ic1 |kappa|^(-2/3); further groups go to "
                       "FILE-2.svg, ...")
          ->check(svg_file())
          ->type_name("FILE");
  CLI::Option* given =
      command
          ->add_option(
              "--class", fit->given_class,
              "Fit this class to all samples, whatever they look like and in whatever order: the "
              "least squares of the orthogonal distances, with form (rms, peak to valley) and "
              "residuals. Of the options under Recognition it takes --sigma, --touched-from, "
              "--determined-fraction and --recognized-probability; json is one GivenClassAnswer "
              "(palpate/v1/given_class.proto) a line")
          ->excludes(invariants_plot)
          ->check(curve_class_name())
          ->type_name("CLASS");
  CLI::Option* leave_out =
      command
          ->add_option("--leave-out", fit->left_out,
                       "Samples that are not to count, numbered from 1 in the file's order; 1-5 "
                       "are five of them")
          ->delimiter(',')
          ->transform(without_blanks_around)
          ->type_name("NUMBER,...");
  command
      ->add_option(
          "--part", fit->part,
          "Place the closed spline of this scene file (*.textproto) instead of recognising a "
          "curve: its pose, the segment of every patch, the samples beyond a joint. Single touches "
          "may be in any order, if their noise is stated. Of the options under Recognition it "
          "takes "
          "--sigma, --recognized-probability and --false-outlier-probability; json is one "
          "PartMatch (palpate/v1/part_match.proto) a line")
      ->excludes(curve_file)
      ->excludes(plot)
      ->excludes(invariants_plot)
      ->excludes(given)
      ->excludes(leave_out)
      ->type_name("FILE");
  command
      ->add_option(
          "--probe", fit->probe_files,
          "Probe file of palpate calibrate: its offsets are taken off by the normals "
          "found, its noise, drift and tip radius count, and the answer names it. May be "
          "repeated: of several files each is for the probe that it names. Not with --part")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  add_file_flags(*command, fit->file);
  add_recognizer_flags(*command, *fit);
  command->callback([fit, command, &exit_code] {
    for_each_recognizer_option(fit->words, fit->recognizer, [&](const OptionInfo& info, auto&) {
      if (command->count(flag_of(info.name)) > 0) fit->said.emplace_back(info.name);
    });
    exit_code = run(*fit);
  });
}

}  // namespace palpate
