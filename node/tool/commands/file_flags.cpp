#include "node/tool/commands/file_flags.h"

#include "node/tool/commands/command.h"

namespace palpate {

void add_file_flags(CLI::App& command, FileFlags& flags) {
  const char* group = "File";
  command
      .add_option(
          "--unit", flags.unit,
          "Unit of the lengths whose columns name none: m, mm, cm, um, nm or in; else metres. "
          "Of every length if it contradicts what a coordinate names")
      ->check([](const std::string& name) {
        return length_unit_m(name) ? std::string()
                                   : "\"" + name + "\" is none of m, mm, cm, um, nm, in";
      })
      ->type_name("UNIT")
      ->group(group);
  command
      .add_option("--plane", flags.plane,
                  "Of three coordinates: xy, xz, yz, fit (least squares, seen as the nearest of "
                  "these) or auto (the two along which the points vary)")
      ->check(CLI::IsMember({"auto", "xy", "xz", "yz", "fit"}))
      ->capture_default_str()
      ->type_name("PLANE")
      ->group(group);
  CLI::Option* touches =
      command
          .add_flag("--touches", flags.touches,
                    "Every row is a touch of its own, in no order along the part (so in probe "
                    "logs)")
          ->group(group);
  command
      .add_flag("--strokes", flags.strokes,
                "Rows follow one another along the part, in a probe log too")
      ->excludes(touches)
      ->group(group);
  command
      .add_option("--tip-radius", flags.tip_radius_m,
                  "Points are centres of a round tip of this radius, where the file says none [m]")
      ->check(number_within(0.0, 1e3))
      ->capture_default_str()
      ->type_name("METRES")
      ->group(group);
}

ContactFileOptions options_of(const FileFlags& flags) {
  ContactFileOptions options;
  if (!flags.unit.empty()) options.unit_m = length_unit_m(flags.unit);
  options.plane = point_plane_from_name(flags.plane).value_or(PointPlane::Varying);
  if (flags.touches || flags.strokes) options.touches = flags.touches;
  options.tip_radius_m = flags.tip_radius_m;
  return options;
}

}  // namespace palpate
