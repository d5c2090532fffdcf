#include "node/tool/drawing/terminal_plot.h"

#include <algorithm>

#include "node/files/printable.h"
#include "node/files/quantity.h"
#include "node/tool/drawing/braille_canvas.h"
#include "node/tool/drawing/shown_extent.h"

namespace palpate {
namespace {

/// From metres to dots: equal scales on both axes, y upwards.
class DotView {
 public:
  DotView(const Extent& extent, const BrailleCanvas& canvas)
      : centre_(0.5 * (extent.low + extent.high)),
        middle_(0.5 * canvas.width(), 0.5 * canvas.height()) {
    const Vec2 size = (extent.high - extent.low).cwiseMax(1e-12);
    // Leaves one dot free at every border.
    dots_per_m_ = std::min((canvas.width() - 2.0) / size.x(), (canvas.height() - 2.0) / size.y());
  }

  Vec2 operator()(const Vec2& place) const {
    const Vec2 dots = dots_per_m_ * (place - centre_);
    return {middle_.x() + dots.x(), middle_.y() - dots.y()};
  }

 private:
  Vec2 centre_;
  Vec2 middle_;
  double dots_per_m_ = 1.0;
};

void draw_curve(const DrawnCurve& curve, const DotView& view, Ink ink, BrailleCanvas& canvas) {
  for (std::size_t i = 1; i < curve.places.size(); ++i) {
    const Vec2 from = view(curve.places[i - 1].position);
    const Vec2 to = view(curve.places[i].position);
    canvas.line(from.x(), from.y(), to.x(), to.y(), ink);
  }
}

std::string caption(const ContactGroup& group, const Extent& extent) {
  const Vec2 size = extent.high - extent.low;
  const LengthUnit unit = length_unit_for(size.maxCoeff());
  // Two digits are enough for the size; the table has the rest.
  const auto short_number = [&](double metres) { return with_digits(metres * unit.per_m, 2); };
  return printable(group.name) + ", object " + std::to_string(group.object) + ": " +
         short_number(size.x()) + " x " + short_number(size.y()) + " " + std::string(unit.name);
}

}  // namespace

std::vector<std::string> terminal_plot(const ContactGroup& group, const v1::Recognition& answer,
                                       std::size_t columns, std::size_t rows) {
  constexpr std::size_t kLeastSide = 3;  // characters; less shows no shape
  if (columns < kLeastSide || rows < kLeastSide + 1) return {};
  const Drawing drawing = make_drawing(group, answer, Curvature::None);
  const std::optional<Extent> extent = shown_extent(group, answer, drawing);
  if (!extent) return {};
  BrailleCanvas canvas(columns, rows - 1);
  const DotView view(*extent, canvas);
  for (const DrawnCurve& rival : drawing.rivals) draw_curve(rival, view, Ink::RivalInk, canvas);
  if (drawing.curve) draw_curve(*drawing.curve, view, Ink::CurveInk, canvas);
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) {
      const Vec2 at = view(sample.position_m);
      canvas.dot(at.x(), at.y(), Ink::SampleInk);
    }
  }
  std::vector<std::string> lines = canvas.lines();
  lines.push_back(caption(group, *extent).substr(0, columns));
  return lines;
}

}  // namespace palpate
