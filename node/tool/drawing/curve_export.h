// The recognised curve as a file for other programs.
#pragma once

#include <optional>
#include <string>

#include "node/tool/contact_groups.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

enum class ExportKind { Csv, Json, Dxf };

/// By the path's ending: .csv, .json or .dxf.
std::optional<ExportKind> export_kind(const std::string& path);

/// Writes the piece that a picture shows: all of a closed curve, else the touched arc and half as
/// much again at either end. CSV: t, x_m, y_m, tangent_rad, kappa_per_m along it. JSON: besides
/// class, parameters and pose. DXF, in millimetres: a LINE, CIRCLE or ELLIPSE as such, the others
/// as polylines. Returns why it could not, or nothing.
std::string export_curve(const ContactGroup& group, const v1::Recognition& answer,
                         const std::string& path);

}  // namespace palpate
