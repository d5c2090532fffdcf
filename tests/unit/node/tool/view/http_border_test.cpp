#include "node/tool/view/http_border.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(ListenAddress, IsAnIpAddressAndAPort) {
  for (const char* const text :
       {"127.0.0.1:8090", "http://127.0.0.1:8090", "http://127.0.0.1:8090/"}) {
    const auto address = parse_listen_address(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->host, "127.0.0.1");
    EXPECT_EQ(address->port, 8090);
  }
  EXPECT_EQ(parse_listen_address("[::1]:0")->host, "::1");
  EXPECT_EQ(parse_listen_address("localhost:1")->host, "localhost");
  for (const char* const text : {"", ":", ":80", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536",
                                 "127.0.0.1:-1", "127.0.0.1:8o", "example.org:80", "::1:80",
                                 "[127.0.0.1]:80", "[]:80", "[fe80::1%lo]:80", "1:2:3"}) {
    EXPECT_FALSE(parse_listen_address(text)) << text;
  }
}

TEST(LoopbackHost, IsThisMachineOnly) {
  for (const char* const host : {"127.0.0.1", "127.9.9.9", "::1", "localhost"}) {
    EXPECT_TRUE(is_loopback_host(host)) << host;
  }
  for (const char* const host :
       {"0.0.0.0", "::", "192.168.0.1", "example.org", "", "localhost.example.org"}) {
    EXPECT_FALSE(is_loopback_host(host)) << host;
  }
}

TEST(OwnHost, IsAnAddressWithOurPort) {
  for (const char* const host :
       {"127.0.0.1:8090", "192.168.0.7:8090", "[::1]:8090", "localhost:8090"}) {
    EXPECT_TRUE(is_own_host(host, 8090)) << host;
  }
  for (const char* const host :
       {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8090", "localhost.evil:8090",
        "127.0.0.1:8090:8090", "[::1]", "::1:8090", "127.0.0.1:08090x"}) {
    EXPECT_FALSE(is_own_host(host, 8090)) << host;
  }
  // Browsers leave HTTP's own port out.
  EXPECT_TRUE(is_own_host("127.0.0.1", 80));
  EXPECT_TRUE(is_own_host("[::1]", 80));
}

TEST(OwnOrigin, IsThePageItself) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8090", "127.0.0.1:8090"));
  for (const char* const origin :
       {"", "null", "http://", "https://127.0.0.1:8090", "http://127.0.0.1:8091",
        "http://127.0.0.1:8090/", "http://localhost:8090"}) {
    EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:8090")) << origin;
  }
  EXPECT_FALSE(is_own_origin("http://", ""));
}

TEST(RouteOf, KnowsThePageTheFeedAndTheDownloads) {
  EXPECT_EQ(parse_route("/")->name, "index.html");
  EXPECT_EQ(parse_route("/?x=/live")->name, "index.html");
  EXPECT_EQ(parse_route("/main.js")->name, "main.js");
  EXPECT_EQ(parse_route("/live")->kind, Route::Kind::Live);
  EXPECT_EQ(parse_route("/samples/cup-1.csv")->kind, Route::Kind::SamplesCsv);
  EXPECT_EQ(parse_route("/samples/cup-1.csv")->name, "cup-1");
  EXPECT_EQ(parse_route("/answer/cup.json.json")->name, "cup.json");
  EXPECT_EQ(parse_route("/moments/cup.json")->kind, Route::Kind::MomentsJson);
  EXPECT_EQ(parse_route("/moment/1700000000000/cup.json")->kind, Route::Kind::MomentJson);
  EXPECT_EQ(parse_route("/moment/1700000000000/cup.json")->time_ms, 1700000000000);
  EXPECT_EQ(parse_route("/moment/1700000000000/cup.json")->name, "cup");
  for (const char* const target :
       {"/moment/-1/cup.json", "/moment//cup.json", "/moment/1x/cup.json", "/moment/1/.json",
        "/moment/99999999999999999999/cup.json", "/moment/1/a/b.json", "/moment/1"}) {
    EXPECT_FALSE(parse_route(target)) << target;
  }
  for (const char* const target :
       {"", "*", "main.js", "//", "/a/b", "/samples/.csv", "/samples/a b.csv", "/samples/../x.csv",
        "/%2e%2e", "http://127.0.0.1/", "/answer/x"}) {
    EXPECT_FALSE(parse_route(target)) << target;
  }
}

}  // namespace
}  // namespace palpate
