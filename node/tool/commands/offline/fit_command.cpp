// palpate fit: the recognizer's answer for files, without a network.
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "node/files/overwritten_input.h"
#include "node/files/printable.h"
#include "node/files/trimmed.h"
#include "node/files/written_file.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/offline/fit_answer.h"
#include "node/tool/commands/offline/fit_files.h"
#include "node/tool/commands/offline/placed_part.h"
#include "node/tool/drawing/curve_export.h"
#include "node/tool/drawing/svg/invariant_plot.h"
#include "node/tool/drawing/svg/svg_plot.h"

namespace palpate {
namespace {

/// For lists with commas: "circle, ellipse" is "circle,ellipse".
std::string without_blanks_around(const std::string& word) { return std::string(trimmed(word)); }

/// Flags for the recogniser's options, out of their one table.
void add_recognizer_flags(CLI::App& command, FitRequest& fit) {
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
      // memory_for(): a file is there as a whole.
      if (std::string_view(info.name) == "most_patches") option->default_str("all of a file");
    }
  });
}

/// PLOT.svg for the first group, PLOT-2.svg for the second, ...
std::string plot_path(const std::string& path, std::size_t number) {
  if (number == 1) {
    return path;
  }
  const std::size_t name = path.rfind('/') + 1;  // 0 without a folder
  const std::size_t last = path.rfind('.');
  const std::size_t dot = last == std::string::npos || last < name ? std::string::npos : last;
  const std::string stem = path.substr(0, dot);
  const std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  return stem + "-" + std::to_string(number) + ending;
}

/// What is wrong if a file that is read would be written over, or nothing.
std::string wrong_with_outputs(const FitRequest& fit, std::size_t groups) {
  std::vector<std::string> read = fit.files;
  read.insert(read.end(), fit.probe_files.begin(), fit.probe_files.end());
  read.push_back(fit.part);
  const std::vector<std::string> written{fit.plot, fit.invariants_plot, fit.curve_file};
  if (std::string why = overwrites_output(written); !why.empty()) return why;
  for (const std::string& path : written) {
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
std::string wrong_with_options(const FitRequest& fit) {
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

/// What is wrong with what is asked for, or nothing.
std::string wrong_with(FitRequest& fit) {
  if (std::string why = wrong_with_options(fit); !why.empty()) return why;
  if (const std::string why = resolve(fit.words, fit.recognizer); !why.empty()) {
    // It begins with the option's name in the table, which is the node's too.
    const std::size_t name = why.find(':');
    return flag_of(why.substr(0, name)) + why.substr(name) + "; palpate fit --help says more";
  }
  if (!fit.part.empty() && !fit.probe_files.empty()) {
    return "--probe: not with --part, which places the samples as they are: only the normals of a "
           "curve that is recognised or given are used to take a probe's offsets off";
  }
  return "";
}

void print(const FitAnswer& told, std::size_t number, bool json, bool is_given) {
  if (json) {
    std::cout << with_notes(told.text, told.notes);
    return;
  }
  std::cout << (number > 1 ? "\n" : "") << printable_path(told.measured.file) << ": " << told.text;
  if (!is_given && !told.is_found) {
    std::cout << "  advice       " << advice_text(told.answer, told.stated) << "\n";
  }
  for (const std::string& note : told.notes) std::cout << "  note         " << note << "\n";
}

/// Pictures and curves of an answer. kDone, or why they could not be written: the other answers are
/// not lost with it.
int write_files(const FitRequest& fit, const FitAnswer& told, std::size_t number) {
  const ContactGroup& group = told.measured;
  std::vector<std::string> failed;
  if (!fit.invariants_plot.empty() && told.recognition) {
    const std::string title =
        group.file + ", " + group.name + ", object " + std::to_string(group.object);
    failed.push_back(write_file(plot_path(fit.invariants_plot, number),
                                invariant_plot(*told.recognition, title)));
  }
  if (!fit.plot.empty()) {
    failed.push_back(write_file(plot_path(fit.plot, number),
                                svg_plot(group, told.answer, told.spikes_m, told.stated)));
  }
  if (!fit.curve_file.empty()) {
    failed.push_back(export_curve(group, told.answer, plot_path(fit.curve_file, number)));
  }
  int code = kDone;
  for (const std::string& why : failed) {
    if (!why.empty()) code = complain(why, kFailed);
  }
  return code;
}

int run(FitRequest& fit) {
  if (const std::string why = wrong_with(fit); !why.empty()) return complain(why, kUsage);
  std::optional<FitFiles> files = read_fit_files(fit);
  if (!files) return kUsage;
  if (const std::string why = wrong_with_outputs(fit, files->inputs.size()); !why.empty()) {
    return complain(why, kUsage);
  }
  const bool json = fit.format.empty() ? isatty(STDOUT_FILENO) == 0 : fit.format == "json";
  if (!fit.part.empty()) {
    return place_part(fit.part, files->inputs, fit.recognizer, json);
  }
  std::size_t number = 0;
  int code = kDone;
  for (FitInput& input : files->inputs) {
    const FitAnswer told = fit_answer(fit, std::move(input), files->probes, files->left_out, json);
    ++number;
    print(told, number, json, !fit.given_class.empty());
    code = std::max(code, write_files(fit, told, number));
  }
  const std::string unwritten = flush_standard_output();
  return unwritten.empty() ? code : complain(unwritten, kFailed);
}

void add_output_flags(CLI::App& command, FitRequest& fit) {
  command
      .add_option(
          "--format", fit.format,
          "text (default on a terminal) or json (default elsewhere): one Recognition of the "
          "wire contract a line, with \"notes\" about the file where there are any")
      ->check(CLI::IsMember({"text", "json"}))
      ->type_name("FORMAT");
  command
      .add_option("--export", fit.curve_file,
                  "Write the recognised curve, by the name's ending: .csv (points along it), .json "
                  "(class, parameters, pose and points) or .dxf (for CAD, in millimetres); further "
                  "groups go to FILE-2.csv, ...")
      ->check([](const std::string& path) {
        return export_kind(path) ? std::string()
                                 : "\"" + path + "\" ends in none of .csv, .json, .dxf";
      })
      ->type_name("FILE");
  command
      .add_option("--plot", fit.plot,
                  "Draw samples, curve, 95 % band, rivals, enlarged residuals and frame as SVG; "
                  "further groups go to FILE-2.svg, ...")
      ->check(svg_file())
      ->type_name("FILE");
  command
      .add_option("--plot-invariants", fit.invariants_plot,
                  "Draw the recognition tree's invariants as SVG, for every class that it "
                  "asked about: what each contact says, and the value of all with its band; "
                  "conics as the line Ip = Ic2 - Ic1 |kappa|^(-2/3); further groups go to "
                  "FILE-2.svg, ...")
      ->check(svg_file())
      ->type_name("FILE");
}

/// What is known of the part and its probes, and what is asked of them.
void add_task_flags(CLI::App& command, FitRequest& fit) {
  command
      .add_option(
          "--class", fit.given_class,
          "Fit this class to all samples, whatever they look like and in whatever order: the "
          "least squares of the orthogonal distances, with form (rms, peak to valley) and "
          "residuals. Of the options under Recognition it takes --sigma, --touched-from, "
          "--determined-fraction and --recognized-probability; json is one GivenClassAnswer "
          "(palpate/v1/given_class.proto) a line")
      ->excludes("--plot-invariants")
      ->check(curve_class_name())
      ->type_name("CLASS");
  command
      .add_option("--leave-out", fit.left_out,
                  "Samples that are not to count, numbered from 1 in the file's order; 1-5 "
                  "are five of them")
      ->delimiter(',')
      ->transform(without_blanks_around)
      ->type_name("NUMBER,...");
  command
      .add_option(
          "--part", fit.part,
          "Place the closed spline of this scene file (*.textproto) instead of recognising a "
          "curve: its pose, the segment of every patch, the samples beyond a joint. Single touches "
          "may be in any order, if their noise is stated. Of the options under Recognition it "
          "takes --sigma, --recognized-probability and --false-outlier-probability; json is one "
          "PartMatch (palpate/v1/part_match.proto) a line")
      ->excludes("--export")
      ->excludes("--plot")
      ->excludes("--plot-invariants")
      ->excludes("--class")
      ->excludes("--leave-out")
      ->type_name("FILE");
  command
      .add_option(
          "--probe", fit.probe_files,
          "Probe file of palpate calibrate: its offsets are taken off by the normals "
          "found, its noise, drift and tip radius count, and the answer names it. May be "
          "repeated: of several files each is for the probe that it names, and one without a name "
          "for all others. Not with --part")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  auto fit = std::make_shared<FitRequest>();
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
  add_output_flags(*command, *fit);
  add_task_flags(*command, *fit);
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
