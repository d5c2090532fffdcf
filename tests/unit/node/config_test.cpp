#include "node/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>

#include "node/environment.h"
#include "node/options.h"

namespace palpate {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Environment() { ::unsetenv(name_); }

 private:
  const char* name_;
};

v1::NodeConfig read(const std::string& text, std::string* error = nullptr) {
  const std::string path = ::testing::TempDir() + "palpate_config_test.textproto";
  std::ofstream(path) << text;
  const Result<v1::NodeConfig> config = read_config_file(path);
  std::remove(path.c_str());
  if (error != nullptr) *error = config.error;
  return config.value.value_or(v1::NodeConfig());
}

TEST(Config, TableAndFileHaveTheSameOptions) {
  std::set<std::string> in_table;
  NodeOptions options;
  for_each_option(options,
                  [&](const OptionInfo& info, const auto&) { in_table.insert(info.name); });
  std::set<std::string> in_file;
  const auto* descriptor = v1::NodeConfig::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) in_file.insert(descriptor->field(i)->name());
  EXPECT_EQ(in_table, in_file);
}

TEST(Config, DefaultsAreTheStructs) {
  const Result<NodeOptions> options = make_options(v1::NodeConfig());
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(to_text(to_config(*options.value)), to_text(to_config(NodeOptions())));
  EXPECT_EQ(options.value->intake.recognizer.determined_fraction,
            RecognizerOptions().determined_fraction);
  EXPECT_EQ(options.value->intake.recognizer.classes, RecognizerOptions().classes);
}

TEST(Config, OptionsReachTheRecognizer) {
  v1::NodeConfig config;
  ASSERT_EQ(set_option(config, "form_deviation_m", "5e-5"), "");
  ASSERT_EQ(set_option(config, "unqualified_probe", "true"), "");
  ASSERT_EQ(set_option(config, "touched_from", "inside"), "");
  const Result<NodeOptions> options = make_options(config);
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(options.value->intake.recognizer.form_deviation_m, 5e-5);
  EXPECT_EQ(options.value->intake.recognizer.unqualified_probe, true);
  EXPECT_EQ(make_options({}).value->intake.recognizer.unqualified_probe, std::nullopt);
  EXPECT_FALSE(to_config(NodeOptions()).has_unqualified_probe());
  EXPECT_EQ(options.value->intake.recognizer.touched_from, TouchedFrom::Inside);
  ASSERT_EQ(set_option(config, "touched_from", "within"), "");
  EXPECT_THAT(make_options(config).error, HasSubstr("touched_from: expected outside, inside"));
  ASSERT_EQ(set_option(config, "touched_from", "outside"), "");
  ASSERT_EQ(set_option(config, "form_deviation_m", "-5e-5"), "");
  EXPECT_THAT(make_options(config).error, HasSubstr("form_deviation_m"));
}

TEST(Config, WhatIsPrintedIsReadBack) {
  v1::NodeConfig config;
  ASSERT_EQ(set_option(config, "max_groups", "7"), "");
  ASSERT_EQ(set_option(config, "evict_idle_s", "2.5"), "");
  ASSERT_EQ(set_option(config, "insecure", "true"), "");
  ASSERT_EQ(set_option(config, "contacts", "tcp://*:1"), "");
  ASSERT_EQ(set_option(config, "contacts", "ipc:///tmp/x"), "");
  const Result<NodeOptions> options = make_options(config);
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(options.value->intake.groups.max_groups, 7U);
  EXPECT_EQ(options.value->intake.groups.evict_idle.count(), 2.5);
  EXPECT_EQ(options.value->contacts.size(), 2U);
  const std::string text = to_text(to_config(*options.value));
  const Result<NodeOptions> again = make_options(read(text));
  ASSERT_TRUE(again) << again.error;
  EXPECT_EQ(to_text(to_config(*again.value)), text);
}

TEST(Config, FlagBeforeEnvironmentBeforeFile) {
  const v1::NodeConfig file =
      read("max_groups: 1 max_probes: 1 sigma_m: 1 contacts: \"ipc:///a\" contacts: \"ipc:///b\"");
  const Environment groups("PALPATE_MAX_GROUPS", "2");
  const Environment probes("PALPATE_MAX_PROBES", "2");
  const Environment results("PALPATE_RESULTS", "ipc:///r1,ipc:///r2");
  const Result<v1::NodeConfig> environment = config_from_environment();
  ASSERT_TRUE(environment) << environment.error;
  v1::NodeConfig flags;
  ASSERT_EQ(set_option(flags, "max_groups", "3"), "");
  ASSERT_EQ(set_option(flags, "contacts", "ipc:///c"), "");
  const Result<NodeOptions> options = make_options(merge(merge(file, *environment.value), flags));
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(options.value->intake.groups.max_groups, 3U);    // flag
  EXPECT_EQ(options.value->intake.max_probes, 2U);           // environment
  EXPECT_EQ(options.value->intake.recognizer.sigma_m, 1.0);  // file
  EXPECT_EQ(options.value->contacts, std::vector<std::string>{"ipc:///c"});
  EXPECT_EQ(options.value->results, (std::vector<std::string>{"ipc:///r1", "ipc:///r2"}));
}

TEST(Config, EverySpellingOfAFlagIsAVariable) {
  const Environment sigma("PALPATE_SIGMA", "2e-5");
  const Environment tolerance("PALPATE_RELATIVE_TOLERANCE", "0.1");
  const Environment qualified("PALPATE_NO_UNQUALIFIED_PROBE", "1");
  const Environment classes("PALPATE_CLASSES", "circle, ellipse");
  const Result<v1::NodeConfig> config = config_from_environment();
  ASSERT_TRUE(config) << config.error;
  const Result<NodeOptions> options = make_options(*config.value);
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(options.value->intake.recognizer.sigma_m, 2e-5);
  EXPECT_EQ(options.value->intake.recognizer.tree.relative_tolerance, 0.1);
  EXPECT_EQ(options.value->intake.recognizer.unqualified_probe, false);
  EXPECT_EQ(options.value->words.classes, (std::vector<std::string>{"circle", "ellipse"}));
}

TEST(Config, VariablesOfOneOptionMustAgree) {
  const Environment sigma("PALPATE_SIGMA", "2e-5");
  {
    const Environment same("PALPATE_SIGMA_M", "0.00002");
    EXPECT_TRUE(config_from_environment());
  }
  const auto both_are_named = [](const std::string& one, const std::string& other) {
    const std::string error = config_from_environment().error;
    EXPECT_THAT(error, HasSubstr(one + " "));
    EXPECT_THAT(error, HasSubstr(other + " "));
  };
  {
    const Environment another("PALPATE_SIGMA_M", "3e-5");
    both_are_named("PALPATE_SIGMA", "PALPATE_SIGMA_M");
  }
  const Environment insecure("PALPATE_INSECURE", "true");
  {
    const Environment none("PALPATE_NO_INSECURE", "false");
    EXPECT_TRUE(config_from_environment().value->insecure());
  }
  {
    const Environment secure("PALPATE_NO_INSECURE", "true");
    both_are_named("PALPATE_INSECURE", "PALPATE_NO_INSECURE");
  }
  const Environment neither("PALPATE_NO_INSECURE", "perhaps");
  EXPECT_THAT(config_from_environment().error,
              HasSubstr("PALPATE_NO_INSECURE: insecure: \"perhaps\""));
}

TEST(Config, AVariableThatIsNotReadIsTold) {
  const auto are_told = [] {
    std::string told;
    for (const std::string& sentence : unread_variables()) told += sentence + "\n";
    return told;
  };
  const Environment groups("PALPATE_MAX_GROUPS", "2");
  const Environment file("PALPATE_CONFIG", "node.textproto");
  EXPECT_EQ(config_file_from_environment(), "node.textproto");
  const std::string before = are_told();  // of the tests' own
  EXPECT_THAT(before, Not(HasSubstr("PALPATE_MAX_GROUPS")));
  EXPECT_THAT(before, Not(HasSubstr("PALPATE_CONFIG")));
  const Environment workers("PALPATE_WORKER", "2");
  const Environment other("PALPATE_SOMETHING_ELSE", "2");
  EXPECT_THAT(are_told(),
              HasSubstr("environment variable PALPATE_WORKER is not read: no option has "
                        "that name, did you mean PALPATE_WORKERS?\n"));
  EXPECT_THAT(are_told(),
              HasSubstr("PALPATE_SOMETHING_ELSE is not read: no option has that name\n"));
}

TEST(Config, ProbePrefixesAreBeginningsOfNames) {
  v1::NodeConfig config;
  ASSERT_EQ(set_option(config, "probe_prefixes", "left"), "");
  ASSERT_TRUE(make_options(config));
  ASSERT_EQ(set_option(config, "probe_prefixes", "no/slash"), "");
  EXPECT_THAT(make_options(config).error, HasSubstr("probe_prefixes"));
}

TEST(Config, UnknownKeysAndBadValuesAreErrors) {
  std::string error;
  read("max_grops: 3", &error);
  EXPECT_THAT(error, HasSubstr("max_grops"));
  EXPECT_THAT(error, HasSubstr(":1:"));
  read("max_groups: \"three\"", &error);
  EXPECT_NE(error, "");
  EXPECT_NE(read_config_file("/nonexistent").error, "");
  v1::NodeConfig config;
  EXPECT_NE(set_option(config, "max_grops", "3"), "");
  EXPECT_NE(set_option(config, "max_groups", "3x"), "");
  EXPECT_NE(set_option(config, "max_groups", "-3"), "");
  EXPECT_NE(set_option(config, "max_groups", ""), "");
  EXPECT_NE(set_option(config, "sigma_m", "1,5"), "");
  EXPECT_NE(set_option(config, "insecure", "yes"), "");
  const Environment groups("PALPATE_MAX_GROUPS", "many");
  EXPECT_THAT(config_from_environment().error, HasSubstr("PALPATE_MAX_GROUPS"));
}

std::string error_with(const std::string& name, const std::string& text) {
  v1::NodeConfig config;
  EXPECT_EQ(set_option(config, name, text), "");
  return make_options(config).error;
}

TEST(Config, RangesAreChecked) {
  EXPECT_THAT(error_with("max_groups", "0"), HasSubstr("max_groups"));
  EXPECT_THAT(error_with("sigma_m", "-1"), HasSubstr("sigma_m"));
  EXPECT_THAT(error_with("sigma_m", "nan"), HasSubstr("sigma_m"));
  EXPECT_THAT(error_with("evict_idle_s", "inf"), HasSubstr("evict_idle_s"));
  EXPECT_THAT(error_with("recognized_probability", "1.5"), HasSubstr("recognized_probability"));
  EXPECT_THAT(error_with("log_level", "loud"), HasSubstr("log_level"));
  EXPECT_THAT(error_with("name", "a/b"), HasSubstr("name"));
  EXPECT_THAT(error_with("method", "magic"), HasSubstr("method"));
  EXPECT_THAT(error_with("classes", "square"), HasSubstr("square"));
  EXPECT_THAT(error_with("contacts", "127.0.0.1:1"), HasSubstr("endpoint"));
}

TEST(Config, NothingIsOpenToTheNetworkUnlessSaidAloud) {
  EXPECT_THAT(error_with("contacts", "tcp://*:5581"), HasSubstr("open to the network"));
  EXPECT_THAT(error_with("results", "bind:tcp://0.0.0.0:5582"), HasSubstr("open to the network"));
  EXPECT_EQ(error_with("results", "connect:tcp://192.168.0.7:5582"), "");
  EXPECT_THAT(error_with("curve_secret_key", "node.key"), HasSubstr("allow_clients"));
  v1::NodeConfig config;
  config.add_contacts("tcp://*:5581");
  config.set_insecure(true);
  EXPECT_TRUE(make_options(config));
  config.set_insecure(false);
  config.set_curve_secret_key("node.key");
  config.set_allow_clients("clients.pub");
  EXPECT_TRUE(make_options(config));
}

TEST(Config, ClassesAreChosenByName) {
  v1::NodeConfig config;
  config.add_classes("ellipse");
  config.add_classes("cubic_spline");
  const Result<NodeOptions> options = make_options(config);
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(options.value->intake.recognizer.classes,
            (1U << static_cast<unsigned>(CurveClass::Ellipse)) |
                (1U << static_cast<unsigned>(CurveClass::CubicSpline)));
}

TEST(Config, AClassIsGivenByName) {
  v1::NodeConfig config;
  EXPECT_FALSE(make_options(config).value->intake.group.given_class);
  config.set_given_class("circle");
  const Result<NodeOptions> options = make_options(config);
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(options.value->intake.group.given_class, CurveClass::Circle);
  v1::NodeConfig with_classes = config;
  with_classes.add_classes("ellipse");
  v1::NodeConfig with_tree = config;
  with_tree.set_method("tree");
  for (const v1::NodeConfig& other : {with_classes, with_tree}) {
    EXPECT_THAT(make_options(other).error, HasSubstr("given_class"));
  }
  for (const char* none : {"square", "unclassified"}) {
    config.set_given_class(none);
    EXPECT_THAT(make_options(config).error, HasSubstr("given_class"));
  }
}

}  // namespace
}  // namespace palpate
