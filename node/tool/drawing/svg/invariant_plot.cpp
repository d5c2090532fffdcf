#include "node/tool/drawing/svg/invariant_plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "node/files/quantity.h"
#include "node/tool/drawing/invariant_points.h"
#include "node/tool/drawing/svg/colours.h"
#include "node/tool/drawing/svg/svg_table.h"
#include "node/tool/drawing/svg/ticks.h"
#include "node/tool/text/recognition_text.h"
#include "node/wire/convert.h"

namespace palpate {
namespace {

constexpr double kSheetWidth = 1024.0;  // of the document; all in pixels
constexpr double kHeader = 92.0;
constexpr double kPanelHeight = 344.0;
constexpr std::size_t kColumns = 2;
constexpr double kPanelWidth = kSheetWidth / kColumns;
constexpr double kPanelLeft = 84.0;  // of a panel
constexpr double kPanelRight = 20.0;
constexpr double kPanelTop = 62.0;
constexpr double kPanelBottom = 56.0;
/// Half width of the pooled value's band, in standard deviations.
constexpr double kBandSigmas = 2.0;
constexpr const char* kMutedColour = "#5b6470";
/// For the second line of a panel: the parabola's, next to the other conic's.
constexpr const char* kDashes[] = {"", " stroke-dasharray=\"7 4\""};

struct Range {
  double low = 0.0;
  double high = 1.0;

  double length() const { return high - low; }
  bool holds(double value) const { return value >= low && value <= high; }
};

/// The range of the values with a small margin, also if all are equal.
Range range_of(const std::vector<double>& values) {
  if (values.empty()) {
    return {};
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  constexpr double kMargin = 0.08;
  // Relative to the values: a picture of rounding errors says nothing.
  constexpr double kLeast = 1e-6;
  const double least = kLeast * std::max(std::abs(*low), std::abs(*high)) + 1e-300;
  const double margin = kMargin * (*high - *low) + least;
  return {*low - margin, *high + margin};
}

/// Range of the contacts whose deviation is at most a few times the median, and of the pooled
/// lines: vague contacts must not squeeze the others.
Range range_of_values(const InvariantPanel& panel, const Range& x) {
  constexpr double kVague = 4.0;
  std::vector<double> sigmas;
  for (const InvariantPoint& point : panel.points) {
    if (std::isfinite(point.y) && std::isfinite(point.y_sigma)) {
      sigmas.push_back(point.y_sigma);
    }
  }
  std::sort(sigmas.begin(), sigmas.end());
  const double most = sigmas.empty() ? 0.0 : kVague * sigmas[sigmas.size() / 2];
  std::vector<double> values;
  for (const InvariantPoint& point : panel.points) {
    if (std::isfinite(point.y) && point.y_sigma <= most) {
      values.push_back(point.y - point.y_sigma);
      values.push_back(point.y + point.y_sigma);
    }
  }
  for (const PooledLine& line : panel.lines) {
    // Beyond the contacts a sloping line would leave the picture.
    if (panel.points.empty() || line.slope == 0.0) {
      const double sigma = line.sigma_at(x.low);
      values.push_back(line.at(x.low) - (std::isfinite(sigma) ? kBandSigmas * sigma : 0.0));
      values.push_back(line.at(x.low) + (std::isfinite(sigma) ? kBandSigmas * sigma : 0.0));
    }
  }
  return range_of(values);
}

Range range_of_places(const InvariantPanel& panel) {
  std::vector<double> values;
  for (const InvariantPoint& point : panel.points) {
    if (std::isfinite(point.x)) {
      values.push_back(point.x);
    }
  }
  Range range = range_of(values);
  if (panel.x_is_contact) {
    range = {0.5, static_cast<double>(std::max<std::size_t>(panel.contacts, 1)) + 0.5};
  }
  return range;
}

/// One panel, with its upper left corner at (left, top).
class PanelDrawing {
 public:
  PanelDrawing(const InvariantPanel& panel, double left, double top, std::size_t number)
      : panel_(panel),
        left_(left + kPanelLeft),
        top_(top + kPanelTop),
        right_(left + kPanelWidth - kPanelRight),
        bottom_(top + kPanelHeight - kPanelBottom),
        number_(number),
        x_(range_of_places(panel)),
        y_(range_of_values(panel, x_)) {}

  std::string svg() const {
    return formatted(
               "<clipPath id=\"panel-%zu\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
               "height=\"%.1f\"/></clipPath>\n<g class=\"panel\">\n",
               number_, left_, top_, right_ - left_, bottom_ - top_) +
           heading() + axis(0) + axis(1) + lines() + points() + frame() + "</g>\n";
  }

 private:
  double pixel_x(double x) const { return left_ + (x - x_.low) / x_.length() * (right_ - left_); }
  double pixel_y(double y) const { return bottom_ - (y - y_.low) / y_.length() * (bottom_ - top_); }
  /// SVG's numbers have single precision, so positions far outside are clamped.
  static double cut(double pixels) {
    constexpr double kFar = 1e5;
    return std::clamp(pixels, -kFar, kFar);
  }

  std::string heading() const {
    std::string svg =
        formatted("<text x=\"%.1f\" y=\"%.1f\" font-weight=\"bold\">", left_, top_ - 42.0) +
        escaped(panel_.title) + "</text>\n";
    svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\" fill=\"%s\">", right_,
                     top_ - 42.0, kMutedColour) +
           escaped(panel_.test) + "</text>\n";
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) {
      const double y = top_ - 24.0 + 15.0 * static_cast<double>(i);
      svg += formatted(
                 "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
                 "stroke-width=\"1.5\"%s/>\n<text x=\"%.1f\" y=\"%.1f\">",
                 left_, y - 4.0, left_ + 22.0, y - 4.0, kCurveColour,
                 kDashes[i % std::size(kDashes)], left_ + 28.0, y) +
             escaped(panel_.lines[i].label) + "</text>\n";
    }
    return svg;
  }

  std::string axis(int which) const {
    const Range& range = which == 0 ? x_ : y_;
    double step = tick_step(range.length(), which == 0 ? 6.0 : 5.0);
    if (which == 0 && panel_.x_is_contact) {
      step = std::max(std::round(step), 1.0);
    }
    std::string svg;
    for (double k = std::ceil(range.low / step); k * step <= range.high; k += 1.0) {
      const double value = k == 0.0 ? 0.0 : k * step;
      const std::string label = number(value);
      if (which == 0) {
        const double x = pixel_x(value);
        svg += formatted("<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                         x, top_, x, bottom_);
        svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", x,
                         bottom_ + 17.0, label.c_str());
      } else {
        const double y = pixel_y(value);
        svg += formatted("<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                         left_, y, right_, y);
        svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", left_ - 6.0,
                         y + 4.0, label.c_str());
      }
    }
    const double x = which == 0 ? 0.5 * (left_ + right_) : left_ - 66.0;
    const double y = which == 0 ? bottom_ + 38.0 : 0.5 * (top_ + bottom_);
    const std::string turn =
        which == 0 ? "" : formatted(" transform=\"rotate(-90 %.1f %.1f)\"", x, y);
    return svg +
           formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" fill=\"%s\"", x, y,
                     kMutedColour) +
           turn + ">" + escaped(which == 0 ? panel_.x_label : panel_.y_label) + "</text>\n";
  }

  std::string clipped() const { return formatted(" clip-path=\"url(#panel-%zu)\"", number_); }

  std::string lines() const {
    constexpr int kPlaces = 60;  // a band's border is a hyperbola
    std::string svg;
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) {
      const PooledLine& line = panel_.lines[i];
      std::string above;
      std::string below;
      bool has_band = true;
      for (int k = 0; k <= kPlaces; ++k) {
        const double x = x_.low + x_.length() * k / kPlaces;
        const double sigma = kBandSigmas * line.sigma_at(x);
        has_band = has_band && std::isfinite(sigma);
        above += formatted("%.1f,%.1f ", pixel_x(x), cut(pixel_y(line.at(x) + sigma)));
        below = formatted("%.1f,%.1f ", pixel_x(x), cut(pixel_y(line.at(x) - sigma))) + below;
      }
      if (has_band) {
        svg += formatted("<polygon class=\"band\" fill=\"%s\" fill-opacity=\"0.22\"", kBandColour) +
               clipped() + " points=\"" + above + below + "\"/>\n";
      }
      svg += formatted(
                 "<line class=\"pooled\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" "
                 "stroke=\"%s\" stroke-width=\"1.5\"%s",
                 left_, cut(pixel_y(line.at(x_.low))), right_, cut(pixel_y(line.at(x_.high))),
                 kCurveColour, kDashes[i % std::size(kDashes)]) +
             clipped() + "/>\n";
    }
    return svg;
  }

  std::string points() const {
    std::string svg;
    std::size_t beyond = 0;
    for (const InvariantPoint& point : panel_.points) {
      if (!std::isfinite(point.x) || !std::isfinite(point.y) || !x_.holds(point.x) ||
          !y_.holds(point.y)) {
        ++beyond;
        continue;
      }
      const char* colour =
          kPatchColours[static_cast<std::size_t>(point.patch) % std::size(kPatchColours)];
      const double x = pixel_x(point.x);
      const double y = pixel_y(point.y);
      svg += formatted("<path class=\"contact\" stroke=\"%s\" stroke-width=\"1.2\" d=\"", colour);
      if (std::isfinite(point.y_sigma)) {
        svg += formatted("M%.1f,%.1fV%.1f", x, cut(pixel_y(point.y - point.y_sigma)),
                         cut(pixel_y(point.y + point.y_sigma)));
      }
      if (point.x_sigma > 0.0 && std::isfinite(point.x_sigma)) {
        svg += formatted("M%.1f,%.1fH%.1f", cut(pixel_x(point.x - point.x_sigma)), y,
                         cut(pixel_x(point.x + point.x_sigma)));
      }
      svg += "\"" + clipped() + "/>\n" +
             formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.2\" fill=\"%s\"/>\n", x, y, colour);
    }
    if (panel_.points.empty()) {
      svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" fill=\"%s\">",
                       0.5 * (left_ + right_), bottom_ - 8.0, kMutedColour) +
             "no canonical frame suits the contacts one by one</text>\n";
    }
    if (beyond > 0) {
      svg += formatted(
          "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\" fill=\"%s\">%zu beyond the "
          "picture</text>\n",
          right_ - 6.0, bottom_ - 8.0, kMutedColour, beyond);
    }
    return svg;
  }

  std::string frame() const {
    return formatted(
        "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" "
        "stroke=\"#888\"/>\n",
        left_, top_, right_ - left_, bottom_ - top_);
  }

  const InvariantPanel& panel_;
  double left_, top_, right_, bottom_;
  std::size_t number_;
  Range x_;
  Range y_;
};

std::string header(const Recognition& answer, const std::string& title, bool has_panels) {
  constexpr double kBold = 1.15;  // wider
  std::string svg =
      formatted("<text x=\"%.1f\" y=\"30\" font-size=\"16\" font-weight=\"bold\">", 20.0) +
      escaped(end_within("Invariants: " + title, kSheetWidth - 40.0, kBold * 16.0)) + "</text>\n";
  const std::string tree =
      answer.tree_class == CurveClass::Unclassified
          ? "The tree ends in no class."
          : "The tree ends at: " + spoken_name(to_wire(answer.tree_class)) + ".";
  const std::string lines[] = {
      tree,
      has_panels
          ? "Dots: what each contact alone says, bars one deviation, a colour a patch. Lines: all "
            "contacts together, bands two deviations. p: least of the class's tests."
          : "It asked about no class: there are too few contacts."};
  double y = 52.0;
  for (const std::string& line : lines) {
    svg += formatted("<text x=\"20\" y=\"%.0f\" fill=\"%s\">", y, kMutedColour) + escaped(line) +
           "</text>\n";
    y += 16.0;
  }
  return svg;
}

}  // namespace

std::string invariant_plot(const Recognition& answer, const std::string& title) {
  const std::vector<InvariantPanel> panels = invariant_panels(answer);
  const std::size_t rows = (panels.size() + kColumns - 1) / kColumns;
  const double height = kHeader + kPanelHeight * static_cast<double>(rows);
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f "
      "%.0f\" font-family=\"sans-serif\" font-size=\"12\">\n",
      kSheetWidth, height, kSheetWidth, height);
  svg += "<style>.grid{stroke:#e4e4e4}</style>\n";
  svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  svg += header(answer, title, !panels.empty());
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::size_t row = i / kColumns;
    svg += PanelDrawing(panels[i], kPanelWidth * static_cast<double>(i % kColumns),
                        kHeader + kPanelHeight * static_cast<double>(row), i + 1)
               .svg();
  }
  return svg + "</svg>\n";
}

}  // namespace palpate
