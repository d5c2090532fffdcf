// Writes the recognised curve to a file for other programs.
#pragma once

#include <optional>
#include <string>

#include "node/tool/contact_groups.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

enum class ExportKind { Csv, Json, Dxf };

/// The kind by the path's ending: .csv, .json or .dxf; nullopt for any other.
std::optional<ExportKind> export_kind(const std::string& path);

/// Writes the piece of the curve that a picture shows: all of a closed curve, else the touched arc,
/// extended by half its length at both ends. CSV: t, x_m, y_m, tangent_rad, kappa_per_m along it.
/// JSON: in addition class, parameters and pose. DXF, in millimetres: a LINE, CIRCLE or ELLIPSE as
/// such, other classes as polylines. Returns an empty string or an error.
std::string export_curve(const ContactGroup& group, const v1::Recognition& answer,
                         const std::string& path);

}  // namespace palpate
