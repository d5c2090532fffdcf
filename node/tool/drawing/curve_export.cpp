#include "node/tool/drawing/curve_export.h"

#include <dxflib/dl_dxf.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "node/files/written_file.h"
#include "node/tool/drawing/curve_model.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

/// Chords of a polyline: one degree each for a full turn.
constexpr int kSteps = 360;

struct ExportedPlace {
  double t = 0.0;
  Vec2 position;
  double tangent_rad = 0.0;
  double kappa_per_m = 0.0;
};

std::vector<ExportedPlace> places_of(const CurveModel& model, const CurveSpan& span) {
  std::vector<ExportedPlace> places;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = span.from + (span.to - span.from) * i / kSteps;
    const LocalGeometry local = geometry(model.curve, t);
    const Vec2 along = model.world_T_curve.rotate(derivatives(model.curve, t).first);
    places.push_back({t, model.world_position(t), std::atan2(along.y(), along.x()), local.kappa});
  }
  return places;
}

std::string as_csv(const std::vector<ExportedPlace>& places) {
  std::string text = "t,x_m,y_m,tangent_rad,kappa_per_m\n";
  for (const ExportedPlace& place : places) {
    char row[160];
    std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g,%.17g\n", place.t, place.position.x(),
                  place.position.y(), place.tangent_rad, place.kappa_per_m);
    text += row;
  }
  return text;
}

std::string as_json(const v1::Recognition& answer, const std::vector<ExportedPlace>& places,
                    bool closed) {
  nlohmann::ordered_json json;
  json["class"] = spoken_name(answer.curve_class());
  json["status"] = status_text(answer);
  for (const Quantity& quantity : quantities_of(answer)) {
    // An infinite deviation is not a JSON number; it becomes null.
    json["quantities"][quantity.name] = {{"value", quantity.value}, {"sigma", quantity.sigma}};
  }
  json["units"] = "SI";
  json["closed"] = closed;
  for (const ExportedPlace& place : places) {
    json["points_m"].push_back({place.position.x(), place.position.y()});
  }
  return json.dump(1) + "\n";
}

/// The sections of a DXF file that hold no data of ours, in the order that the format requires.
void write_frame_before(DL_Dxf& dxf, DL_WriterA& out) {
  dxf.writeHeader(out);
  constexpr int kMillimetres = 4;
  out.dxfString(9, "$INSUNITS");
  out.dxfInt(70, kMillimetres);
  out.sectionEnd();
  out.sectionTables();
  dxf.writeVPort(out);
  out.tableLinetypes(3);
  for (const char* name : {"BYBLOCK", "BYLAYER", "CONTINUOUS"}) {
    dxf.writeLinetype(out, DL_LinetypeData(name, "", 0, 0, 0.0));
  }
  out.tableEnd();
  constexpr int kBlack = 7;
  out.tableLayers(1);
  dxf.writeLayer(out, DL_LayerData("0", 0), DL_Attributes("", kBlack, -1, "CONTINUOUS", 1.0));
  out.tableEnd();
  out.tableStyle(1);
  dxf.writeStyle(out, DL_StyleData("Standard", 0, 0.0, 1.0, 0.0, 0, 2.5, "txt", ""));
  out.tableEnd();
  dxf.writeView(out);
  dxf.writeUcs(out);
  out.tableAppid(1);
  dxf.writeAppid(out, "ACAD");
  out.tableEnd();
  dxf.writeDimStyle(out, 1.0, 1.0, 1.0, 1.0, 1.0);
  dxf.writeBlockRecord(out);
  out.tableEnd();
  out.sectionEnd();
  out.sectionBlocks();
  for (const char* name : {"*Model_Space", "*Paper_Space", "*Paper_Space0"}) {
    dxf.writeBlock(out, DL_BlockData(name, 0, 0.0, 0.0, 0.0));
    dxf.writeEndBlock(out, name);
  }
  out.sectionEnd();
  out.sectionEntities();
}

void write_frame_after(DL_Dxf& dxf, DL_WriterA& out) {
  out.sectionEnd();
  dxf.writeObjects(out);
  dxf.writeObjectsEnd(out);
  out.dxfEOF();
  out.close();
}

std::string write_dxf(const CurveModel& model, const std::vector<ExportedPlace>& places,
                      bool closed, const std::string& path) {
  DL_Dxf dxf;
  errno = 0;
  const std::unique_ptr<DL_WriterA> out(dxf.out(path.c_str(), DL_Codes::AC1015));
  if (out == nullptr) return cannot_be_written(path);
  write_frame_before(dxf, *out);
  constexpr double kPerMetre = 1e3;
  const DL_Attributes by_layer("0", 256, -1, "BYLAYER", 1.0);
  const Vec2 centre = kPerMetre * Vec2(model.world_T_curve.x, model.world_T_curve.y);
  const Eigen::Vector3d shape = kPerMetre * parameters(model.curve);
  switch (class_of(model.curve)) {
    case CurveClass::Line: {
      const Vec2 from = kPerMetre * places.front().position;
      const Vec2 to = kPerMetre * places.back().position;
      dxf.writeLine(*out, DL_LineData(from.x(), from.y(), 0.0, to.x(), to.y(), 0.0), by_layer);
      break;
    }
    case CurveClass::Circle:
      dxf.writeCircle(*out, DL_CircleData(centre.x(), centre.y(), 0.0, shape[0]), by_layer);
      break;
    case CurveClass::Ellipse: {
      const Vec2 major = model.world_T_curve.rotate(Vec2(shape[0], 0.0));
      dxf.writeEllipse(*out,
                       DL_EllipseData(centre.x(), centre.y(), 0.0, major.x(), major.y(), 0.0,
                                      shape[1] / shape[0], 0.0, 2.0 * std::acos(-1.0)),
                       by_layer);
      break;
    }
    default: {
      const auto count = static_cast<int>(places.size());
      dxf.writePolyline(*out, DL_PolylineData(count, 0, 0, closed ? 1 : 0), by_layer);
      for (const ExportedPlace& place : places) {
        const Vec2 at = kPerMetre * place.position;
        dxf.writeVertex(*out, DL_VertexData(at.x(), at.y(), 0.0));
      }
      dxf.writePolylineEnd(*out);
    }
  }
  write_frame_after(dxf, *out);
  // The library does not report whether the disk accepted everything.
  std::ifstream written(path, std::ios::ate | std::ios::binary);
  constexpr std::streamoff kEnd = 4;  // bytes: "EOF" and a line end
  std::string end(kEnd, ' ');
  if (written.tellg() >= kEnd) written.seekg(-kEnd, std::ios::end).read(end.data(), kEnd);
  return end.starts_with("EOF") ? "" : cannot_be_written(path);
}

}  // namespace

std::optional<ExportKind> export_kind(const std::string& path) {
  if (path.ends_with(".csv")) return ExportKind::Csv;
  if (path.ends_with(".json")) return ExportKind::Json;
  if (path.ends_with(".dxf")) return ExportKind::Dxf;
  return std::nullopt;
}

std::string export_curve(const ContactGroup& group, const v1::Recognition& answer,
                         const std::string& path) {
  const auto kind = export_kind(path);
  if (!kind) return path + ": ends in none of .csv, .json, .dxf";
  if (answer.status() == v1::RECOGNITION_STATUS_RECOGNIZED &&
      answer.curve_class() == v1::CURVE_CLASS_UNCLASSIFIED) {
    return path + ": not written: the samples are no curve of the known classes";
  }
  const auto model = model_of(answer);
  if (!model) return path + ": not written: no curve was found (" + status_text(answer) + ")";
  std::vector<Vec2> touched;
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) touched.push_back(sample.position_m);
  }
  const auto span = drawn_span(*model, touched);
  if (!span) return path + ": not written: the touched places span no piece of the curve";
  const std::vector<ExportedPlace> places = places_of(*model, *span);
  if (*kind == ExportKind::Dxf) return write_dxf(*model, places, span->closed, path);
  return write_file(
      path, *kind == ExportKind::Csv ? as_csv(places) : as_json(answer, places, span->closed));
}

}  // namespace palpate
