#include "node/tool/drawing/svg/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

#include "node/files/quantity.h"
#include "node/tool/drawing/band_area.h"
#include "node/tool/drawing/drawing.h"
#include "node/tool/drawing/enlarged_residuals.h"
#include "node/tool/drawing/pose_ellipse.h"
#include "node/tool/drawing/shown_extent.h"
#include "node/tool/drawing/svg/colours.h"
#include "node/tool/drawing/svg/svg_answer.h"
#include "node/tool/drawing/svg/svg_table.h"
#include "node/tool/drawing/svg/ticks.h"
#include "node/tool/drawing/visible_samples.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

constexpr double kWidth = 1064.0;  // of the document; all in pixels
constexpr double kHeight = 680.0;  // at least
constexpr double kLeft = 80.0;
constexpr double kTop = 24.0;
constexpr double kRight = 364.0;  // left edge of the table
constexpr double kBottom = 60.0;

constexpr double kDotPixels = 3.6;    // width of a sample of a stroke
constexpr double kTouchPixels = 7.0;  // of a single touch

constexpr const char* kRivalColour = "#8a5cc2";
constexpr const char* kResidualColour = "#c2185b";
constexpr const char* kContactColour = "#b36b00";
constexpr const char* kXAxisColour = "#c00000";
constexpr const char* kYAxisColour = "#008000";

/// From metres to pixels: equal scales on both axes, y upwards.
class View {
 public:
  View(const Vec2& low, const Vec2& high) {
    const Vec2 centre = 0.5 * (low + high);
    // One place alone has no size: as much is shown as of a small part.
    constexpr double kAlone_m = 0.02;
    const double least =
        (high - low).maxCoeff() > 0.0 ? 1e-12 * (1.0 + centre.cwiseAbs().maxCoeff()) : kAlone_m;
    const Vec2 extent = (high - low).cwiseMax(least);
    const Vec2 room(kWidth - kLeft - kRight, kHeight - kTop - kBottom);
    constexpr double kFilled = 0.9;
    pixels_per_m_ = kFilled * (room.array() / extent.array()).minCoeff();
    half_ = 0.5 * room / pixels_per_m_;
    centre_ = centre;
  }

  Vec2 operator()(const Vec2& p) const {
    return {kLeft + (p.x() - low().x()) * pixels_per_m_,
            kHeight - kBottom - (p.y() - low().y()) * pixels_per_m_};
  }

  Vec2 low() const { return centre_ - half_; }
  Vec2 high() const { return centre_ + half_; }
  double metres(double pixels) const { return pixels / pixels_per_m_; }

 private:
  Vec2 centre_;
  Vec2 half_;
  double pixels_per_m_ = 1.0;
};

View view_of(const ContactGroup& group, const v1::Recognition& answer, const Drawing& drawing) {
  const Extent extent =
      shown_extent(group, answer, drawing).value_or(Extent{Vec2::Zero(), Vec2::Zero()});
  return View(extent.low, extent.high);
}

std::string axes_svg(const View& view) {
  const LengthUnit unit = length_unit_for((view.high() - view.low()).maxCoeff());
  std::string svg;
  const double step = tick_step((view.high().x() - view.low().x()) * unit.per_m, 7.0);
  std::array<std::string, 2> titles;
  for (int axis = 0; axis < 2; ++axis) {
    const double from = view.low()[axis] * unit.per_m;
    const double to = view.high()[axis] * unit.per_m;
    const double offset = tick_offset(from, to, step);
    titles[static_cast<std::size_t>(axis)] =
        axis_title(axis == 0 ? "x" : "y", offset, step, std::string(unit.name).c_str());
    // Counted: far from the origin a tick may be no number beside the one before.
    const double first = std::ceil((from - offset) / step) * step;
    const double last = to - offset;
    for (int k = 0; first + k * step <= last; ++k) {
      Vec2 place = view.low();
      const double value = std::abs(first + k * step) < 1e-6 * step ? 0.0 : first + k * step;
      place[axis] = (value + offset) / unit.per_m;
      const Vec2 at = view(place);
      const std::string label = number(value);
      if (axis == 0) {
        svg += formatted("<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                         at.x(), kTop, at.x(), kHeight - kBottom);
        svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", at.x(),
                         kHeight - kBottom + 18.0, label.c_str());
      } else {
        svg += formatted("<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                         kLeft, at.y(), kWidth - kRight, at.y());
        svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", kLeft - 6.0,
                         at.y() + 4.0, label.c_str());
      }
    }
  }
  svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n",
                   0.5 * (kLeft + kWidth - kRight), kHeight - 18.0, titles[0].c_str());
  svg += formatted(
      "<text x=\"20\" y=\"%.1f\" text-anchor=\"middle\" transform=\"rotate(-90 20 "
      "%.1f)\">%s</text>\n",
      0.5 * (kTop + kHeight - kBottom), 0.5 * (kTop + kHeight - kBottom), titles[1].c_str());
  svg += formatted(
      "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" "
      "stroke=\"#888\"/>\n",
      kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  return svg;
}

/// SVG's numbers have single precision, so positions far outside are clamped.
std::string point_text(const View& view, const Vec2& place) {
  constexpr double kFar = 1e5;
  const Vec2 at = view(place).cwiseMin(kFar).cwiseMax(-kFar);
  return formatted("%.2f,%.2f ", at.x(), at.y());
}

std::string polyline(const View& view, const DrawnCurve& curve, const char* style) {
  std::string svg =
      "<polyline clip-path=\"url(#picture)\" fill=\"none\" " + std::string(style) + " points=\"";
  for (const CurvePlace& place : curve.places) svg += point_text(view, place.position);
  return svg + "\"/>\n";
}

std::string band_svg(const View& view, const DrawnCurve& curve) {
  const std::vector<std::vector<Vec2>> area = band_area(curve);
  if (area.empty()) return {};
  // The group's opacity: where polygons overlap the band is no darker.
  std::string svg = formatted(
      "<g class=\"band\" clip-path=\"url(#picture)\" fill=\"%s\" opacity=\"0.3\">\n", kBandColour);
  for (const std::vector<Vec2>& polygon : area) {
    svg += "<polygon points=\"";
    for (const Vec2& corner : polygon) svg += point_text(view, corner);
    svg += "\"/>\n";
  }
  return svg + "</g>\n";
}

std::string curves_svg(const View& view, const Drawing& drawing) {
  std::string svg = drawing.curve ? band_svg(view, *drawing.curve) : "";
  for (const DrawnCurve& rival : drawing.rivals) {
    svg += polyline(
        view, rival,
        formatted("class=\"rival\" stroke=\"%s\" stroke-width=\"1.2\" stroke-dasharray=\"6 4\" "
                  "stroke-opacity=\"%.2f\"",
                  kRivalColour, 0.25 + 0.65 * rival.probability)
            .c_str());
  }
  if (drawing.curve) {
    svg += polyline(
        view, *drawing.curve,
        formatted("class=\"curve\" stroke=\"%s\" stroke-width=\"1.5\"", kCurveColour).c_str());
  }
  return svg;
}

std::string frame_svg(const View& view, const v1::Recognition& answer, const Drawing& drawing) {
  if (!drawing.curve) return {};
  constexpr double kArrow = 50.0;
  const Pose2 pose{answer.pose().x_m(), answer.pose().y_m(), answer.pose().theta_rad()};
  const Vec2 origin = view(pose.translation());
  std::string svg;
  for (int axis = 0; axis < 2; ++axis) {
    const Vec2 unit = axis == 0 ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0);
    const Vec2 tip = view(pose.translation() + pose.rotate(view.metres(kArrow) * unit));
    svg += formatted(
        "<line clip-path=\"url(#picture)\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" "
        "stroke=\"%s\" "
        "stroke-width=\"2\"/>\n",
        origin.x(), origin.y(), tip.x(), tip.y(), axis == 0 ? kXAxisColour : kYAxisColour);
  }
  const std::optional<CurveModel> model = model_of(answer);
  if (const auto ellipse = model ? pose_ellipse(*model) : std::optional<PoseEllipse>()) {
    // Clamped: the border of a larger ellipse is outside the picture anyway.
    constexpr double kFar = 1e5;
    // Clipped in the picture's frame, not in its own.
    svg += "<g clip-path=\"url(#picture)\">" +
           formatted(
               "<ellipse class=\"origin\" rx=\"%.2f\" ry=\"%.2f\" "
               "transform=\"translate(%.2f %.2f) rotate(%.2f)\" fill=\"%s\" fill-opacity=\"0.3\" "
               "stroke=\"%s\"/></g>\n",
               std::min(ellipse->long_m / view.metres(1.0), kFar),
               std::min(ellipse->short_m / view.metres(1.0), kFar), origin.x(), origin.y(),
               -kDegrees * ellipse->angle_rad, kBandColour, kBandColour);
  }
  return svg;
}

/// True if every run is a single touch. Touches are coloured by probe, strokes by patch.
bool are_touches(const ContactGroup& group) {
  return std::all_of(group.runs.begin(), group.runs.end(),
                     [](const ContactRun& run) { return run.samples.size() == 1; });
}

/// Dots as round ends of lines of length 0, which takes a few bytes each.
std::string samples_svg(const View& view, const ContactGroup& group,
                        const VisibleSamples& visible) {
  // Single touches need larger dots; the samples of a stroke form a line.
  const bool touches = are_touches(group);
  const double width = touches ? kTouchPixels : kDotPixels;
  std::string svg;
  for (std::size_t number = 0; number < group.runs.size(); ++number) {
    if (visible.of_run[number].empty()) continue;
    svg += formatted(
        "<path class=\"samples\" fill=\"none\" stroke=\"%s\" stroke-width=\"%.1f\" "
        "stroke-linecap=\"round\" d=\"",
        kPatchColours[(touches ? group.runs[number].context.probe : number) %
                      std::size(kPatchColours)],
        width);
    for (const std::size_t i : visible.of_run[number]) {
      const Vec2 at = view(group.runs[number].samples[i].position_m);
      svg += formatted("M%.1f,%.1fh0", at.x(), at.y());
    }
    svg += "\"/>\n";
  }
  return svg;
}

std::string residuals_svg(const View& view, const EnlargedResiduals& residuals) {
  std::string svg = formatted(
      "<path class=\"residuals\" clip-path=\"url(#picture)\" fill=\"none\" "
      "stroke=\"%s\" stroke-opacity=\"0.6\" d=\"",
      kResidualColour);
  for (const EnlargedResiduals::Line& line : residuals.lines) {
    const Vec2 foot = view(line.foot);
    const Vec2 end = view(line.end);
    svg += formatted("M%.1f,%.1fL%.1f,%.1f", foot.x(), foot.y(), end.x(), end.y());
  }
  svg += "\"/>\n";
  const auto add_marks = [&](const char* name, const std::vector<Vec2>& places, const char* mark) {
    svg += formatted("<path class=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" d=\"",
                     name, kResidualColour);
    for (const Vec2& place : places) {
      const Vec2 at = view(place);
      svg += formatted("M%.1f,%.1f", at.x() - 4.0, at.y() - 4.0) + mark;
    }
    svg += "\"/>\n";
  };
  add_marks("set-aside", residuals.set_aside, "l8,8m0,-8l-8,8");
  add_marks("far", residuals.far, "m0,4h8m-4,-4v8");
  return svg;
}

std::string contacts_svg(const View& view, const v1::Recognition& answer) {
  constexpr double kTangent = 22.0;
  std::string svg;
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    const Vec2 at = view({contact.x_m(), contact.y_m()});
    const double angle = contact.tangent_rad();
    svg += formatted(
        "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"%s\" "
        "stroke-width=\"1.5\"/>\n",
        at.x(), at.y(), at.x() + kTangent * std::cos(angle), at.y() - kTangent * std::sin(angle),
        kContactColour);
    svg += formatted(
        "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\" fill=\"none\" stroke=\"%s\" "
        "stroke-width=\"1.5\"/>\n",
        at.x(), at.y(), kContactColour);
  }
  return svg;
}

std::string band_label(const DrawnCurve& curve) {
  const double widest_m = widest_band_m(curve);
  const LengthUnit unit = length_unit_for(widest_m);
  return "its 95 % band, +- " + with_digits(widest_m * unit.per_m, 2) + " " +
         std::string(unit.name) + " where widest";
}

void add_keys(const ContactGroup& group, const Drawing& drawing, bool has_origin,
              const VisibleSamples& visible, const EnlargedResiduals& residuals, SvgTable& table) {
  const bool touches = are_touches(group);
  if (touches) {
    for (std::size_t probe = 0; probe < group.probes.size(); ++probe) {
      const auto count =
          std::count_if(group.runs.begin(), group.runs.end(),
                        [&](const ContactRun& run) { return run.context.probe == probe; });
      table.key(kPatchColours[probe % std::size(kPatchColours)],
                group.probes[probe] + ", touches: " + std::to_string(count));
    }
  }
  constexpr std::size_t kMostListed = 8;
  const std::size_t strokes = touches ? 0 : group.runs.size();
  for (std::size_t i = 0; i < std::min(strokes, kMostListed); ++i) {
    const PatchContext& context = group.runs[i].context;
    table.key(kPatchColours[i % std::size(kPatchColours)],
              group.probes[context.probe] + ", patch " + std::to_string(context.patch));
  }
  if (strokes > kMostListed) {
    table.words("and " + std::to_string(strokes - kMostListed) + " more patches");
  }
  if (drawing.curve) {
    table.key(kCurveColour, "most probable curve");
    if (drawing.curve->places.front().band) table.key(kBandColour, band_label(*drawing.curve));
    table.key(kXAxisColour, "its x axis");
    table.key(kYAxisColour, "its y axis");
    if (has_origin) table.key(kBandColour, "where its origin is, 95 %");
  }
  for (const DrawnCurve& rival : drawing.rivals) {
    table.key(kRivalColour,
              spoken_name(rival.curve_class) + formatted(", %.3g %%", 100.0 * rival.probability));
  }
  if (!drawing.contacts.empty()) table.key(kContactColour, "contacts, tangents");
  if (!residuals.lines.empty()) {
    table.key(kResidualColour, residuals.gain > 1.0
                                   ? "residuals, " + number(residuals.gain) + " times enlarged"
                                   : std::string("residuals"));
  }
  if (!residuals.set_aside.empty()) {
    table.key(kResidualColour, formatted("x: %zu set aside as spikes", residuals.set_aside.size()));
  }
  if (!residuals.far.empty()) {
    table.key(kResidualColour,
              formatted("+: %zu beyond %.0f sigma", residuals.far.size(), kFarSigmas));
  }
  if (visible.left_out > 0) {
    const LengthUnit unit = length_unit_for(visible.cell_m);
    table.gap();
    table.words(std::to_string(visible.drawn) + " samples drawn; " +
                std::to_string(visible.left_out) + " lie within " +
                with_digits(visible.cell_m * unit.per_m, 2) + " " + std::string(unit.name) +
                " of one of them.");
  }
}

EnlargedResiduals residuals_of_picture(const ContactGroup& group, const v1::Recognition& answer,
                                       const Drawing& drawing, const View& view,
                                       std::span<const Vec2> set_aside) {
  const std::optional<CurveModel> model =
      drawing.curve ? model_of(answer) : std::optional<CurveModel>();
  if (!model) return {};
  constexpr std::size_t kMostLines = 2000;
  return enlarged_residuals(*model, group, answer.sigma_m(), (view.high() - view.low()).maxCoeff(),
                            kMostLines, set_aside);
}

}  // namespace

std::string svg_plot(const ContactGroup& group, const v1::Recognition& answer,
                     std::span<const Vec2> set_aside, const Stated& stated) {
  const Drawing drawing = make_drawing(group, answer, Curvature::None);
  const View view = view_of(group, answer, drawing);
  // A dot half a pixel from another one cannot be seen.
  constexpr double kCellPixels = 0.5;
  constexpr std::size_t kMostDots = 50000;
  const VisibleSamples visible =
      visible_samples(group, view.metres(kCellPixels), kMostDots, std::size(kPatchColours));
  const EnlargedResiduals residuals = residuals_of_picture(group, answer, drawing, view, set_aside);
  constexpr double kMargin = 16.0;
  SvgTable table(kWidth - kRight + kMargin, kTop + 12.0, kRight - 2.0 * kMargin);
  add_answer(group, answer, stated, table);
  const std::optional<CurveModel> model =
      drawing.curve ? model_of(answer) : std::optional<CurveModel>();
  const bool has_origin = model && pose_ellipse(*model);
  add_keys(group, drawing, has_origin, visible, residuals, table);
  // Long names take lines of their own.
  const double height = std::max(kHeight, table.y() + kMargin);
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f "
      "%.0f\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n",
      kWidth, height, kWidth, height);
  svg += "<style>.grid{stroke:#e4e4e4}</style>\n";
  svg += formatted(
      "<clipPath id=\"picture\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
      "height=\"%.1f\"/></clipPath>\n",
      kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  svg += axes_svg(view) + curves_svg(view, drawing) + residuals_svg(view, residuals) +
         samples_svg(view, group, visible) + contacts_svg(view, answer) +
         frame_svg(view, answer, drawing) + table.svg();
  return svg + "</svg>\n";
}

}  // namespace palpate
