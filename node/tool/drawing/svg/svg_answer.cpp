#include "node/tool/drawing/svg/svg_answer.h"

#include "node/files/quantity.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {

void add_answer(const ContactGroup& group, const v1::Recognition& answer, const Stated& stated,
                SvgTable& table) {
  table.heading(spoken_name(answer.curve_class()));
  table.words(status_text(answer));
  table.gap();
  for (const Quantity& quantity : quantities_of(answer)) table.row(quantity.name, quantity.text);
  std::string samples = std::to_string(answer.sample_count());
  if (answer.outlier_count() > 0) {
    samples += ", " + std::to_string(answer.outlier_count()) + " set aside as spikes";
  }
  if (answer.dwelling_count() > 0) {
    samples += ", " + std::to_string(answer.dwelling_count()) + " while standing still";
  }
  table.row("samples", samples);
  table.row("noise", noise_text(answer));
  table.row("group", group.name + ", object " + std::to_string(group.object));
  constexpr double kMostOfPath = 500.0;  // two lines [px]
  table.row("file", end_within(group.file, kMostOfPath, 12.0));
  table.gap();
  table.words(advice_text(answer, stated));
  table.gap();
}

}  // namespace palpate
