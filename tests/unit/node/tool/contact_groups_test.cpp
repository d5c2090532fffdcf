#include "node/tool/contact_groups.h"

#include <gtest/gtest.h>

#include "node/csv/contact_csv.h"

namespace palpate {
namespace {

TEST(ContactGroups, AreSplitByGroupAndObjectAndKeepTheOrderOfTheFile) {
  const auto table = parse_contact_csv(
      "probe,patch,x_m,y_m,object,group\n"
      "l,0,0,0,1,part\n"
      "r,0,1,0,1,part\n"
      "l,0,2,0,1,part\n"
      "l,1,3,0,1,part\n"
      "l,1,4,0,1,part\n"
      "l,0,5,0,2,part\n"
      "r,0,6,0,1,other\n",
      "a.csv");
  ASSERT_TRUE(table.value.has_value()) << table.error;
  const auto groups = contact_groups("a.csv", *table.value);
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].name, "part");
  EXPECT_EQ(groups[0].object, 1U);
  EXPECT_EQ(groups[0].probes, (std::vector<std::string>{"l", "r"}));
  // Probes take turns; a patch goes on where its probe comes back to it.
  ASSERT_EQ(groups[0].runs.size(), 4U);
  EXPECT_EQ(groups[0].runs[1].context.probe, 1U);
  EXPECT_EQ(groups[0].runs[2].context.patch, 0U);
  EXPECT_EQ(groups[0].runs[3].samples.size(), 2U);
  EXPECT_EQ(groups[1].object, 2U);
  EXPECT_EQ(groups[2].name, "other");
  Recognizer recognizer;
  EXPECT_EQ(add_group(groups[0], recognizer).accepted, 5U);
}

}  // namespace
}  // namespace palpate
