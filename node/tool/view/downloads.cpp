#include "node/tool/view/downloads.h"

#include "node/csv/contact_csv.h"
#include "node/tool/text/message_json.h"

namespace palpate {

std::string samples_csv(const LiveGroup& group) {
  ContactTable table;
  table.names = group.touched.probes;
  table.names.push_back(group.touched.name);
  const std::size_t name = table.names.size() - 1;
  for (const ContactRun& run : group.touched.runs) {
    for (const ContactSample& sample : run.samples) {
      table.rows.push_back({run.context.probe, name, group.touched.object, run.context, sample});
    }
  }
  std::string text;
  if (group.samples_kept < group.samples_received) {
    text = "# " + std::to_string(group.samples_kept) + " of " +
           std::to_string(group.samples_received) + " samples: palpate record keeps them all\n";
  }
  return text + to_csv(table);
}

std::string answer_json(const LiveGroup& group) { return json_line(group.answer); }

}  // namespace palpate
