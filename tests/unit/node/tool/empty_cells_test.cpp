// What files of points say with cells that are empty.
#include "node/csv/empty_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "node/csv/contact_file.h"

namespace palpate {
namespace {

using testing::Contains;
using testing::HasSubstr;

Result<ContactFile> parsed(std::string_view text, const ContactFileOptions& options = {}) {
  return parse_contact_file(text, "a.csv", options);
}

TEST(EmptyCells, OfAColumnThatSaysWhatAPointIsAreRefused) {
  struct Case {
    const char* text;
    const char* error;
  };
  for (const auto& [text, error] :
       {Case{"x_mm,y_mm,tip_radius_mm\n1,2,3\n\n2,3,\n\n3,4,\n",
             "a.csv:4:5: tip_radius is empty here and in 1 more of 3 rows"},
        Case{"x_mm,y_mm,material_side\n1,2,\n2,3,left\n", "a.csv:2:5: material_side is empty"},
        Case{"patch,x_mm,y_mm\n1,1,2\n,2,3\n", "a.csv:3:1: patch is empty"},
        Case{"object,x_mm,y_mm\n1,1,2\n,2,3\n", "a.csv:3:1: object is empty"},
        Case{"finger,x_mm,y_mm\nleft,1,2\n,2,3\n", "a.csv:3:1: probe is empty"},
        // The columns of contact_csv.h have a reader of their own.
        Case{"probe,patch,x_m,y_m,tip_radius_m\np,0,1,2,0.003\np,1,2,3,\n",
             "a.csv:3:9: tip_radius is empty"},
        Case{"probe,patch,x_m,y_m,object\np,0,1,2,7\np,0,2,3,\n", "a.csv:3:9: object is empty"}}) {
    const auto file = parsed(text);
    ASSERT_FALSE(file) << text;
    EXPECT_THAT(file.error, HasSubstr(error));
    EXPECT_THAT(file.error, HasSubstr("in every row"));
  }
}

TEST(EmptyCells, OfWhatMayBeUnknownAreCounted) {
  for (const char* text :
       {"finger,group,time_s,x_mm,y_mm\nf,a,1,1,2\nf,,,2,3\nf,,3,3,4\n",
        "probe,patch,x_m,y_m,stamp_ns,group\np,0,1,2,5,a\np,0,2,3,,\np,0,3,4,7,\n"}) {
    const auto file = parsed(text);
    ASSERT_TRUE(file) << file.error;
    EXPECT_THAT(file.value->notes, Contains(HasSubstr("group is empty in 2 of 3 rows")));
    EXPECT_THAT(file.value->notes, Contains(HasSubstr("stamp is empty in 1 of 3 rows")));
  }
  const auto detailed = parsed(
      "x_mm,y_mm,normal_x,normal_y,normal_sigma_rad,cov_xx_mm2,cov_xy_mm2,cov_yy_mm2\n"
      "1,2,1,0,0.1,1,0,1\n2,3,,,,,,\n");
  ASSERT_TRUE(detailed) << detailed.error;
  EXPECT_THAT(detailed.value->notes, Contains(HasSubstr("normal_x is empty in 1 of 2 rows")));
  EXPECT_THAT(detailed.value->notes, Contains(HasSubstr("cov_xx is empty in 1 of 2 rows")));
}

TEST(EmptyCells, OfAWholeColumnAreThoseOfNone) {
  const auto file = parsed("patch,tip_radius_mm,x_mm,y_mm\n,,1,2\n,,2,3\n\n,,3,4\n");
  ASSERT_TRUE(file) << file.error;
  EXPECT_THAT(file.value->notes, Contains(HasSubstr("tip_radius is empty in every row")));
  EXPECT_THAT(file.value->notes, Contains(HasSubstr("patch is empty in every row")));
  // Empty lines part strokes as where there is no such column.
  EXPECT_TRUE(file.value->has_patches);
  EXPECT_EQ(file.value->table.rows.back().context.patch, 1U);
}

TEST(EmptyCells, ThatAnOptionAnswersAreRead) {
  ContactFileOptions options;
  options.tip_radius_m = 0.004;
  const auto tips = parsed("patch,x_mm,y_mm,tip_radius_mm\n0,1,2,3\n1,2,3,\n", options);
  ASSERT_TRUE(tips) << tips.error;
  EXPECT_EQ(tips.value->table.rows[0].context.tip_radius_m, 0.003);
  EXPECT_EQ(tips.value->table.rows[1].context.tip_radius_m, 0.004);
  EXPECT_THAT(tips.value->notes, Contains(HasSubstr("--tip-radius holds for them")));
  ContactFileOptions touches;
  touches.touches = true;
  EXPECT_TRUE(parsed("patch,material_side,x_mm,y_mm\n0,left,1,2\n,,2,3\n", touches));
}

}  // namespace
}  // namespace palpate
