#include "node/gateway/claims.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

/// Several who hear each other's words at once, in steps of 10 ms.
class Plaza {
 public:
  explicit Plaza(std::vector<std::string> places) : places_(std::move(places)) {}

  void join(std::uint64_t id, std::size_t most) {
    members_.push_back({Claims(id, places_, most, now_), true, {}, now_});
  }
  void let(std::size_t member, bool runs) { members_[member].runs = runs; }

  void run_for(milliseconds time) {
    for (const SteadyTime end = now_ + time; now_ < end; now_ += milliseconds(10)) {
      for (Member& member : members_) {
        if (!member.runs) continue;
        const Claims::Changes changes = member.claims.decide(true, now_);
        for (const std::string& place : changes.release) member.has.erase(place);
        for (const std::string& place : changes.take) member.has.insert(place);
        if (now_ < member.next_word) continue;
        member.next_word = now_ + Claims::kPeriod;
        for (const std::string& place : member.claims.own()) {
          for (Member& other : members_) {
            if (other.runs) other.claims.hear(place, member.claims.id(), now_);
          }
        }
      }
    }
  }

  const std::set<std::string>& of(std::size_t member) const { return members_[member].has; }
  std::size_t owners_of(const std::string& place) const {
    std::size_t count = 0;
    for (const Member& member : members_) count += member.runs && member.has.contains(place);
    return count;
  }

 private:
  struct Member {
    Claims claims;
    bool runs = true;
    std::set<std::string> has;
    SteadyTime next_word;
  };

  std::vector<std::string> places_;
  std::vector<Member> members_;
  SteadyTime now_ = SteadyTime() + milliseconds(1'000'000);
};

TEST(Claims, EachPlaceHasOneOwnerAndNobodyMoreThanHeMay) {
  const std::vector<std::string> places{"a", "b", "c", "d", "e", "f"};
  Plaza plaza(places);
  for (const std::uint64_t id : {17U, 4U, 99U, 56U}) plaza.join(id, 2);
  plaza.run_for(milliseconds(3000));
  for (const std::string& place : places) EXPECT_EQ(plaza.owners_of(place), 1U) << place;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(plaza.of(i).size(), 2U);
}

TEST(Claims, ADeadOnesPlaceIsTakenWithinASecond) {
  Plaza plaza({"a"});
  plaza.join(1, 1);
  plaza.run_for(milliseconds(1500));
  ASSERT_EQ(plaza.of(0).size(), 1U);
  plaza.join(2, 1);
  plaza.run_for(milliseconds(3000));
  EXPECT_TRUE(plaza.of(1).empty());
  plaza.let(0, false);
  plaza.run_for(milliseconds(1000));
  EXPECT_EQ(plaza.of(1).size(), 1U);
  // The dead one was only stopped: he has been silent, and lets go.
  plaza.let(0, true);
  plaza.run_for(milliseconds(500));
  EXPECT_TRUE(plaza.of(0).empty());
  EXPECT_EQ(plaza.owners_of("a"), 1U);
}

TEST(Claims, WhoCannotBeHeardLetsGoAndTakesNothing) {
  const SteadyTime start = SteadyTime() + milliseconds(1'000'000);
  Claims claims(1, {"a"}, 1, start);
  SteadyTime now = start;
  const auto step = [&](bool is_heard, milliseconds time) {
    std::size_t taken = 0;
    for (const SteadyTime end = now + time; now < end; now += milliseconds(10)) {
      taken += claims.decide(is_heard, now).take.size();
    }
    return taken;
  };
  EXPECT_EQ(step(false, milliseconds(3000)), 0U);
  EXPECT_EQ(step(true, Claims::kSilence - milliseconds(50)), 0U);  // it listens first
  EXPECT_EQ(step(true, milliseconds(600)), 1U);
  step(false, Claims::kSilence - milliseconds(100));  // a connection to the next server
  step(true, milliseconds(500));
  EXPECT_EQ(claims.own().size(), 1U);
  step(false, milliseconds(1500));
  EXPECT_TRUE(claims.own().empty());
}

}  // namespace
}  // namespace palpate::gateway
