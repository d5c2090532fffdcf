#include "node/tool/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "core/curves/curve.h"
#include "node/tool/quantity.h"

namespace palpate {
namespace {

constexpr double kWidth = 900.0;  // of the drawing, all in pixels
constexpr double kHeight = 680.0;
constexpr double kLeft = 80.0;
constexpr double kTop = 70.0;
constexpr double kRight = 190.0;  // the legend's place
constexpr double kBottom = 60.0;

constexpr const char* kPatchColours[] = {"#1b6ca8", "#d1495b", "#2e933c", "#8e5aa8",
                                         "#c97b12", "#4a7c89", "#7a4b2b", "#5b5b5b"};
constexpr const char* kCurveColour = "#222222";
constexpr const char* kContactColour = "#e08e00";
constexpr const char* kXAxisColour = "#c00000";
constexpr const char* kYAxisColour = "#008000";

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// From metres to pixels, equal scales on both axes, y upwards.
class View {
 public:
  View(const Vec2& low, const Vec2& high) {
    const Vec2 centre = 0.5 * (low + high);
    const Vec2 extent = (high - low).cwiseMax(1e-12 * (1.0 + centre.cwiseAbs().maxCoeff()));
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

/// 1, 2 or 5 times a power of ten, for about `count` ticks over the length.
double tick_step(double length, double count) {
  const double rough = length / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

View view_of(const ContactGroup& group, const Recognition& answer) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) {
      low = low.cwiseMin(sample.position_m);
      high = high.cwiseMax(sample.position_m);
    }
  }
  // A closed curve is shown whole, and the frame where it is not far away.
  const double size = (high - low).maxCoeff();
  const auto include = [&](const Vec2& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  const Pose2& pose = answer.world_T_curve;
  const CurveClass curve_class = answer.shape.curve_class;
  const double radius = answer.shape.values[0];
  constexpr double kNotFar = 3.0;  // sizes of what was touched
  if ((curve_class == CurveClass::Circle || curve_class == CurveClass::Ellipse) &&
      radius < kNotFar * size) {
    const double b = curve_class == CurveClass::Circle ? radius : answer.shape.values[1];
    const Vec2 reach(std::hypot(radius * std::cos(pose.theta), b * std::sin(pose.theta)),
                     std::hypot(radius * std::sin(pose.theta), b * std::cos(pose.theta)));
    include(pose.translation() - reach);
    include(pose.translation() + reach);
  } else if (make_curve(curve_class, answer.shape.values) && curve_class != CurveClass::Line &&
             (pose.translation() - 0.5 * (low + high)).norm() < 0.5 * kNotFar * size) {
    include(pose.translation());
  }
  return View(low, high);
}

std::string axes_svg(const View& view) {
  const LengthUnit unit = length_unit_for((view.high() - view.low()).maxCoeff());
  std::string svg;
  const double step = tick_step((view.high().x() - view.low().x()) * unit.per_m, 7.0);
  for (int axis = 0; axis < 2; ++axis) {
    const double from = view.low()[axis] * unit.per_m;
    const double to = view.high()[axis] * unit.per_m;
    for (double k = std::ceil(from / step); k * step <= to; k += 1.0) {
      Vec2 place = view.low();
      place[axis] = k * step / unit.per_m;
      const Vec2 at = view(place);
      const std::string label = number(k * step == 0.0 ? 0.0 : k * step);
      if (axis == 0) {
        svg += format("<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", at.x(),
                      kTop, at.x(), kHeight - kBottom);
        svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", at.x(),
                      kHeight - kBottom + 18.0, label.c_str());
      } else {
        svg += format("<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", kLeft,
                      at.y(), kWidth - kRight, at.y());
        svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", kLeft - 6.0,
                      at.y() + 4.0, label.c_str());
      }
    }
  }
  const std::string name(unit.name);
  svg += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">x [%s]</text>\n",
                0.5 * (kLeft + kWidth - kRight), kHeight - 18.0, name.c_str());
  svg += format(
      "<text x=\"20\" y=\"%.1f\" text-anchor=\"middle\" transform=\"rotate(-90 20 %.1f)\">y [%s]</text>\n",
      0.5 * (kTop + kHeight - kBottom), 0.5 * (kTop + kHeight - kBottom), name.c_str());
  svg += format(
      "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#888\"/>\n", kLeft,
      kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  return svg;
}

/// The parameters to draw: all of a closed curve, else what the contacts span and a little more.
std::pair<double, double> range_of(const Recognition& answer) {
  if (answer.shape.curve_class == CurveClass::Circle ||
      answer.shape.curve_class == CurveClass::Ellipse) {
    return {-kPi, kPi};
  }
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const LocalizedContact& contact : answer.contacts) {
    least = std::min(least, contact.t);
    most = std::max(most, contact.t);
  }
  constexpr double kMore = 0.15;
  const double more = kMore * (most - least);
  return {least - more, most + more};
}

std::string curve_svg(const View& view, const Recognition& answer) {
  const auto curve = make_curve(answer.shape.curve_class, answer.shape.values);
  if (!curve || answer.contacts.empty()) {
    return {};
  }
  constexpr int kSteps = 400;
  const auto [from, to] = range_of(answer);
  std::string svg = "<polyline clip-path=\"url(#picture)\" fill=\"none\" stroke=\"" +
                    std::string(kCurveColour) + "\" stroke-width=\"1.5\" points=\"";
  for (int i = 0; i <= kSteps; ++i) {
    const double t = from + (to - from) * i / kSteps;
    const Vec2 at = view(answer.world_T_curve * position(*curve, t));
    svg += format("%.2f,%.2f ", at.x(), at.y());
  }
  return svg + "\"/>\n";
}

std::string frame_svg(const View& view, const Recognition& answer) {
  if (!make_curve(answer.shape.curve_class, answer.shape.values)) {
    return {};
  }
  constexpr double kArrow = 50.0;
  const Vec2 origin = view(answer.world_T_curve.translation());
  std::string svg;
  for (int axis = 0; axis < 2; ++axis) {
    const Vec2 unit = axis == 0 ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0);
    const Vec2 tip =
        view(answer.world_T_curve.translation() +
             answer.world_T_curve.rotate(view.metres(kArrow) * unit));
    svg += format(
        "<line clip-path=\"url(#picture)\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
        "stroke-width=\"2\"/>\n",
        origin.x(), origin.y(), tip.x(), tip.y(), axis == 0 ? kXAxisColour : kYAxisColour);
  }
  return svg;
}

std::string points_svg(const View& view, const ContactGroup& group) {
  std::string svg;
  std::size_t colour = 0;
  for (const ContactRun& run : group.runs) {
    svg += format("<g fill=\"%s\">\n", kPatchColours[colour++ % std::size(kPatchColours)]);
    for (const ContactSample& sample : run.samples) {
      const Vec2 at = view(sample.position_m);
      svg += format("<circle cx=\"%.2f\" cy=\"%.2f\" r=\"1.8\"/>\n", at.x(), at.y());
    }
    svg += "</g>\n";
  }
  return svg;
}

std::string contacts_svg(const View& view, const Recognition& answer) {
  constexpr double kTangent = 22.0;
  std::string svg;
  for (const LocalizedContact& contact : answer.contacts) {
    const Vec2 at = view(contact.estimate.position);
    const double angle = contact.estimate.tangent_angle;
    svg += format(
        "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"%s\" stroke-width=\"1.5\"/>\n",
        at.x(), at.y(), at.x() + kTangent * std::cos(angle), at.y() - kTangent * std::sin(angle),
        kContactColour);
    svg += format("<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n",
                  at.x(), at.y(), kContactColour);
  }
  return svg;
}

std::string legend_svg(const ContactGroup& group, const Recognition& answer) {
  const double x = kWidth - kRight + 16.0;
  double y = kTop + 12.0;
  std::string svg;
  const auto entry = [&](const char* colour, const std::string& label) {
    svg += format("<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"4\" fill=\"%s\"/>\n", x, y - 6.0, colour);
    svg += format("<text x=\"%.1f\" y=\"%.1f\">%s</text>\n", x + 18.0, y, escaped(label).c_str());
    y += 20.0;
  };
  std::size_t colour = 0;
  constexpr std::size_t kMostListed = 16;
  for (const ContactRun& run : group.runs) {
    if (colour == kMostListed) {
      break;
    }
    entry(kPatchColours[colour++ % std::size(kPatchColours)],
          group.probes[run.context.probe] + ", patch " + std::to_string(run.context.patch));
  }
  if (make_curve(answer.shape.curve_class, answer.shape.values)) {
    entry(kCurveColour, "recognised curve");
    entry(kXAxisColour, "its x axis");
    entry(kYAxisColour, "its y axis");
  }
  if (!answer.contacts.empty()) {
    entry(kContactColour, "contacts, tangents");
  }
  return svg;
}

}  // namespace

std::string svg_plot(const ContactGroup& group, const Recognition& answer,
                     const std::string& title) {
  const View view = view_of(group, answer);
  std::string svg = format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n",
      kWidth, kHeight, kWidth, kHeight);
  svg += "<style>.grid{stroke:#e4e4e4}</style>\n";
  svg += format(
      "<clipPath id=\"picture\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/></clipPath>\n",
      kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  // Long titles go on in a second line.
  constexpr std::size_t kLineLength = 120;
  const std::size_t cut =
      title.size() > kLineLength ? title.rfind(", ", kLineLength) : std::string::npos;
  const std::string first = title.substr(0, cut);
  const std::string second = cut == std::string::npos ? "" : title.substr(cut + 2);
  svg += "<text x=\"16\" y=\"26\" font-size=\"13\">" + escaped(first) + "</text>\n";
  svg += "<text x=\"16\" y=\"46\" font-size=\"13\">" + escaped(second) + "</text>\n";
  svg += axes_svg(view) + curve_svg(view, answer) + frame_svg(view, answer) +
         points_svg(view, group) + contacts_svg(view, answer) + legend_svg(group, answer);
  return svg + "</svg>\n";
}

}  // namespace palpate
