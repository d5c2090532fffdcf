#include "node/gateway/plant/subjects.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "palpate/v1/contact.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::gateway {
namespace {

TEST(Subjects, EveryByteHasOneTokenAndComesBack) {
  std::set<std::string> tokens;
  for (int byte = 0; byte < 256; ++byte) {
    const std::string name(1, static_cast<char>(byte));
    const std::string token = to_token(name);
    EXPECT_EQ(token.find_first_of(".*> \t\r\n"), std::string::npos) << byte;
    EXPECT_EQ(from_token(token), name) << byte;
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 256U);
  EXPECT_EQ(to_token("left.hand-2_X"), "left=2Ehand-2_X");
}

TEST(Subjects, ATokenThatNoNameGivesIsNone) {
  for (const char* token : {"=", "=2", "=2e", "=41", "=G0", "a b", "a.b", "*", ">", "=2E="}) {
    EXPECT_FALSE(from_token(token)) << token;
  }
}

TEST(Subjects, OfContactsAreReadWithPartitionAndWithout) {
  for (const char* subject :
       {"palpate.press.contact.left=2Ehand.finger", "palpate.press.contact.3.left=2Ehand.finger"}) {
    const auto names = parse_contact_subject(subject);
    ASSERT_TRUE(names) << subject;
    EXPECT_EQ(names->group, "left.hand");
    EXPECT_EQ(names->probe, "finger");
  }
  for (const char* subject :
       {"", "palpate", "palpate.press.contact.a", "palpate.press.contact..b",
        "palpate.press.contact.a.", "palpate.press.recognition.a.b", "palpate.press.contact.a.=20",
        "palpate.press.contact.1.2.a.b", "x.press.contact.a.b"}) {
    EXPECT_FALSE(parse_contact_subject(subject)) << subject;
  }
  EXPECT_FALSE(parse_contact_subject("palpate.press.contact.a." + std::string(65, 'x')));
}

v1::ContactBatch batch_of(const std::string& probe, std::uint64_t epoch, std::uint64_t seq) {
  v1::ContactBatch batch;
  batch.mutable_header()->set_source(probe);
  batch.mutable_header()->set_epoch(epoch);
  batch.mutable_header()->set_seq(seq);
  return batch;
}

TEST(Subjects, AContactHasTheSubjectOfItsGroupAndTheIdOfItsNumber) {
  v1::ContactBatch batch = batch_of("f.1", 26, 17);
  auto to = address("cell", "contact/f.1/", batch.SerializeAsString());
  ASSERT_TRUE(to);
  EXPECT_EQ(to->subject, "palpate.cell.contact.f=2E1.f=2E1");  // alone, its own group
  EXPECT_EQ(to->id, "f.1/1a/11");
  batch.set_group("hand");
  to = address("cell", "contact/f.1/", batch.SerializeAsString());
  ASSERT_TRUE(to);
  EXPECT_EQ(to->subject, "palpate.cell.contact.hand.f=2E1");
  EXPECT_EQ(to->id, "f.1/1a/11");
}

TEST(Subjects, WithoutAnEpochTheBytesTellRestartsApart) {
  v1::ContactBatch batch = batch_of("f", 0, 0);
  const auto one = address("c", "contact/f/", batch.SerializeAsString());
  const auto again = address("c", "contact/f/", batch.SerializeAsString());
  batch.set_object(2);
  const auto other = address("c", "contact/f/", batch.SerializeAsString());
  ASSERT_TRUE(one && again && other);
  EXPECT_EQ(one->id, again->id);
  EXPECT_NE(one->id, other->id);
}

TEST(Subjects, APayloadThatDoesNotAgreeWithItsTopicHasNone) {
  v1::ContactBatch batch = batch_of("other", 1, 1);
  EXPECT_FALSE(address("c", "contact/f/", batch.SerializeAsString()));
  batch = batch_of("f", 1, 1);
  batch.set_group("a b");
  EXPECT_FALSE(address("c", "contact/f/", batch.SerializeAsString()));
  batch.clear_group();
  batch.clear_header();
  EXPECT_FALSE(address("c", "contact/f/", batch.SerializeAsString()));
  v1::Recognition recognition;
  recognition.mutable_header()->set_epoch(1);
  recognition.set_group("g");
  EXPECT_TRUE(address("c", "recognition/g/", recognition.SerializeAsString()));
  EXPECT_FALSE(address("c", "recognition/h/", recognition.SerializeAsString()));
  EXPECT_FALSE(address("c", "estimate/f/", ""));
  EXPECT_FALSE(address("c", "contact/f", ""));
}

}  // namespace
}  // namespace palpate::gateway
