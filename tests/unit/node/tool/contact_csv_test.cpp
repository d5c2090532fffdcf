// The offline door: what a CSV file may hold, and what is said about one that it may not.
#include "node/csv/contact_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string error_of(std::string_view text) {
  const Result<ContactTable> table = parse_contact_csv(text, "part.csv");
  EXPECT_FALSE(table.value.has_value());
  return table.error;
}

TEST(ContactCsv, ReadsTheFourColumnsInAnyOrderWithCommentsAndWindowsLineEnds) {
  const auto table = parse_contact_csv(
      "# a part\r\n\r\ny_m,x_m,patch,probe\r\n2.5,1e-3,7,left # a sample\r\n-1,0,7,left\r\n",
      "part.csv");
  ASSERT_TRUE(table.value.has_value()) << table.error;
  ASSERT_EQ(table.value->rows.size(), 2U);
  const ContactRow& row = table.value->rows[0];
  EXPECT_EQ(table.value->names[row.probe], "left");
  EXPECT_EQ(row.probe, row.group);
  EXPECT_EQ(row.context.patch, 7U);
  EXPECT_EQ(row.sample.position_m, Vec2(1e-3, 2.5));
  EXPECT_EQ(row.sample.sigma_m, 0.0);
}

TEST(ContactCsv, ReadsEveryOptionalColumn) {
  const auto table = parse_contact_csv(
      "probe,patch,x_m,y_m,sigma_m,stamp_ns,object,group,tip_radius_m,material_side\n"
      "p,0,1,2,1e-5,1700000000000000000,18446744073709551615,g,0.002,left\n"
      "p,0,1,3,,,,g,0.002,left\n",
      "part.csv");
  ASSERT_TRUE(table.value.has_value()) << table.error;
  const ContactRow& row = table.value->rows[0];
  EXPECT_EQ(row.sample.sigma_m, 1e-5);
  EXPECT_EQ(row.sample.stamp_ns, 1700000000000000000);
  EXPECT_EQ(row.object, 18446744073709551615ULL);
  EXPECT_EQ(table.value->names[row.group], "g");
  EXPECT_EQ(row.context.tip_radius_m, 0.002);
  EXPECT_EQ(row.context.material_side, MaterialSide::Left);
  EXPECT_EQ(table.value->rows[1].sample.sigma_m, 0.0);
}

TEST(ContactCsv, AnErrorNamesFileLineColumnAndReason) {
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\na,0,1,x\n"), StartsWith("part.csv:2:7: y_m"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\na,0,1\n"), StartsWith("part.csv:2:"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\na,0,1,2,3\n"), StartsWith("part.csv:2:9:"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\na,-1,1,2\n"), StartsWith("part.csv:2:3: patch"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\na b,0,1,2\n"), StartsWith("part.csv:2:1: probe"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\n,0,1,2\n"), StartsWith("part.csv:2:1: probe"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\n# c\na,0,nan,2\n"), StartsWith("part.csv:3:5: x_m"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m\na,0,1e999,2\n"), HasSubstr("beyond"));
  EXPECT_THAT(error_of("probe,patch,x_m\n"), HasSubstr("y_m is missing"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m,x_m\n"), HasSubstr("x_m comes twice"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m,colour\n"), StartsWith("part.csv:1:21:"));
  EXPECT_THAT(error_of(""), HasSubstr("no header line"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m,sigma_m\na,0,1,2,-1\n"), StartsWith("part.csv:2:9:"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m,material_side\na,0,1,2,up\n"),
              StartsWith("part.csv:2:9:"));
  const std::string normals = "probe,patch,x_m,y_m,normal_x,normal_y,normal_sigma_rad\n";
  EXPECT_THAT(error_of(normals + "a,0,1,2,0.7,0.7,0.1\n"), StartsWith("part.csv:2:9: normal_x"));
  EXPECT_THAT(error_of(normals + "a,0,1,2,0.6,0.8,\n"), HasSubstr("a normal needs its deviation"));
  EXPECT_THAT(error_of(normals + "a,0,1,2,0.6,0.8,4\n"), StartsWith("part.csv:2:17: normal_sigma"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m,cov_xx_m2,cov_xy_m2,cov_yy_m2\na,0,1,2,1,2,1\n"),
              StartsWith("part.csv:2:9: cov_xx_m2"));
  EXPECT_THAT(error_of("probe,patch,x_m,y_m,tip_radius_m\na,0,1,2,0.1\na,0,1,3,0.2\n"),
              HasSubstr("changes within a patch"));
}

TEST(ContactCsv, WhatIsWrittenReadsTheSameToTheLastBit) {
  std::mt19937_64 rng = test::test_rng();
  std::uniform_real_distribution<double> exponent(-12.0, 3.0);
  std::uniform_int_distribution<int> side(0, 2);
  ContactTable table;
  table.names = {"left", "right", "part"};
  for (std::size_t i = 0; i < 500; ++i) {
    ContactRow row;
    row.probe = i % 2;
    row.group = 2;
    row.object = rng();
    row.context.patch = static_cast<std::uint32_t>(i / 2);
    row.context.tip_radius_m = std::pow(10.0, exponent(rng));
    row.context.material_side = static_cast<MaterialSide>(side(rng));
    row.sample.position_m = Vec2(std::pow(10.0, exponent(rng)), -std::pow(10.0, exponent(rng)));
    row.sample.sigma_m = i % 3 == 0 ? 0.0 : std::pow(10.0, exponent(rng));
    row.sample.stamp_ns = static_cast<std::int64_t>(rng() >> 2);
    if (i % 5 == 0) {
      const double angle = exponent(rng);
      row.detail.normal = {std::cos(angle), std::sin(angle)};
      row.detail.normal_sigma_rad = 0.02;
    }
    if (i % 7 == 0) {
      row.detail.covariance_m2 = {3e-8 * (1.0 + std::pow(10.0, exponent(rng))), -1e-8, 1e-8};
      row.sample.sigma_m = mean_sigma_m(row.detail.covariance_m2);
    }
    table.rows.push_back(row);
  }
  const auto again = parse_contact_csv(to_csv(table), "again.csv");
  ASSERT_TRUE(again.value.has_value()) << again.error;
  ASSERT_EQ(again.value->rows.size(), table.rows.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const ContactRow& was = table.rows[i];
    const ContactRow& is = again.value->rows[i];
    EXPECT_EQ(again.value->names[is.probe], table.names[was.probe]);
    EXPECT_EQ(again.value->names[is.group], table.names[was.group]);
    EXPECT_EQ(is.object, was.object);
    EXPECT_EQ(is.context.patch, was.context.patch);
    EXPECT_EQ(is.context.tip_radius_m, was.context.tip_radius_m);
    EXPECT_EQ(is.context.material_side, was.context.material_side);
    EXPECT_EQ(is.sample.position_m, was.sample.position_m);
    EXPECT_EQ(is.sample.sigma_m, was.sample.sigma_m);
    EXPECT_EQ(is.sample.stamp_ns, was.sample.stamp_ns);
    EXPECT_EQ(is.detail.normal, was.detail.normal);
    EXPECT_EQ(is.detail.normal_sigma_rad, was.detail.normal_sigma_rad);
    EXPECT_EQ(is.detail.covariance_m2, was.detail.covariance_m2);
  }
}

}  // namespace
}  // namespace palpate
